// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/terrain_column.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightbound {

float TerrainColumn::highest_above() const {
  if (leapt) return highest;
  return rows == 0 ? kUnbounded : *std::max_element(above.begin(), above.begin() + rows);
}

void TerrainColumn::begin(const ColumnPlace& before, const ColumnPlace& here, const ColumnPlace& next) {
  const double low = std::min({before.minor.low(), here.minor.low(), next.minor.low()});
  const double high = std::max({before.minor.high(), here.minor.high(), next.minor.high()});
  place = here;
  leapt = false;
  first = static_cast<int>(std::floor(low)) - kMargin;
  rows = static_cast<int>(std::ceil(high)) + kMargin - first + 1;
  const auto room = static_cast<std::size_t>(rows + 2 * kVector);
  for (auto* values : {&above, &below}) {
    if (values->size() < room) values->resize(room);
  }
}

void copy_rows(const Grid<float>& from, const FanColumns& columns, const TerrainColumn& column, float outside,
               std::vector<float>& to) {
  const int major = column.place.major + columns.base_major(), minor = column.first + columns.base_minor();
  const int begin = std::clamp(-minor, 0, column.rows),
            end = std::clamp(columns.minors() - minor, begin, column.rows);
  std::fill_n(to.begin(), begin, outside);
  std::fill(to.begin() + end, to.begin() + column.rows, outside);
  if (columns.transposed()) {
    std::copy_n(from.row(major) + minor + begin, end - begin, to.begin() + begin);
  } else {
    for (int j = begin; j < end; ++j) to[static_cast<std::size_t>(j)] = from.at(minor + j, major);
  }
}

ColumnLoader::ColumnLoader(const Scene& scene, const TargetTops& tops, const FanColumns& columns,
                           float height_pad)
    : scene_(&scene), tops_(&tops), columns_(&columns), height_pad_(height_pad) {}

void ColumnLoader::load(const ColumnPlace& before, const ColumnPlace& here, const ColumnPlace& next,
                        TerrainColumn& column) {
  column.begin(before, here, next);
  const auto room = static_cast<std::size_t>(column.rows + 2 * kVector);
  for (auto* values : {&column.top_above, &column.top_below, &z_}) {
    if (values->size() < room) values->resize(room);
  }
  copy_rows(scene_->heights, *columns_, column, std::numeric_limits<float>::quiet_NaN(), z_);

  const double k = scene_->largest_ratio;
  ColumnBounds bounds;
  bounds.count = column.rows;
  bounds.unknown = scene_->see_across_nodata ? -kUnbounded : kUnbounded;
  bounds.end_zone = here.distance.high() < scene_->end_zone_m;
  bounds.pad = height_pad_;
  bounds.ratio = static_cast<float>(k * (1 + 1e-6));
  bounds.full = static_cast<float>(k * scene_->least_sigma) + height_pad_;
  bounds.near_end = bounds.end_zone ? static_cast<float>(k * kLeastSigma) + height_pad_ : bounds.full;
  if (!scene_->uniform) {
    sampling_.resize(room);
    between_.resize(room);
    copy(scene_->error.sampling, column, sampling_);
    copy(scene_->error.amplitude, column, between_);
    const auto profile = static_cast<float>(scene_->largest_profile());
    for (int j = 0; j < column.rows; ++j) between_[static_cast<std::size_t>(j)] *= profile;
    bounds.sampling = sampling_.data();
    bounds.between = between_.data();
  }
  bound_column(bounds, z_.data(), column.above.data(), column.below.data());
  load_tops(column);
}

void ColumnLoader::copy(const SampleField& from, const TerrainColumn& column, std::vector<float>& to) const {
  if (from.is_constant()) {
    std::fill_n(to.begin(), column.rows, from.constant());
  } else {
    copy_rows(from.values(), *columns_, column, 0, to);
  }
}

// What the targets of a column reach up to: at least and at most, when the ground under them moves.
void ColumnLoader::load_tops(TerrainColumn& column) {
  const auto height = static_cast<float>(tops_->height);
  if (tops_->surface == nullptr) {
    std::fill_n(z_.begin(), column.rows, 0.0f);
  } else if (tops_->surface != &scene_->heights) {
    copy_rows(*tops_->surface, *columns_, column, 0, z_);
  }
  if (scene_->ends_move) {
    sampling_.resize(z_.size());
    copy(scene_->error.sampling, column, sampling_);
  }
  for (int j = 0; j < column.rows; ++j) {
    const auto at = static_cast<std::size_t>(j);
    const float slack =
        height_pad_ + (scene_->ends_move ? static_cast<float>(scene_->largest_ratio) * sampling_[at] : 0);
    column.top_above[at] = z_[at] + height - slack;
    column.top_below[at] = z_[at] + height + slack;
    // Where there is no terrain there is no target either, whatever the tops stand on.
    if (column.below[at] <= -kUnbounded) column.top_below[at] = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace sightbound
