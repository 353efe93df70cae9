// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "error_model/products.h"
#include "support/says.h"

namespace sightbound {
namespace {

double sigma_of(const std::string& name) { return std::get<double>(product_error(name).vertical_rmse); }

TEST(Products, PublishedFiguresBecomeOneStandardDeviationOfASample) {
  EXPECT_EQ(sigma_of("ned"), 1.55);
  EXPECT_NEAR(sigma_of("srtm_eurasia"), 6.2 / 1.6448536269514722, 1e-12);
  // 90 % of the differences of two samples are below 2 m.
  EXPECT_NEAR(sigma_of("copernicus_glo30"), 2 / 1.6448536269514722 / 1.4142135623730951, 1e-12);
  EXPECT_NEAR(sigma_of("copernicus_glo30_steep"), 2 * sigma_of("copernicus_glo30"), 1e-12);
}

// The two figures that are published of one thing agree.
TEST(Products, FiguresAgreeWithTheirOtherForm) {
  EXPECT_NEAR(product_from("ned").published_m * 1.9600, 3.04, 0.005);           // at 95 %
  EXPECT_NEAR(product_from("aster_gdem3").published_m * 1.9600, 16.70, 0.005);  // LE95
  const double srtm[] = {5.6, 6.0, 6.2, 8.0, 9.0, 6.2};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(products()[i].published_m, srtm[i]) << products()[i].name;
}

TEST(Products, EachIsAWholeModelWithItsSource) {
  std::set<std::string> names;
  for (const Product& product : products()) {
    const ErrorModel model = product_error(product.name);
    EXPECT_NO_THROW(model.validate());
    EXPECT_EQ(model.horizontal_rmse, 0);
    EXPECT_TRUE(std::holds_alternative<FromDem>(model.geologic_variation));
    EXPECT_FALSE(product.title.empty() || product.source.empty());
    EXPECT_TRUE(names.insert(product.name).second) << product.name;
  }
}

TEST(Products, AnUnknownNameListsTheKnown) {
  try {
    product_error("srtm");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(testing::says(error.what(), "no product 'srtm'; known are: srtm_africa"));
  }
}

}  // namespace
}  // namespace sightbound
