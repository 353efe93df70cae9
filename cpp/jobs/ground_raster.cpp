// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/ground_raster.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/crs.h"

namespace sightbound {

namespace {

class Alignment {
 public:
  Alignment(const DemSource& ground, const DemSource& dem) : ground_(ground), dem_(dem) {}

  bool same_grid() const {
    return ground_.geotransform().coefficients() == dem_.geotransform().coefficients() &&
           ground_.rows() == dem_.rows() && ground_.cols() == dem_.cols();
  }
  // The ground's raster coordinates of a sample of the DEM.
  Xy on_ground(int col, int row) const {
    const Xy at = dem_.geotransform().of_sample(col, row);
    return ground_.geotransform().to_raster(at.x, at.y);
  }
  // The ground's samples around those of a window of the DEM.
  Window around(const Window& w) const {
    double col_low = 1e300, col_high = -1e300, row_low = 1e300, row_high = -1e300;
    for (const int col : {w.col, w.col_end() - 1}) {
      for (const int row : {w.row, w.row_end() - 1}) {
        const Xy at = on_ground(col, row);
        col_low = std::min(col_low, at.x);
        col_high = std::max(col_high, at.x);
        row_low = std::min(row_low, at.y);
        row_high = std::max(row_high, at.y);
      }
    }
    const auto whole = [](double value) { return static_cast<int>(std::clamp(value, -5e8, 5e8)); };
    Window needed{whole(std::floor(col_low)) - 1, whole(std::floor(row_low)) - 1, 0, 0};
    needed.cols = whole(std::ceil(col_high)) + 2 - needed.col;
    needed.rows = whole(std::ceil(row_high)) + 2 - needed.row;
    return intersection(needed, ground_.window());
  }

 private:
  const DemSource& ground_;
  const DemSource& dem_;
};

}  // namespace

Grid<float> ground_at(const DemSource& ground, const DemSource& dem, const Window& window,
                      Progress& progress) {
  if (!ground.crs_wkt().empty() && !dem.crs_wkt().empty() &&
      !same_crs(horizontal_crs(ground.crs_wkt()), horizontal_crs(dem.crs_wkt()))) {
    throw InvalidInput("ground is in another coordinate system than the DEM; reproject it to the DEM's.");
  }
  const Alignment alignment(ground, dem);
  if (alignment.same_grid()) return ground.read(window, progress);
  const Window all = alignment.around(window);
  if (all.cols < 2 || all.rows < 2) throw InvalidInput("ground does not cover the DEM where it is needed.");

  constexpr double kRim = 1e-6;  // cells: rounding of aligned rasters
  Grid<float> out(window.rows, window.cols, std::nanf(""));
  int rows = 64;
  for (int first = 0; first < window.rows; first += rows) {
    Window band{window.col, window.row + first, window.cols, std::min(rows, window.rows - first)};
    while (band.rows > 1 && alignment.around(band).cells() * sizeof(float) > kGroundBandBytes)
      band.rows = rows = band.rows / 2;
    const Window needed = alignment.around(band);
    if (needed.cols < 2 || needed.rows < 2) continue;
    const Grid<float> samples = ground.read(needed, progress);
    for (int row = 0; row < band.rows; ++row) {
      for (int col = 0; col < band.cols; ++col) {
        const Xy at = alignment.on_ground(band.col + col, band.row + row);
        const double c = at.x - needed.col, r = at.y - needed.row;
        const bool inside =
            c >= -kRim && r >= -kRim && c <= needed.cols - 1 + kRim && r <= needed.rows - 1 + kRim;
        if (inside) out.at(first + row, col) = static_cast<float>(interpolate(samples, c, r));
      }
      progress.check();
    }
  }
  return out;
}

double interpolate(const Grid<float>& samples, double col, double row) {
  const int c = std::clamp(static_cast<int>(std::floor(col)), 0, samples.cols() - 2);
  const int r = std::clamp(static_cast<int>(std::floor(row)), 0, samples.rows() - 2);
  const double x = std::clamp(col - c, 0.0, 1.0), y = std::clamp(row - r, 0.0, 1.0);
  double value = 0;
  const auto add = [&](int dr, int dc, double weight) {
    if (weight != 0) value += weight * static_cast<double>(samples.at(r + dr, c + dc));
  };
  add(0, 0, 1 - std::max(x, y));
  add(0, 1, std::max(x - y, 0.0));
  add(1, 0, std::max(y - x, 0.0));
  add(1, 1, std::min(x, y));
  return value;
}

}  // namespace sightbound
