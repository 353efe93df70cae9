// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/float_tiles.h"

#include <bit>
#include <cstdlib>

#include <cpl_conv.h>
#include <cpl_string.h>

namespace sightbound {

namespace {

bool says(GDALMajorObject& object, const char* key, const char* value) {
  const char* said = object.GetMetadataItem(key, "IMAGE_STRUCTURE");
  return said != nullptr && EQUAL(said, value);
}

}  // namespace

std::unique_ptr<FloatTiles> FloatTiles::of(GDALRasterBand* band, const std::string& path) {
  GDALDataset* dataset = band->GetDataset();
  if (dataset == nullptr || dataset->GetDriver() == nullptr ||
      !EQUAL(dataset->GetDriver()->GetDescription(), "GTiff"))
    return nullptr;
  const bool apart = dataset->GetRasterCount() == 1 || says(*dataset, "INTERLEAVE", "BAND");
  if (band->GetRasterDataType() != GDT_Float32 || !apart || !says(*dataset, "COMPRESSION", "DEFLATE") ||
      !says(*dataset, "PREDICTOR", "3"))
    return nullptr;
  File file(VSIFOpenL(path.c_str(), "rb"));
  return file ? std::unique_ptr<FloatTiles>(new FloatTiles(band, std::move(file))) : nullptr;
}

FloatTiles::FloatTiles(GDALRasterBand* band, File file) : band_(band), file_(std::move(file)) {
  band_->GetBlockSize(&cols_, &rows_);
  bytes_.resize(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_) * sizeof(float));
}

std::int64_t FloatTiles::number(const std::string& key) const {
  const char* text = band_->GetMetadataItem(key.c_str(), "TIFF");
  return text != nullptr ? std::strtoll(text, nullptr, 10) : -1;
}

FloatTiles::Found FloatTiles::read(int block_col, int block_row, float* values) {
  const std::string block = std::to_string(block_col) + "_" + std::to_string(block_row);
  const std::int64_t offset = number("BLOCK_OFFSET_" + block), size = number("BLOCK_SIZE_" + block);
  // Packed, a block is hardly larger than unpacked: anything else is damage.
  if (offset <= 0 || size <= 0 || static_cast<std::size_t>(size) > 2 * bytes_.size() + 1024)
    return Found::kAskGdal;
  packed_.resize(static_cast<std::size_t>(size));
  if (VSIFSeekL(file_.get(), static_cast<vsi_l_offset>(offset), SEEK_SET) != 0 ||
      VSIFReadL(packed_.data(), 1, packed_.size(), file_.get()) != packed_.size())
    return Found::kAskGdal;
  std::size_t unpacked = 0;
  if (CPLZLibInflate(packed_.data(), packed_.size(), bytes_.data(), bytes_.size(), &unpacked) == nullptr)
    return Found::kDamage;
  if (unpacked != bytes_.size()) return Found::kAskGdal;
  const auto n = static_cast<std::size_t>(cols_);
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows_); ++row)
    undo_float_predictor(bytes_.data() + row * n * sizeof(float), n, values + row * n);
  return Found::kValues;
}

void undo_float_predictor(std::uint8_t* bytes, std::size_t n, float* values) {
  std::uint8_t sum = 0;
  for (std::size_t i = 0; i < 4 * n; ++i) bytes[i] = sum = static_cast<std::uint8_t>(sum + bytes[i]);
  const std::uint8_t *first = bytes, *second = bytes + n, *third = bytes + 2 * n, *fourth = bytes + 3 * n;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t bits =
        static_cast<std::uint32_t>(first[i]) << 24 | static_cast<std::uint32_t>(second[i]) << 16 |
        static_cast<std::uint32_t>(third[i]) << 8 | static_cast<std::uint32_t>(fourth[i]);
    values[i] = std::bit_cast<float>(bits);
  }
}

}  // namespace sightbound
