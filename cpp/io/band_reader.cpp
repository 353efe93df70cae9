// SPDX-License-Identifier: GPL-3.0-or-later
// The window is cut into chunks of whole blocks, in the file's order. GeoTIFF (and mosaics of them) are
// decoded by all cores, each with a handle of its own; blocks of a GeoTIFF go past GDAL's block cache, which
// would hold a second copy.
#include "io/band_reader.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_string.h>

#include "base/error.h"
#include "base/parallel.h"
#include "io/float_tiles.h"

namespace sightbound {

namespace {

constexpr int kChunkCells = 512 * 512;  // some 5 ms of decoding: the grain of cancelling and of sharing work
constexpr int kFewestChunksPerThread = 4;  // below, opening the file again costs more than it saves

bool ends_with_tif(std::string name) {
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.ends_with(".tif") || name.ends_with(".tiff");
}

// A mosaic is as safe as what it is made of; the libraries of other formats may not bear threads.
bool is_mosaic_of_geotiffs(GDALDataset& dataset) {
  const CPLStringList files(dataset.GetFileList());
  for (int i = 1; i < files.Count(); ++i) {
    if (!ends_with_tif(files[i])) return false;
  }
  return files.Count() > 1;
}

// GDAL's own limit holds too.
int reading_threads() {
  const int asked = std::atoi(CPLGetConfigOption("GDAL_NUM_THREADS", "0"));  // "ALL_CPUS" is 0 here
  return asked > 0 ? std::min(asked, Workers::count_here()) : Workers::count_here();
}

std::optional<double> nodata_of(GDALRasterBand& band) {
  int declared = 0;
  double value = 0;
  if (band.GetRasterDataType() == GDT_Int64) {
    value = static_cast<double>(band.GetNoDataValueAsInt64(&declared));
  } else if (band.GetRasterDataType() == GDT_UInt64) {
    value = static_cast<double>(band.GetNoDataValueAsUInt64(&declared));
  } else {
    value = band.GetNoDataValue(&declared);
  }
  return declared ? std::optional(value) : std::nullopt;
}

struct BlockSize {
  int cols = 1, rows = 1;
};

BlockSize block_size(GDALRasterBand& band) {
  BlockSize size;
  band.GetBlockSize(&size.cols, &size.rows);
  return size;
}

// Chunks of whole blocks that cover a window, row by row.
std::vector<Window> chunks_of(const Window& window, const BlockSize& block, bool whole_blocks) {
  const int cols = block.cols * std::max(1, 512 / block.cols);
  const int least_rows = std::max(1, kChunkCells / std::min(cols, kChunkCells));
  int rows = block.rows * std::max(1, least_rows / block.rows);
  if (!whole_blocks) rows = std::min(rows, std::max(least_rows, 512));
  std::vector<Window> chunks;
  for (int row = window.row / rows * rows; row < window.row_end(); row += rows) {
    for (int col = window.col / cols * cols; col < window.col_end(); col += cols) {
      chunks.push_back(intersection(window, {col, row, cols, rows}));
    }
  }
  return chunks;
}

// Where the values of the window go.
struct Destination {
  Grid<float>& grid;
  Window window;
  bool flip;

  float* at(int row, int col) const {
    const int r = flip ? window.row_end() - 1 - row : row - window.row;
    return grid.row(r) + (col - window.col);
  }
};

// One thread's handle of the file, and its buffers.
class Reader {
 public:
  Reader(const Band& band, GDALRasterBand* handle)
      : source_(band),
        band_(handle),
        mask_(band.masked ? handle->GetMaskBand() : nullptr),
        floats_(band.by_blocks ? FloatTiles::of(handle, band.path) : nullptr),
        block_(block_size(*handle)),
        cell_bytes_(static_cast<std::size_t>(GDALGetDataTypeSizeBytes(band.decoder.type))) {}

  // False when GDAL fails.
  bool read(const Window& part, const Destination& to) {
    return source_.by_blocks ? by_blocks(part, to) : whole(part, to);
  }

  const DecodingCounts& counts() const { return counts_; }

 private:
  bool whole(const Window& part, const Destination& to) {
    stored_.resize(part.cells() * cell_bytes_);
    return band_->RasterIO(GF_Read, part.col, part.row, part.cols, part.rows, stored_.data(), part.cols,
                           part.rows, source_.decoder.type, 0, 0, nullptr) == CE_None &&
           decode(part, part, to);
  }

  bool by_blocks(const Window& part, const Destination& to) {
    stored_.resize(static_cast<std::size_t>(block_.cols) * static_cast<std::size_t>(block_.rows) *
                   cell_bytes_);
    for (int by = part.row / block_.rows; by * block_.rows < part.row_end(); ++by) {
      for (int bx = part.col / block_.cols; bx * block_.cols < part.col_end(); ++bx) {
        const Window block{bx * block_.cols, by * block_.rows, block_.cols, block_.rows};
        if (!read_block(bx, by)) return false;
        if (!decode(intersection(block, part), block, to)) return false;
      }
    }
    return true;
  }

  bool read_block(int col, int row) {
    if (floats_) {
      const FloatTiles::Found found = floats_->read(col, row, reinterpret_cast<float*>(stored_.data()));
      if (found != FloatTiles::Found::kAskGdal) return found == FloatTiles::Found::kValues;
    }
    return band_->ReadBlock(col, row, stored_.data()) == CE_None;
  }

  // `stored_` holds the window `held`; `wanted` of it is decoded.
  bool decode(const Window& wanted, const Window& held, const Destination& to) {
    if (mask_ != nullptr) {
      mask_values_.resize(wanted.cells());
      if (mask_->RasterIO(GF_Read, wanted.col, wanted.row, wanted.cols, wanted.rows, mask_values_.data(),
                          wanted.cols, wanted.rows, GDT_Byte, 0, 0, nullptr) != CE_None) {
        return false;
      }
    }
    const auto n = static_cast<std::size_t>(wanted.cols);
    const auto stride = static_cast<std::size_t>(held.cols);
    for (int r = 0; r < wanted.rows; ++r) {
      const int row = wanted.row + r;
      const std::size_t first =
          static_cast<std::size_t>(row - held.row) * stride + static_cast<std::size_t>(wanted.col - held.col);
      const std::uint8_t* mask =
          mask_ != nullptr ? mask_values_.data() + static_cast<std::size_t>(r) * n : nullptr;
      counts_ += source_.decoder.decode(stored_.data() + first * cell_bytes_, mask, n, to.at(row, wanted.col),
                                        scratch_);
    }
    return true;
  }

  const Band& source_;
  GDALRasterBand* band_;
  GDALRasterBand* mask_;
  std::unique_ptr<FloatTiles> floats_;  // null: GDAL reads the blocks
  BlockSize block_;
  std::size_t cell_bytes_;
  DecodingCounts counts_;
  std::vector<std::uint8_t> stored_, mask_values_;
  std::vector<double> scratch_;
};

// The work shared by the threads of one read.
struct Task {
  Task(const Band& b, std::vector<Window> c, const Destination& d) : band(b), chunks(std::move(c)), to(d) {}

  const Band& band;
  const std::vector<Window> chunks;
  const Destination to;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::exception_ptr failure;  // the first
  DecodingCounts counts;

  // Takes chunks until none are left; `between` runs before each.
  template <class Between>
  void work(GDALRasterBand* handle, const Between& between) {
    Reader reader(band, handle);
    while (!stop.load(std::memory_order_relaxed)) {
      between();
      const std::size_t i = next.fetch_add(1, std::memory_order_relaxed);
      if (i >= chunks.size()) break;
      const gdal::ErrorLog log;
      if (!reader.read(chunks[i], to)) {
        const Window& c = chunks[i];
        throw IoError(band.what + " '" + band.path + "' cannot be read at rows " + std::to_string(c.row) +
                      " to " + std::to_string(c.row_end() - 1) + ", columns " + std::to_string(c.col) +
                      " to " + std::to_string(c.col_end() - 1) +
                      " (damaged or incomplete?): " + log.message());
      }
    }
    const std::lock_guard lock(mutex);
    counts += reader.counts();
  }

  void fail() {
    stop.store(true, std::memory_order_relaxed);
    const std::lock_guard lock(mutex);
    if (!failure) failure = std::current_exception();
  }

  // For threads beside the calling one: opens the file anew.
  void work_with_own_handle() {
    try {
      const GDALDatasetUniquePtr dataset = gdal::open(band.path, GDAL_OF_RASTER, band.what);
      work(gdal::band_of(*dataset, band.number, band.path, band.what), [] {});
    } catch (...) {
      fail();
    }
  }
};

}  // namespace

Band inspect_band(GDALDataset& dataset, int number, const std::string& path, const std::string& what) {
  GDALRasterBand* handle = gdal::band_of(dataset, number, path, what);
  const gdal::ErrorLog log;
  Band band{.path = path, .what = what, .dataset = &dataset, .number = number, .decoder = {}};
  band.decoder.type = handle->GetRasterDataType();
  band.decoder.nodata = nodata_of(*handle);
  band.decoder.scale = handle->GetScale();
  band.decoder.offset = handle->GetOffset();
  if (!std::isfinite(band.decoder.scale) || band.decoder.scale == 0 || !std::isfinite(band.decoder.offset)) {
    throw InvalidInput(
        what + " '" + path + "': band " + std::to_string(number) + " declares scale " +
        std::to_string(band.decoder.scale) + " and offset " + std::to_string(band.decoder.offset) +
        "; the scale must be finite and not 0, the offset finite. Correct them (gdal_edit.py).");
  }
  const int mask = handle->GetMaskFlags();
  band.masked = (mask & GMF_PER_DATASET) != 0 && (mask & GMF_NODATA) == 0;
  const GDALDriver* driver = dataset.GetDriver();
  const std::string format = driver != nullptr ? driver->GetDescription() : "";
  band.by_blocks = format == "GTiff";
  band.concurrent = format == "GTiff" || (format == "VRT" && is_mosaic_of_geotiffs(dataset));
  return band;
}

BandValues read_band(const Band& band, const Window& window, bool flip, Progress& progress) {
  BandValues out{Grid<float>(window.rows, window.cols), {}};
  if (window.empty()) return out;
  GDALRasterBand* handle = band.dataset->GetRasterBand(band.number);
  Task task(band, chunks_of(window, block_size(*handle), band.by_blocks), {out.values, window, flip});
  const int useful = static_cast<int>(task.chunks.size()) / kFewestChunksPerThread;
  const int threads = band.concurrent ? std::clamp(useful, 1, reading_threads()) : 1;
  {
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back([&task] { task.work_with_own_handle(); });
    try {
      task.work(handle, [&progress] { progress.check(); });
    } catch (...) {
      task.fail();
    }
    for (std::jthread& other : others) other.join();
  }
  if (task.failure) std::rethrow_exception(task.failure);
  out.counts = task.counts;
  return out;
}

}  // namespace sightbound
