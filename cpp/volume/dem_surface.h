// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM as the surface of a volume: no triangles are stored, they are read off the grid.
#pragma once

#include "terrain/geotransform.h"
#include "terrain/grid.h"
#include "volume/surface.h"

namespace sightbound {

// The window of a DEM (dem.h): heights and error in the core's row order.
struct DemInput {
  Grid<float> heights;         // metres, NaN = nodata
  ErrorField error;            // of the same window
  Geotransform geotransform;   // of the same window
  double metres_per_unit = 1;  // of the CRS in plan: the CRS must be projected
  std::string crs_wkt;
};

class DemSurface final : public Surface {
 public:
  // Throws InvalidInput for fewer than 2 x 2 samples, no face at all, or sizes that do not agree.
  explicit DemSurface(DemInput input);

  int rows() const { return input_.heights.rows(); }
  int cols() const { return input_.heights.cols(); }
  const DemInput& input() const { return input_; }

  // Face 2 (row (cols - 1) + col) has the corners (row, col), (row, col + 1), (row + 1, col + 1); the next
  // number (row, col), (row + 1, col + 1), (row + 1, col).
  std::optional<SurfaceFace> face(std::size_t number) const override;
  void faces_near(const Box3& box, std::vector<std::uint32_t>& found) const override;
  std::size_t bytes() const override;

  // Squares (their upper left samples) that a plan box may touch; may be empty.
  Window squares_near(double x0, double y0, double x1, double y1) const;
  // Does the raster reach over the whole box (holes or not)?
  bool spans(double x0, double y0, double x1, double y1) const;
  // Raster coordinates of a plan place, and the step in them that a step in the plan makes.
  Xy to_raster(double x, double y) const { return raster_step(x - origin_.x, y - origin_.y); }
  Xy raster_step(double x, double y) const {
    return {to_raster_[0] * x + to_raster_[1] * y, to_raster_[2] * x + to_raster_[3] * y};
  }
  // Plan place of a sample, which need not exist.
  Xy place_of(double col, double row) const {
    return {origin_.x + col * col_step_.x + row * row_step_.x,
            origin_.y + col * col_step_.y + row * row_step_.y};
  }

 private:
  DemInput input_;
  Xy origin_, col_step_, row_step_;    // local metres
  std::array<double, 4> to_raster_{};  // plan metres to columns and rows
};

}  // namespace sightbound
