// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/point_comparison.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "error_model/sampling_error.h"
#include "jobs/ground_raster.h"
#include "jobs/resolve_error.h"

namespace sightbound {

namespace {

constexpr int kTileSide = 256;
constexpr int kMargin = 2;  // samples around a tile: neighbours of neighbours
constexpr std::size_t kFewestForBlocks = 200;

bool is_inside(const Xy& at, const DemSource& source) {
  constexpr double kRim = 1e-6;  // cells: rounding
  return at.x >= -kRim && at.y >= -kRim && at.x <= source.cols() - 1 + kRim &&
         at.y <= source.rows() - 1 + kRim;
}

// Distance to the nearest of the four samples around, metres.
double distance_to_sample(const Xy& at, const CellSize& cell) {
  return std::hypot((at.x - std::round(at.x)) * cell.col_m, (at.y - std::round(at.y)) * cell.row_m);
}

// Mean rise of the nearest sample above the middle of its neighbours along row and column; 0 where one of
// them is missing.
double curvature_at(const Grid<float>& z, const Xy& at) {
  const int c = static_cast<int>(std::lround(at.x)), r = static_cast<int>(std::lround(at.y));
  if (c < 1 || r < 1 || c + 1 >= z.cols() || r + 1 >= z.rows()) return 0;
  const double middle =
      0.25 * (static_cast<double>(z.at(r, c - 1)) + z.at(r, c + 1) + z.at(r - 1, c) + z.at(r + 1, c));
  const double rise = z.at(r, c) - middle;
  return std::isnan(rise) ? 0 : rise;
}

}  // namespace

PointComparison::PointComparison(const DemSource& source, const Georeference& georeference,
                                 std::span<const Xyz> points, const Workers& workers, Progress& progress)
    : source_(source),
      georeference_(georeference),
      points_(points),
      workers_(workers),
      progress_(progress),
      plan_(source, georeference) {
  in_raster_.reserve(points.size());
  for (const Xyz& point : points) in_raster_.push_back(source.geotransform().to_raster(point.x, point.y));
}

void PointComparison::for_each(Xy shift, const Begin& begin, const Visit& visit) const {
  std::map<std::pair<int, int>, std::vector<std::pair<std::size_t, Xy>>> tiles;
  for (std::size_t i = 0; i < in_raster_.size(); ++i) {
    const Xy moved = plan_.cells(shift, in_raster_[i].y);
    const Xy at{in_raster_[i].x + moved.x, in_raster_[i].y + moved.y};
    if (!is_inside(at, source_)) continue;
    const auto tile_of = [](double x) { return static_cast<int>(std::max(0.0, x)) / kTileSide; };
    tiles[{tile_of(at.y), tile_of(at.x)}].push_back({i, at});
  }
  for (const auto& [place, members] : tiles) {
    progress_.check();
    const Window wanted{place.second * kTileSide - kMargin, place.first * kTileSide - kMargin,
                        kTileSide + 2 * kMargin + 1, kTileSide + 2 * kMargin + 1};
    const Window window = intersection(wanted, source_.window());
    const Grid<float> heights = source_.read(window, progress_);
    const Tile tile{window, heights};
    if (begin) begin(tile);
    for (const auto& [index, at] : members) visit(tile, index, at);
  }
}

std::vector<ShiftPlace> PointComparison::for_shift(Xy shift) const {
  std::vector<ShiftPlace> out;
  constexpr double kStep = 1;  // cells to either side, for the slope
  for_each(shift, {}, [&](const Tile& tile, std::size_t i, Xy at) {
    const auto height = [&](double col, double row) {
      return interpolate(tile.heights, at.x + col - tile.window.col, at.y + row - tile.window.row);
    };
    const CellSize& cell = plan_.cell(at.y);
    ShiftPlace place;
    place.error = height(0, 0) - points_[i].z;
    place.per_x = (height(kStep, 0) - height(-kStep, 0)) / (2 * kStep * cell.col_m);
    place.per_y = (height(0, -kStep) - height(0, kStep)) / (2 * kStep * cell.row_m);
    place.block =
        points_.size() < kFewestForBlocks ? static_cast<int>(i) : check_block(at.x, at.y, source_.window());
    if (!std::isnan(place.error + place.per_x + place.per_y)) out.push_back(place);
  });
  return out;
}

std::vector<CheckedPlace> PointComparison::places(Xy shift, const ErrorModel& completed) const {
  std::vector<CheckedPlace> out;
  ErrorField field;
  Grid<float> slope, amplitude;
  std::vector<std::string> unused;
  const auto begin = [&](const Tile& tile) {
    Grid<float> heights(tile.heights.rows(), tile.heights.cols());
    std::copy_n(tile.heights.data(), heights.size(), heights.data());
    field =
        resolve_error(completed, source_, georeference_, tile.window, heights, unused, workers_, progress_);
    const Surroundings around(tile.heights, tile.window, source_, progress_);
    slope = sampling_error(SampleField(0.0F), 1, around, field.cell_sizes, workers_, progress_).release();
    amplitude = Grid<float>(heights.rows(), heights.cols());
    for (int r = 0; r < heights.rows(); ++r) {
      for (int c = 0; c < heights.cols(); ++c) amplitude.at(r, c) = field.amplitude.at(r, c);
    }
  };
  for_each(shift, begin, [&](const Tile& tile, std::size_t i, Xy at) {
    const Xy here{at.x - tile.window.col, at.y - tile.window.row};
    CheckedPlace place;
    place.error = interpolate(tile.heights, here.x, here.y) - points_[i].z;
    if (std::isnan(place.error)) return;
    const Xy metres = plan_.metres(at.x, at.y);
    place.x = metres.x, place.y = metres.y;
    place.slope = interpolate(slope, here.x, here.y);
    place.curvature = curvature_at(tile.heights, here);
    const double widest = interpolate(amplitude, here.x, here.y);
    const double grown = field.profile(distance_to_sample(at, plan_.cell(at.y)), widest);
    place.between = widest * (grown + field.sampling_per_amplitude());
    out.push_back(place);
  });
  return out;
}

}  // namespace sightbound
