// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks are cut from the grid and handed to GDAL past its block cache; its threads compress while the next
// are cut. ZSTD at its fastest without a predictor: confidences are long runs of 0 and 1, on which it is four
// times faster than DEFLATE or LZW and no larger, and predictors cost twice the time for larger files
// (docs/performance.md).
#include "io/raster_writer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <deque>
#include <limits>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include <cpl_string.h>
#include <gdal_priv.h>

#include "base/error.h"
#include "io/crs.h"
#include "io/gdal_support.h"
#include "io/whole_file.h"

namespace sightbound {

namespace {

template <class T>
struct Stored;
template <>
struct Stored<float> {
  static constexpr GDALDataType kType = GDT_Float32;
  static constexpr double kNodata = std::numeric_limits<double>::quiet_NaN();
};
template <>
struct Stored<std::uint8_t> {
  static constexpr GDALDataType kType = GDT_Byte;
  static constexpr double kNodata = 255;
};
template <>
struct Stored<std::uint32_t> {
  static constexpr GDALDataType kType = GDT_UInt32;
  static constexpr double kNodata = 4294967295.0;
};

[[noreturn]] void fail(const std::string& path, const gdal::ErrorLog& log) {
  throw IoError("'" + path + "' cannot be written (folder, permissions, free space?): " + log.message());
}

void check_extension(const std::string& path) {
  const std::size_t name = path.find_last_of("/\\") + 1;  // 0 when there is none
  const std::size_t dot = path.find_last_of('.');
  if (dot == std::string::npos || dot <= name) return;
  std::string extension = path.substr(dot);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".tif" || extension == ".tiff") return;
  throw InvalidInput("The output '" + path + "' ends in '" + extension + "'; results are GeoTIFF: use .tif.");
}

// GDAL itself would only warn, and write something else than was asked for.
void require_known(const GDALDriver& driver, const std::string& option) {
  const gdal::ErrorLog quiet;
  CPLStringList alone;
  alone.AddString(option.c_str());
  if (GDALValidateCreationOptions(const_cast<GDALDriver*>(&driver), alone.List())) return;
  throw InvalidInput("The creation option '" + option +
                     "' or its value is unknown to GDAL's GTiff driver; gdalinfo --format GTiff lists them.");
}

CPLStringList creation_options(const GDALDriver& driver, const RasterMetadata& metadata, int threads) {
  CPLStringList options;
  const char* known = const_cast<GDALDriver&>(driver).GetMetadataItem(GDAL_DMD_CREATIONOPTIONLIST);
  const bool has_zstd = known != nullptr && std::string_view(known).find(">ZSTD<") != std::string_view::npos;
  options.SetNameValue("COMPRESS", has_zstd ? "ZSTD" : "DEFLATE");
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  options.SetNameValue("NUM_THREADS", threads > 0 ? std::to_string(threads).c_str() : "ALL_CPUS");
  for (const std::string& option : metadata.creation_options) {
    const std::size_t equals = option.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw InvalidInput("The creation option '" + option + "' is not of the form KEY=VALUE.");
    }
    require_known(driver, option);
    options.SetNameValue(option.substr(0, equals).c_str(), option.substr(equals + 1).c_str());
  }
  const std::string compression = options.FetchNameValue("COMPRESS");
  if (compression == "ZSTD" && options.FetchNameValue("ZSTD_LEVEL") == nullptr)
    options.SetNameValue("ZSTD_LEVEL", "1");
  if (compression == "DEFLATE" && options.FetchNameValue("ZLEVEL") == nullptr)
    options.SetNameValue("ZLEVEL", "1");
  return options;
}

void describe(GDALDataset& dataset, double nodata, const Geotransform& geotransform,
              const std::string& crs_wkt, const RasterMetadata& metadata) {
  std::array<double, 6> g = geotransform.coefficients();
  dataset.SetGeoTransform(g.data());
  if (!crs_wkt.empty()) {
    OGRSpatialReference crs;
    crs.importFromWkt(horizontal_crs(crs_wkt).c_str());
    dataset.SetSpatialRef(&crs);
  }
  for (const auto& [key, value] : metadata.items) dataset.SetMetadataItem(key.c_str(), value.c_str());
  for (int n = 0; n < dataset.GetRasterCount(); ++n) {
    GDALRasterBand* band = dataset.GetRasterBand(n + 1);
    const bool is_alone = metadata.band_descriptions.empty();
    const std::string& description =
        is_alone ? metadata.description : metadata.band_descriptions[static_cast<std::size_t>(n)];
    band->SetNoDataValue(nodata);
    if (!description.empty()) band->SetDescription(description.c_str());
    if (!metadata.unit.empty()) band->SetUnitType(metadata.unit.c_str());
  }
}

// Copies a block out of the grid; what lies beyond the grid repeats its edge, which compresses best.
template <class T>
void cut_block(const Grid<T>& grid, const Window& block, T* out) {
  const auto cols = static_cast<std::size_t>(block.cols);
  const int inside_cols = std::min(block.cols, grid.cols() - block.col);
  for (int r = 0; r < block.rows; ++r, out += cols) {
    const T* from = grid.row(std::min(block.row + r, grid.rows() - 1)) + block.col;
    std::copy_n(from, inside_cols, out);
    std::fill(out + inside_cols, out + cols, from[inside_cols - 1]);
  }
}

template <class T>
void write_blocks(const Grid<T>& grid, GDALRasterBand& band, const gdal::ErrorLog& log,
                  const std::string& path, Progress& progress) {
  Window block;
  band.GetBlockSize(&block.cols, &block.rows);
  std::vector<T> values(block.cells());
  for (block.row = 0; block.row < grid.rows(); block.row += block.rows) {
    for (block.col = 0; block.col < grid.cols(); block.col += block.cols) {
      cut_block(grid, block, values.data());
      if (band.WriteBlock(block.col / block.cols, block.row / block.rows, values.data()) != CE_None ||
          log.failed()) {
        fail(path, log);
      }
      progress.check();
    }
    progress.advance(static_cast<double>(grid.cols()) * std::min(block.rows, grid.rows() - block.row));
  }
}

// Writes under the temporary name of `file`, a band each.
template <class T>
void write(const WholeFile& file, const std::string& path, std::span<const Grid<T>> bands,
           const Geotransform& geotransform, const std::string& crs_wkt, const RasterMetadata& metadata,
           int threads, Progress& progress) {
  if (bands.empty() || bands.front().empty())
    throw InvalidInput("'" + path + "': there are no cells to write.");
  check_extension(path);
  gdal::register_drivers();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) throw IoError("This GDAL cannot write GeoTIFF: '" + path + "' is not written.");
  CPLStringList options = creation_options(*driver, metadata, threads);
  if (bands.size() > 1 && options.FetchNameValue("INTERLEAVE") == nullptr)
    options.SetNameValue("INTERLEAVE", "BAND");

  const gdal::ErrorLog log;
  GDALDatasetUniquePtr dataset(driver->Create(file.temporary().c_str(), bands.front().cols(),
                                              bands.front().rows(), static_cast<int>(bands.size()),
                                              Stored<T>::kType, options.List()));
  if (!dataset) fail(path, log);
  describe(*dataset, Stored<T>::kNodata, geotransform, crs_wkt, metadata);
  if (log.failed()) fail(path, log);
  for (std::size_t n = 0; n < bands.size(); ++n)
    write_blocks(bands[n], *dataset->GetRasterBand(static_cast<int>(n) + 1), log, path, progress);
  dataset.reset();
  if (log.failed()) fail(path, log);  // a full disk may show only when the last blocks are flushed
  progress.check();
}

template <class T>
std::span<const Grid<T>> bands_of(const Grid<T>& grid) {
  return {&grid, 1};
}
std::span<const Grid<float>> bands_of(const std::vector<Grid<float>>& grids) { return grids; }

template <class T>
void write_and_keep(const std::string& path, const Grid<T>& grid, const Geotransform& geotransform,
                    const std::string& crs_wkt, const RasterMetadata& metadata, int threads,
                    Progress& progress) {
  WholeFile file(path);
  write(file, path, bands_of(grid), geotransform, crs_wkt, metadata, threads, progress);
  file.keep();
}

void require_different(const std::vector<RasterOutput>& outputs) {
  std::set<std::string> seen;
  for (const RasterOutput& output : outputs) {
    if (seen.insert(output.path).second) continue;
    throw InvalidInput("'" + output.path + "' is named twice; give each output a path of its own.");
  }
}

}  // namespace

void write_raster(const std::string& path, const Grid<float>& grid, const Geotransform& geotransform,
                  const std::string& crs_wkt, const RasterMetadata& metadata, int threads,
                  Progress& progress) {
  write_and_keep(path, grid, geotransform, crs_wkt, metadata, threads, progress);
}

void write_raster(const std::string& path, const Grid<std::uint8_t>& grid, const Geotransform& geotransform,
                  const std::string& crs_wkt, const RasterMetadata& metadata, int threads,
                  Progress& progress) {
  write_and_keep(path, grid, geotransform, crs_wkt, metadata, threads, progress);
}

void write_raster(const std::string& path, const Grid<std::uint32_t>& grid, const Geotransform& geotransform,
                  const std::string& crs_wkt, const RasterMetadata& metadata, int threads,
                  Progress& progress) {
  write_and_keep(path, grid, geotransform, crs_wkt, metadata, threads, progress);
}

void write_rasters(const std::vector<RasterOutput>& outputs, const Geotransform& geotransform,
                   const std::string& crs_wkt, int threads, Progress& progress) {
  require_different(outputs);
  std::deque<WholeFile> files;
  for (const RasterOutput& output : outputs) {
    const WholeFile& file = files.emplace_back(output.path);
    std::visit(
        [&](const auto* grid) {
          const auto bands = bands_of(*grid);
          const std::size_t cells = bands.empty() ? 0 : bands.size() * bands.front().size();
          progress.begin(1.0 / static_cast<double>(outputs.size()), static_cast<double>(cells));
          write(file, output.path, bands, geotransform, crs_wkt, output.metadata, threads, progress);
        },
        output.grid);
  }
  for (WholeFile& file : files) file.keep();
}

}  // namespace sightbound
