// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/cover_rasters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace sightbound {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

float at_most(double value) {
  const auto near = static_cast<float>(value);
  return static_cast<double>(near) > value ? std::nextafter(near, -kInfinity) : near;
}
float at_least(double value) { return -at_most(-value); }

struct Columns {
  int first_i = std::numeric_limits<int>::max(), first_j = first_i;
  int last_i = std::numeric_limits<int>::min(), last_j = last_i;
};

Columns columns_of(const VolumeMask& mask) {
  Columns out;
  mask.for_each([&](const Voxel& low, const Voxel& high) {
    out.first_i = std::min(out.first_i, low.i);
    out.first_j = std::min(out.first_j, low.j);
    out.last_i = std::max(out.last_i, high.i);
    out.last_j = std::max(out.last_j, high.j);
  });
  if (out.first_i > out.last_i) throw InvalidInput("The error volume is empty: it has no voxels to map.");
  return out;
}

}  // namespace

CoverRasters rasters_of(const ErrorVolume& volume, double confidence) {
  const VolumeMask cover = volume.outer(confidence);
  const Columns columns = columns_of(cover);
  const int rows = columns.last_j - columns.first_j + 1, cols = columns.last_i - columns.first_i + 1;
  const double side = volume.voxel_m(), height = volume.voxel_height_m();
  const VolumeFrame& frame = volume.surface().frame();
  const Xyz corner = frame.to_crs({columns.first_i * side, (columns.last_j + 1) * side, 0});
  const double step = side / frame.metres_per_unit;
  CoverRasters out{Grid<float>(rows, cols, kNone), Grid<float>(rows, cols, kNone),
                   Grid<float>(rows, cols, kNone), Geotransform({corner.x, step, 0, corner.y, 0, -step})};
  Grid<int> voxels(rows, cols, 0);
  cover.for_each([&](const Voxel& low, const Voxel& high) {
    const float bottom = at_most(low.k * height), top = at_least((high.k + 1) * height);
    for (int j = low.j; j <= high.j; ++j) {
      const int row = columns.last_j - j;
      for (int i = low.i; i <= high.i; ++i) {
        const int col = i - columns.first_i;
        float &lower = out.lower.at(row, col), &upper = out.upper.at(row, col);
        lower = std::fmin(lower, bottom);  // fmin and fmax pass over NaN
        upper = std::fmax(upper, top);
        int& count = voxels.at(row, col);
        count += high.k - low.k + 1;
        out.thickness.at(row, col) = static_cast<float>(count * height);
      }
    }
  });
  return out;
}

}  // namespace sightbound
