// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/products.h"

#include <numbers>

#include "base/error.h"

namespace sightbound {

namespace {

// Figures are those of the tables and pages named.
constexpr auto kSrtm =
    "E. Rodriguez, C. S. Morris, J. E. Belz: A global assessment of the SRTM performance. Photogrammetric "
    "Engineering and Remote Sensing 72 (2006), 249-260: summary of SRTM performance, 90 % errors.";
constexpr auto kAster =
    "D. Gesch, M. Oimoen, J. Danielson, D. Meyer: Validation of the ASTER Global Digital Elevation Model "
    "version 3 over the conterminous United States. ISPRS Archives XLI-B4 (2016), 143-148: table 1.";
constexpr auto kAlos =
    "T. Tadono et al.: Precise global DEM generation by ALOS PRISM. ISPRS Annals II-4 (2014), 71-76: target "
    "accuracy.";
constexpr auto kTandem =
    "B. Wessel: TanDEM-X Ground Segment, DEM Products Specification Document, TD-GS-PS-0021, issue 3.1 (DLR, "
    "2016): specified accuracy, 90 % errors.";
constexpr auto kCopernicus =
    "Copernicus DEM, Product Handbook (Airbus Defence and Space, European Space Agency, 2022): specified "
    "accuracy, 90 % errors.";
constexpr auto kNed =
    "D. B. Gesch, M. J. Oimoen, G. A. Evans: Accuracy assessment of the U.S. Geological Survey National "
    "Elevation Dataset, and comparison with other large-area elevation datasets. USGS Open-File Report "
    "2014-1008: edition of 2013 against geodetic control, 3.04 m at 95 %.";
constexpr auto k3dep =
    "U.S. Geological Survey: Lidar Base Specification (3DEP), lidar quality levels, RMSEz, non-vegetated.";
constexpr auto kAsprs =
    "ASPRS Positional Accuracy Standards for Digital Geospatial Data, edition 1 (2014), annex B: vertical "
    "accuracy classes of elevation data, RMSEz, non-vegetated.";

constexpr auto kOffSideways = "Shifted as a whole: CE90 ";
constexpr auto kTandemShared = "As a whole: CE90 below 10 m sideways, LE90 below 10 m in height.";
constexpr auto kCopernicusShared =
    "As a whole: CE90 below 6 m sideways, LE90 below 4 m in height (2.57 m were measured).";
constexpr auto kSpecified = "What the specification allows; the data are often better.";

Product srtm(const std::string& name, const std::string& where, double le90, const std::string& ce90,
             const std::string& relative) {
  return {"srtm_" + name,
          "SRTM, " + where,
          le90,
          AccuracyKind::kLe90,
          kOffSideways + ce90 + " m. LE90 of height differences " + relative + " m.",
          kSrtm};
}

std::vector<Product> table() {
  using enum AccuracyKind;
  return {
      srtm("africa", "Africa", 5.6, "11.9", "9.8"),
      srtm("australia", "Australia", 6.0, "7.2", "4.7"),
      srtm("eurasia", "Eurasia", 6.2, "8.8", "8.7"),
      srtm("islands", "islands", 8.0, "9.0", "6.2"),
      srtm("north_america", "North America", 9.0, "12.6", "7.0"),
      srtm("south_america", "South America", 6.2, "9.0", "5.5"),
      {"aster_gdem3", "ASTER GDEM version 3", 8.52, kRmse,
       "1.2 m too low on the average of the United States, from 3.0 m too low to 4.2 m too high by land "
       "cover: part of the RMSE.",
       kAster},
      {"alos_aw3d30", "ALOS World 3D - 30 m", 5, kRmse, "The target for horizontal accuracy is 5 m, too.",
       kAlos},
      {"tandemx", "TanDEM-X DEM, slopes up to 20 %", 2, kRelativeLe90, kTandemShared, kTandem},
      {"tandemx_steep", "TanDEM-X DEM, slopes above 20 %", 4, kRelativeLe90, kTandemShared, kTandem},
      {"copernicus_glo30", "Copernicus DEM GLO-30, slopes up to 20 %", 2, kRelativeLe90, kCopernicusShared,
       kCopernicus},
      {"copernicus_glo30_steep", "Copernicus DEM GLO-30, slopes above 20 %", 4, kRelativeLe90,
       kCopernicusShared, kCopernicus},
      {"ned", "USGS National Elevation Dataset (before 3DEP lidar)", 1.55, kRmse, "", kNed},
      {"3dep_ql0", "USGS 3DEP lidar, quality level 0", 0.05, kRmse, kSpecified, k3dep},
      {"3dep_ql1", "USGS 3DEP lidar, quality level 1", 0.10, kRmse, kSpecified, k3dep},
      {"3dep_ql2", "USGS 3DEP lidar, quality level 2", 0.10, kRmse, kSpecified, k3dep},
      {"lidar_5cm", "Airborne lidar, ASPRS class 5 cm", 0.05, kRmse, kSpecified, kAsprs},
      {"lidar_10cm", "Airborne lidar, ASPRS class 10 cm", 0.10, kRmse, kSpecified, kAsprs},
      {"lidar_15cm", "Airborne lidar, ASPRS class 15 cm", 0.15, kRmse, kSpecified, kAsprs},
      {"lidar_20cm", "Airborne lidar, ASPRS class 20 cm", 0.20, kRmse, kSpecified, kAsprs},
  };
}

}  // namespace

double Product::vertical_rmse() const {
  switch (kind) {
    case AccuracyKind::kRmse:
      return published_m;
    case AccuracyKind::kLe90:
      return vertical_sigma(published_m, VerticalMeasure::kLe90);
    case AccuracyKind::kRelativeLe90:
      return vertical_sigma(published_m, VerticalMeasure::kLe90) / std::numbers::sqrt2;
  }
  throw BrokenGuarantee("unknown AccuracyKind");
}

const std::vector<Product>& products() {
  static const std::vector<Product> all = table();
  return all;
}

const Product& product_from(const std::string& name) {
  std::string known;
  for (const Product& product : products()) {
    if (product.name == name) return product;
    known += (known.empty() ? "" : ", ") + product.name;
  }
  throw InvalidInput("There is no product '" + name + "'; known are: " + known + ".");
}

ErrorModel product_error(const std::string& name) {
  ErrorModel model;
  model.vertical_rmse = product_from(name).vertical_rmse();
  return model;
}

}  // namespace sightbound
