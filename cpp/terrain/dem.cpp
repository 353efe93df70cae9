// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain/dem.h"

#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"

namespace sightbound {

DemSource::DemSource(int rows, int cols, const Geotransform& geotransform, std::string crs_wkt)
    : rows_(rows),
      cols_(cols),
      flipped_(geotransform.diagonal_is_anti()),
      geotransform_(flipped_ ? geotransform.of_flipped(rows) : geotransform),
      crs_wkt_(std::move(crs_wkt)) {
  if (rows < 2 || cols < 2) {
    throw InvalidInput("The DEM has " + std::to_string(rows) + " x " + std::to_string(cols) +
                       " samples; at least 2 x 2 are needed to make a surface.");
  }
  if (crs_wkt_.empty()) add_note("The DEM has no CRS: its coordinates are taken as metres on a plane.");
}

std::vector<std::string> DemSource::notes() const {
  const std::scoped_lock locked(notes_mutex_);
  return notes_;
}

std::size_t DemSource::add_note(std::string text) const {
  const std::scoped_lock locked(notes_mutex_);
  notes_.push_back(std::move(text));
  return notes_.size() - 1;
}

void DemSource::change_note(std::size_t place, std::string text) const {
  const std::scoped_lock locked(notes_mutex_);
  notes_[place] = std::move(text);
}

ArrayDem::ArrayDem(Heights heights, const Geotransform& geotransform, std::string crs_wkt)
    : DemSource(heights.rows, heights.cols, geotransform, std::move(crs_wkt)), heights_(std::move(heights)) {}

Grid<float> ArrayDem::read(const Window& window, Progress& progress) const {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const auto nodata = static_cast<float>(heights_.nodata);
  const auto scale = static_cast<float>(heights_.metres_per_unit);
  Grid<float> out(window.rows, window.cols);
  for (int r = 0; r < window.rows; ++r) {
    const int core_row = window.row + r;
    const int user_row = flipped() ? rows() - 1 - core_row : core_row;
    const float* from = heights_.data + static_cast<std::size_t>(user_row) * static_cast<std::size_t>(cols()) + window.col;
    float* to = out.row(r);
    for (int c = 0; c < window.cols; ++c) {
      const float z = from[c];
      to[c] = z == nodata || !std::isfinite(z) ? kNan : z * scale;
    }
    progress.check();
  }
  return out;
}

}  // namespace sightbound
