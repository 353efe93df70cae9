// SPDX-License-Identifier: GPL-3.0-or-later
// A raster on the DEM's own grid (or a part of it) is read as it is; any other goes through GDAL's warper,
// bilinear at the DEM's samples, straight into the result.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <gdalwarper.h>
#include <ogr_spatialref.h>

#include "base/error.h"
#include "base/parallel.h"
#include "io/band_reader.h"
#include "io/crs.h"
#include "io/error_rasters.h"
#include "io/gdal_support.h"
#include "io/grid_dataset.h"
#include "io/vertical_unit.h"

namespace sightbound {

namespace {

constexpr const char* kWhat = "The error raster";
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// How the DEM's grid lies in a file on the same grid: file column = col + shift.
struct Shift {
  int col = 0, row = 0;
  bool flipped = false;  // file row = row - core row, else row + core row
};

// Empty unless every sample of the window lies within a thousandth of a cell of a cell centre of the file.
std::optional<Shift> shift_between(const Geotransform& core, const Window& window, const Geotransform& file) {
  constexpr double kTolerance = 1e-3;
  const auto in_file = [&](int col, int row) {
    const Xy at = core.of_sample(col, row);
    return file.to_raster(at.x, at.y);
  };
  const Xy origin = in_file(0, 0);
  if (!(std::abs(origin.x) < 1e9 && std::abs(origin.y) < 1e9)) return {};
  const Shift shift{static_cast<int>(std::lround(origin.x)), static_cast<int>(std::lround(origin.y)),
                    in_file(0, 1).y < origin.y};
  for (const int row : {0, window.row, window.row_end()}) {
    for (const int col : {0, window.col, window.col_end()}) {
      const Xy at = in_file(col, row);
      if (!(std::abs(at.x - (shift.col + col)) <= kTolerance)) return {};
      if (!(std::abs(at.y - (shift.row + (shift.flipped ? -row : row))) <= kTolerance)) return {};
    }
  }
  return shift;
}

Grid<float> read_same_grid(const Band& band, const Shift& shift, const Window& window, Progress& progress) {
  Window in_file{window.col + shift.col, window.row + shift.row, window.cols, window.rows};
  if (shift.flipped) in_file.row = shift.row - (window.row_end() - 1);
  const Window whole{0, 0, band.dataset->GetRasterXSize(), band.dataset->GetRasterYSize()};
  if (whole.contains(in_file)) return read_band(band, in_file, shift.flipped, progress).values;

  Grid<float> out(window.rows, window.cols, kNan);
  const Window covered = intersection(in_file, whole);
  if (covered.empty()) return out;
  const Grid<float> part = read_band(band, covered, shift.flipped, progress).values;
  const int below = in_file.row_end() - covered.row_end(), above = covered.row - in_file.row;
  for (int r = 0; r < part.rows(); ++r) {
    float* to = out.row(r + (shift.flipped ? below : above)) + (covered.col - in_file.col);
    std::copy_n(part.row(r), part.cols(), to);
  }
  return out;
}

struct WarpOptionsDelete {
  void operator()(GDALWarpOptions* options) const { GDALDestroyWarpOptions(options); }
};
struct TransformerDelete {
  void operator()(void* transformer) const { GDALDestroyTransformer(transformer); }
};

// Stored values at the samples: as the file holds them, NaN where it has none.
Grid<float> warp(const Band& band, const std::string& file_crs, const DemSource& dem, const Window& window,
                 Progress& progress) {
  Grid<float> out(window.rows, window.cols, kNan);
  const gdal::ErrorLog log;
  const GDALDatasetUniquePtr target = gdal::dataset_over(out, dem.geotransform().of_window(window));

  CPLStringList crs_options;
  if (!file_crs.empty() && !dem.crs_wkt().empty()) {
    crs_options.SetNameValue("SRC_SRS", file_crs.c_str());
    crs_options.SetNameValue("DST_SRS", horizontal_crs(dem.crs_wkt()).c_str());
  } else {
    crs_options.SetNameValue("SRC_SRS", "");
    crs_options.SetNameValue("DST_SRS", "");
  }
  constexpr double kLargestShift =
      0.05;  // cells; of approximating the map between the grids piecewise linearly
  std::unique_ptr<void, TransformerDelete> exact(
      GDALCreateGenImgProjTransformer2(band.dataset, target.get(), crs_options.List()));
  if (!exact) {
    throw InvalidInput(band.what + " '" + band.path +
                       "' cannot be brought into the DEM's CRS: " + log.message());
  }
  const std::unique_ptr<void, TransformerDelete> transformer(
      GDALCreateApproxTransformer(GDALGenImgProjTransform, exact.get(), kLargestShift));

  constexpr double kWarpBytes = 16e6;  // per chunk: the grain of cancelling
  const std::string threads = std::to_string(Workers::count_here());
  gdal::ProgressBridge bridge(progress);
  const std::unique_ptr<GDALWarpOptions, WarpOptionsDelete> options(GDALCreateWarpOptions());
  options->hSrcDS = band.dataset;
  options->hDstDS = target.get();
  options->eResampleAlg = GRA_Bilinear;
  options->dfWarpMemoryLimit = kWarpBytes;
  options->eWorkingDataType = band.decoder.type == GDT_Byte || band.decoder.type == GDT_Int16 ||
                                      band.decoder.type == GDT_UInt16 || band.decoder.type == GDT_Float32
                                  ? GDT_Float32
                                  : GDT_Float64;
  options->nBandCount = 1;
  options->panSrcBands = static_cast<int*>(CPLMalloc(sizeof(int)));
  options->panDstBands = static_cast<int*>(CPLMalloc(sizeof(int)));
  options->panSrcBands[0] = band.number;
  options->panDstBands[0] = 1;
  if (band.decoder.nodata) GDALWarpInitSrcNoDataReal(options.get(), *band.decoder.nodata);
  // Where the file may have holes, values beside them come from the neighbours that there are. A file without
  // any takes the warper's fast kernel, half the time; the target is NaN already.
  if (band.decoder.nodata || band.masked) {
    GDALWarpInitDstNoDataReal(options.get(), std::numeric_limits<double>::quiet_NaN());
    options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "INIT_DEST", "NO_DATA");
  }
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "NUM_THREADS", threads.c_str());
  options->pfnTransformer = GDALApproxTransform;
  options->pTransformerArg = transformer.get();
  options->pfnProgress = gdal::ProgressBridge::call;
  options->pProgressArg = &bridge;

  GDALWarpOperation operation;
  const bool warped = operation.Initialize(options.get()) == CE_None &&
                      operation.ChunkAndWarpImage(0, 0, window.cols, window.rows) == CE_None;
  bridge.rethrow();
  if (!warped) throw IoError(band.what + " '" + band.path + "' cannot be read: " + log.message());
  return out;
}

// Stored values after the warper -> metres, which the decoder does for a plain read.
void decode_in_place(const HeightDecoder& decoder, Grid<float>& grid, Progress& progress) {
  HeightDecoder rest = decoder;
  rest.type = GDT_Float32;
  rest.nodata.reset();
  std::vector<double> unused;
  for (int r = 0; r < grid.rows(); ++r) {
    rest.decode(grid.row(r), nullptr, static_cast<std::size_t>(grid.cols()), grid.row(r), unused);
    progress.check();
  }
}

void check_values(const Grid<float>& grid, const std::string& path) {
  std::size_t negative = 0, known = 0;
  float least = 0;
  for (const float value : grid.values()) {
    known += !std::isnan(value);
    negative += value < 0;
    least = value < least ? value : least;
  }
  if (known == 0) {
    throw InvalidInput(
        std::string(kWhat) + " '" + path +
        "' has no value anywhere in the part of the DEM that is used; check its CRS and extent.");
  }
  if (negative > 0) {
    throw InvalidInput(std::string(kWhat) + " '" + path + "' holds " + std::to_string(negative) +
                       " negative values in the part that is used (least " + std::to_string(least) +
                       "); errors are 0 or more metres. Declare its nodata value if these are holes.");
  }
}

}  // namespace

Grid<float> aligned_raster(const RasterFile& file, const DemSource& dem, const Window& window,
                           Progress& progress) {
  const GDALDatasetUniquePtr dataset = gdal::open(file.path, GDAL_OF_RASTER, kWhat);
  Band band = inspect_band(*dataset, file.band, file.path, kWhat);
  const char* unit = dataset->GetRasterBand(file.band)->GetUnitType();
  band.decoder.metres_per_unit =
      choose_vertical_unit(VerticalUnit::kAuto, {}, unit != nullptr ? unit : "").metres_per_unit;
  const Geotransform placed(gdal::geotransform_of(*dataset, file.path, kWhat));
  const std::string crs = horizontal_crs(gdal::crs_wkt_of(dataset->GetSpatialRef()));

  const bool same_place =
      crs.empty() || dem.crs_wkt().empty() || same_crs(crs, horizontal_crs(dem.crs_wkt()));
  const std::optional<Shift> shift =
      same_place ? shift_between(dem.geotransform(), window, placed) : std::nullopt;
  Grid<float> values;
  if (shift) {
    values = read_same_grid(band, *shift, window, progress);
  } else {
    values = warp(band, crs, dem, window, progress);
    decode_in_place(band.decoder, values, progress);
  }
  check_values(values, file.path);
  return values;
}

}  // namespace sightbound
