// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/dem_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"

namespace sightbound {

namespace {

constexpr double kTouch = 1e-9;  // cells: a box that touches a square by rounding is near it

void check(const DemInput& input) {
  const int rows = input.heights.rows(), cols = input.heights.cols();
  if (rows < 2 || cols < 2) {
    throw InvalidInput("The DEM has " + std::to_string(rows) + " x " + std::to_string(cols) +
                       " samples; a volume needs at least 2 x 2.");
  }
  for (const SampleField* field : {&input.error.sampling, &input.error.amplitude}) {
    if (!field->is_constant() && (field->values().rows() != rows || field->values().cols() != cols)) {
      throw InvalidInput("The error field has another size than the DEM's window.");
    }
  }
  if (input.error.cell_sizes.size() < static_cast<std::size_t>(rows)) {
    throw InvalidInput("The error field has fewer cell sizes than the DEM has rows.");
  }
  if (!(input.metres_per_unit > 0) || !std::isfinite(input.metres_per_unit)) {
    throw InvalidInput("metres_per_unit is " + std::to_string(input.metres_per_unit) +
                       "; it must be positive.");
  }
}

}  // namespace

DemSurface::DemSurface(DemInput input) : input_(std::move(input)) {
  check(input_);
  const auto& g = input_.geotransform.coefficients();
  const double unit = input_.metres_per_unit;
  col_step_ = {g[1] * unit, g[4] * unit};
  row_step_ = {g[2] * unit, g[5] * unit};
  const double across = cols() - 1, down = rows() - 1;
  origin_.x = -(std::min(across * col_step_.x, 0.0) + std::min(down * row_step_.x, 0.0));
  origin_.y = -(std::min(across * col_step_.y, 0.0) + std::min(down * row_step_.y, 0.0));
  const Xy first = input_.geotransform.of_sample(0, 0);
  frame_ = {first.x - origin_.x / unit, first.y - origin_.y / unit, unit, input_.crs_wkt};
  const double area = col_step_.x * row_step_.y - row_step_.x * col_step_.y;
  to_raster_ = {row_step_.y / area, -row_step_.x / area, -col_step_.y / area, col_step_.x / area};

  metric_ = Metric::kVertical;
  sides_ = Sides::kSolid;
  profile_ = input_.error.profile;
  has_between_ = !input_.error.amplitude.is_constant() || input_.error.amplitude.constant() > 0;
  spacing_m_ = input_.error.larger_side_m;
  face_count_ = 2 * static_cast<std::size_t>(rows() - 1) * static_cast<std::size_t>(cols() - 1);

  float lowest = std::numeric_limits<float>::infinity(), highest = -lowest;
  for (const float height : input_.heights.values()) {
    lowest = std::min(lowest, height);  // a NaN changes neither
    highest = std::max(highest, height);
  }
  if (lowest > highest) throw InvalidInput("The DEM has no heights: every sample is nodata.");
  bounds_ = {{0, 0, static_cast<double>(lowest)},
             {std::abs(across * col_step_.x) + std::abs(down * row_step_.x),
              std::abs(across * col_step_.y) + std::abs(down * row_step_.y), static_cast<double>(highest)}};
}

std::optional<SurfaceFace> DemSurface::face(std::size_t number) const {
  const std::size_t square = number / 2, width = static_cast<std::size_t>(cols() - 1);
  const int row = static_cast<int>(square / width), col = static_cast<int>(square % width);
  const int rows[2][3] = {{row, row, row + 1}, {row, row + 1, row + 1}};
  const int cols[2][3] = {{col, col + 1, col + 1}, {col, col + 1, col}};
  SurfaceFace face;
  for (std::size_t i = 0; i < 3; ++i) {
    const int r = rows[number % 2][i], c = cols[number % 2][i];
    const float height = input_.heights.at(r, c);
    if (std::isnan(height)) return std::nullopt;
    const Xy plan = place_of(c, r);
    face.corner[i] = {plan.x, plan.y, static_cast<double>(height)};
    face.sampling[i] = static_cast<double>(input_.error.sampling.at(r, c));
    face.amplitude[i] = static_cast<double>(input_.error.amplitude.at(r, c));
  }
  const CellSize& cell = input_.error.cell_sizes[static_cast<std::size_t>(row)];
  face.to_ground = {to_raster_[0] * cell.col_m, to_raster_[1] * cell.col_m, to_raster_[2] * cell.row_m,
                    to_raster_[3] * cell.row_m};
  return face;
}

Window DemSurface::squares_near(double x0, double y0, double x1, double y1) const {
  double least_col = std::numeric_limits<double>::infinity(), most_col = -least_col;
  double least_row = least_col, most_row = -least_col;
  for (const double x : {x0, x1}) {
    for (const double y : {y0, y1}) {
      const double dx = x - origin_.x, dy = y - origin_.y;
      const double col = to_raster_[0] * dx + to_raster_[1] * dy,
                   row = to_raster_[2] * dx + to_raster_[3] * dy;
      least_col = std::min(least_col, col);
      most_col = std::max(most_col, col);
      least_row = std::min(least_row, row);
      most_row = std::max(most_row, row);
    }
  }
  const auto clamped = [](double value, int limit) {
    return static_cast<int>(std::floor(std::clamp(value, -1.0, static_cast<double>(limit))));
  };
  const int first_col = std::max(clamped(least_col - kTouch, cols()), 0);
  const int first_row = std::max(clamped(least_row - kTouch, rows()), 0);
  const int last_col = std::min(clamped(most_col + kTouch, cols()), cols() - 2);
  const int last_row = std::min(clamped(most_row + kTouch, rows()), rows() - 2);
  return {first_col, first_row, std::max(last_col - first_col + 1, 0), std::max(last_row - first_row + 1, 0)};
}

bool DemSurface::spans(double x0, double y0, double x1, double y1) const {
  for (const double x : {x0, x1}) {
    for (const double y : {y0, y1}) {
      const double dx = x - origin_.x, dy = y - origin_.y;
      const double col = to_raster_[0] * dx + to_raster_[1] * dy,
                   row = to_raster_[2] * dx + to_raster_[3] * dy;
      if (!(col >= -kTouch && row >= -kTouch && col <= cols() - 1 + kTouch && row <= rows() - 1 + kTouch))
        return false;
    }
  }
  return true;
}

void DemSurface::faces_near(const Box3& box, std::vector<std::uint32_t>& found) const {
  found.clear();
  const Window squares = squares_near(box.low.x, box.low.y, box.high.x, box.high.y);
  for (int row = squares.row; row < squares.row_end(); ++row) {
    for (int col = squares.col; col < squares.col_end(); ++col) {
      const float a = input_.heights.at(row, col), b = input_.heights.at(row, col + 1);
      const float c = input_.heights.at(row + 1, col), d = input_.heights.at(row + 1, col + 1);
      const auto first = static_cast<std::uint32_t>(
          2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(cols() - 1) +
               static_cast<std::size_t>(col)));
      const auto meets = [&](float p, float q, float r) {  // false for a NaN
        return static_cast<double>(std::min({p, q, r})) <= box.high.z &&
               static_cast<double>(std::max({p, q, r})) >= box.low.z && !std::isnan(p + q + r);
      };
      if (meets(a, b, d)) found.push_back(first);
      if (meets(a, d, c)) found.push_back(first + 1);
    }
  }
}

std::size_t DemSurface::bytes() const {
  std::size_t cells = input_.heights.size();
  for (const SampleField* field : {&input_.error.sampling, &input_.error.amplitude})
    cells += field->values().size();
  return cells * sizeof(float);
}

}  // namespace sightbound
