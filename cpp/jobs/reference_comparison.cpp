// SPDX-License-Identifier: GPL-3.0-or-later
// The reference's raster coordinates are computed exactly at the DEM's samples; those of the places in a
// sample's cell, for a mean, follow linearly from its neighbours.
#include "jobs/reference_comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "error_model/sampling_error.h"
#include "io/crs.h"
#include "jobs/error_check_job.h"
#include "jobs/ground_raster.h"

namespace sightbound {

namespace {

constexpr int kMostDivided = 16;
constexpr double kReferenceSide = 4096;  // samples of the reference that a tile may need, along a side
constexpr int kLeastTileSide = 32;
constexpr std::size_t kShiftTiles = 16, kShiftPlaces = 100'000;

// Raster coordinates of the reference for each sample of a window of the DEM.
struct Lookup {
  int rows, cols;
  std::vector<double> x, y;

  std::size_t index(int r, int c) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c);
  }
  Xy at(int r, int c) const { return {x[index(r, c)], y[index(r, c)]}; }
  // Change from one column, one row to the next.
  std::pair<Xy, Xy> steps(int r, int c) const {
    const int c0 = std::max(0, c - 1), c1 = std::min(cols - 1, c + 1);
    const int r0 = std::max(0, r - 1), r1 = std::min(rows - 1, r + 1);
    const Xy left = at(r, c0), right = at(r, c1), up = at(r0, c), down = at(r1, c);
    const double dc = std::max(1, c1 - c0), dr = std::max(1, r1 - r0);
    return {{(right.x - left.x) / dc, (right.y - left.y) / dc}, {(down.x - up.x) / dr, (down.y - up.y) / dr}};
  }
};

Window around(const Lookup& lookup, double reach, const Window& whole) {
  double x_low = 1e300, x_high = -1e300, y_low = 1e300, y_high = -1e300;
  for (std::size_t i = 0; i < lookup.x.size(); ++i) {
    if (!std::isfinite(lookup.x[i]) || !std::isfinite(lookup.y[i])) continue;
    x_low = std::min(x_low, lookup.x[i]), x_high = std::max(x_high, lookup.x[i]);
    y_low = std::min(y_low, lookup.y[i]), y_high = std::max(y_high, lookup.y[i]);
  }
  if (x_low > x_high) return {};
  const auto cell = [](double value) { return static_cast<int>(std::floor(std::clamp(value, -5e8, 5e8))); };
  Window w{cell(x_low - reach), cell(y_low - reach), 0, 0};
  w.cols = cell(x_high + reach) + 2 - w.col;
  w.rows = cell(y_high + reach) + 2 - w.row;
  return intersection(w, whole);
}

double height_at(const Grid<float>& samples, double col, double row) {
  constexpr double kRim = 1e-6;  // cells: rounding of aligned rasters
  const bool inside =
      col >= -kRim && row >= -kRim && col <= samples.cols() - 1 + kRim && row <= samples.rows() - 1 + kRim;
  return inside ? interpolate(samples, col, row) : std::nan("");
}

}  // namespace

ReferenceComparison::ReferenceComparison(const DemSource& source, const Georeference& georeference,
                                         const DemSource& reference, CellContent content,
                                         const Workers& workers, Progress& progress)
    : source_(source),
      reference_(reference),
      crossing_(source.crs_wkt(), reference.crs_wkt(), "The reference"),
      workers_(workers),
      progress_(progress),
      plan_(source, georeference),
      overlap_(overlap()) {
  if (overlap_.cols < 2 || overlap_.rows < 2) {
    throw InvalidInput("The reference does not overlap the DEM; check its CRS and extent.");
  }
  const Georeference of_reference = georeference_of(reference);
  const double ratio = larger_cell_side(georeference, source.rows(), source.cols()) /
                       larger_cell_side(of_reference, reference.rows(), reference.cols());
  if (content == CellContent::kMeans)
    divided_ = std::clamp(static_cast<int>(std::ceil(ratio - 0.01)), 1, kMostDivided);
  side_ = std::clamp(static_cast<int>(kReferenceSide / std::max(ratio, 1.0)), kLeastTileSide, kCheckTileSide);

  std::vector<Window> all;
  for (int row = overlap_.row; row < overlap_.row_end(); row += side_) {
    for (int col = overlap_.col; col < overlap_.col_end(); col += side_)
      all.push_back(intersection({col, row, side_, side_}, overlap_));
  }
  is_part_ = all.size() > kMostCheckTiles;
  const std::size_t wanted = std::min(all.size(), kMostCheckTiles);
  for (std::size_t i = 0; i < wanted; ++i) tiles_.push_back(all[i * all.size() / wanted]);
}

// The reference's border, brought into the DEM's raster.
Window ReferenceComparison::overlap() const {
  constexpr int kPlaces = 20;  // along each side
  const Geotransform& g = reference_.geotransform();
  std::vector<double> x, y;
  for (int i = 0; i <= kPlaces; ++i) {
    const double col = (reference_.cols() - 1) * i / double{kPlaces};
    for (int k = 0; k <= kPlaces; ++k) {
      const Xy at = g.of_sample(col, (reference_.rows() - 1) * k / double{kPlaces});
      x.push_back(at.x), y.push_back(at.y);
    }
  }
  CrsCrossing(reference_.crs_wkt(), source_.crs_wkt(), "The reference").apply(x, y);
  Lookup in_dem{1, static_cast<int>(x.size()), {}, {}};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Xy at = source_.geotransform().to_raster(x[i], y[i]);
    in_dem.x.push_back(at.x), in_dem.y.push_back(at.y);
  }
  return around(in_dem, 0, source_.window());
}

Grid<float> ReferenceComparison::truth_at(const Window& window, Xy shift) const {
  Lookup lookup{window.rows, window.cols, {}, {}};
  for (int r = 0; r < window.rows; ++r) {
    const Xy moved = plan_.cells(shift, window.row + r);
    for (int c = 0; c < window.cols; ++c) {
      const Xy at = source_.geotransform().of_sample(window.col + c - moved.x, window.row + r - moved.y);
      lookup.x.push_back(at.x), lookup.y.push_back(at.y);
    }
  }
  crossing_.apply(lookup.x, lookup.y);
  for (std::size_t i = 0; i < lookup.x.size(); ++i) {
    const Xy at = reference_.geotransform().to_raster(lookup.x[i], lookup.y[i]);
    lookup.x[i] = at.x, lookup.y[i] = at.y;
  }
  Grid<float> out(window.rows, window.cols, std::nanf(""));
  const Window needed = around(lookup, divided_ > 1 ? divided_ + 1 : 0, reference_.window());
  if (needed.cols < 2 || needed.rows < 2) return out;
  const Grid<float> samples = reference_.read(needed, progress_);
  workers_.for_each(static_cast<std::size_t>(window.rows), [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < window.cols; ++c) {
      const Xy at = lookup.at(r, c);
      if (!std::isfinite(at.x) || !std::isfinite(at.y)) continue;
      const auto [per_col, per_row] = lookup.steps(r, c);
      double sum = 0;
      for (int i = 0; i < divided_; ++i) {
        for (int k = 0; k < divided_; ++k) {
          const double u = (i + 0.5) / divided_ - 0.5, v = (k + 0.5) / divided_ - 0.5;
          sum += height_at(samples, at.x + u * per_col.x + v * per_row.x - needed.col,
                           at.y + u * per_col.y + v * per_row.y - needed.row);
        }
      }
      out.at(r, c) = static_cast<float>(sum / (divided_ * divided_));
    }
  });
  return out;
}

void ReferenceComparison::for_each(const std::vector<Window>& tiles, Xy shift,
                                   const std::function<void(const Tile&)>& f) const {
  for (const Window& window : tiles) {
    progress_.check();
    Tile tile;
    tile.window = window;
    tile.padded =
        intersection({window.col - 1, window.row - 1, window.cols + 2, window.rows + 2}, source_.window());
    tile.heights = source_.read(tile.padded, progress_);
    tile.truth = truth_at(tile.padded, shift);
    f(tile);
  }
}

std::vector<ShiftPlace> ReferenceComparison::for_shift(Xy shift) const {
  std::vector<Window> some;
  const std::size_t wanted = std::min(tiles_.size(), kShiftTiles);
  for (std::size_t i = 0; i < wanted; ++i) some.push_back(tiles_[i * tiles_.size() / wanted]);
  std::size_t cells = 0, number = 0;
  for (const Window& tile : some) cells += tile.cells();
  const std::size_t step = 1 + cells / kShiftPlaces;
  std::vector<ShiftPlace> out;
  for_each(some, shift, [&](const Tile& tile) {
    const Grid<float>& t = tile.truth;
    for (int r = 1; r + 1 < t.rows(); ++r) {
      const CellSize& cell = plan_.cell(tile.padded.row + r);
      for (int c = 1; c + 1 < t.cols(); ++c) {
        if (number++ % step != 0) continue;
        ShiftPlace place;
        place.error = static_cast<double>(tile.heights.at(r, c)) - t.at(r, c);
        place.per_x = (static_cast<double>(t.at(r, c + 1)) - t.at(r, c - 1)) / (2 * cell.col_m);
        place.per_y = (static_cast<double>(t.at(r - 1, c)) - t.at(r + 1, c)) / (2 * cell.row_m);
        place.block = check_block(tile.padded.col + c, tile.padded.row + r, overlap_);
        const bool level = place.error == 0 && place.per_x == 0 && place.per_y == 0;
        if (!level && !std::isnan(place.error + place.per_x + place.per_y)) out.push_back(place);
      }
    }
  });
  return out;
}

ReferenceComparison::Found ReferenceComparison::compare(Xy shift) const {
  Found found;
  found.is_part = is_part_;
  found.near_reach = 0.5 * side_ * std::min(plan_.middle_cell().col_m, plan_.middle_cell().row_m);
  std::size_t cells = 0, number = 0;
  for (const Window& tile : tiles_) cells += tile.cells();
  const std::size_t step = 1 + cells / kMostJudgedPlaces;
  for_each(tiles_, shift, [&](const Tile& tile) {
    const Surroundings around_tile(tile.heights, tile.padded, source_, progress_);
    std::vector<CellSize> sizes;
    for (int r = 0; r < tile.padded.rows; ++r) sizes.push_back(plan_.cell(tile.padded.row + r));
    const Grid<float> slope =
        sampling_error(SampleField(0.0F), 1, around_tile, sizes, workers_, progress_).release();
    Grid<float> errors(tile.window.rows, tile.window.cols);
    for (int r = 0; r < errors.rows(); ++r) {
      for (int c = 0; c < errors.cols(); ++c) {
        const int pr = tile.window.row + r - tile.padded.row, pc = tile.window.col + c - tile.padded.col;
        const Grid<float>& z = tile.heights;
        CheckedPlace place;
        place.error = static_cast<double>(z.at(pr, pc)) - tile.truth.at(pr, pc);
        place.slope = slope.at(pr, pc);
        if (pr > 0 && pc > 0 && pr + 1 < z.rows() && pc + 1 < z.cols()) {
          const double rise = z.at(pr, pc) - 0.25 * (static_cast<double>(z.at(pr, pc - 1)) +
                                                     z.at(pr, pc + 1) + z.at(pr - 1, pc) + z.at(pr + 1, pc));
          if (!std::isnan(rise)) place.curvature = rise;
        }
        float& error = errors.at(r, c) = static_cast<float>(place.error);
        if (std::isnan(error)) {
          ++found.missing;
        } else if (place.error == 0 && place.slope == 0) {
          ++found.equal_level;
          error = std::nanf("");
        } else {
          ++found.samples;
          if (number++ % step != 0) continue;
          const Xy at = plan_.metres(tile.window.col + c, tile.window.row + r);
          place.x = at.x, place.y = at.y;
          found.places.push_back(place);
        }
      }
    }
    found.near.add(errors, plan_.cell(tile.window.row + 0.5 * tile.window.rows));
  });
  return found;
}

}  // namespace sightbound
