// SPDX-License-Identifier: GPL-3.0-or-later
// Rays of a probable viewshed: they leave the observer on geodesics, half a sample apart at the far end, and
// cross lines of nodes half a cell apart. A target asks the ray nearest to it, which passes at most a quarter
// of a sample off.
//
// Places are in samples from the eye's base sample: whatever window is in memory, they are the same.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "earth/observer_frames.h"
#include "sight/fine_ground.h"

namespace sightbound {

struct ProbableEye {
  const ObserverFrame* frame = nullptr;  // in coordinates from the base sample
  int base_col = 0, base_row = 0;        // of the terrain's grid
  double height = 1.7;                   // metres above the ground there
  Window reach;  // all that he could be asked about, on the terrain's grid or beyond: rays depend on it
  std::function<bool(int row, int col)> asks;  // about a cell of the terrain's grid
};

// Neighbouring rays of one side (east, west, north, south) of the eye.
struct RayBlock {
  bool transposed;
  int sign;
  int first, count, rays;  // of the side's rays
};

// All blocks of an eye. Every cell of his reach but the one he stands on belongs to one.
std::vector<RayBlock> ray_blocks(const ProbableEye&);

// Between two lines a ray may cross a row of nodes, those of that number: a share `part` of the way from the
// first line's node to the second's. Of two (a bowed geodesic near a diagonal) the higher-numbered.
struct RowCrossing {
  RayPlace place;
  int node;  // half cells
  double part;
};
std::optional<RowCrossing> row_between(const RayPlace& a, const RayPlace& b);

class RayFan {
 public:
  RayFan(const OpenTerrain&, const ProbableEye&, double bend, const RayBlock&);

  // One ray more on either side of the block's own: the targets between two blocks ask the nearest of all.
  int rays() const { return static_cast<int>(rays_.size()); }
  double per_2r(int ray) const { return rays_[at(ray)].per_2r; }

  // Lines of nodes, from the eye outward.
  int lines() const { return lines_; }
  int major(int line) const { return first_major_ + sign_ * line; }  // half cells from the base sample
  bool holds_targets(int line) const { return major(line) % 2 == 0; }
  double steps_to(int line) const { return std::abs(0.5 * major(line) - major_); }  // samples from the eye

  double minor(int ray, int line) const { return rays_[at(ray)].path.minor(steps_to(line)); }
  bool is_inside(double minor) const { return minor >= first_minor_ && minor <= last_minor_; }
  double distance(int ray, int line) const { return rays_[at(ray)].path.distance(steps_to(line)); }
  RayPlace eye() const { return {major_, minor_, 0}; }
  RayPlace crossing(int ray, int line, double minor) const {
    return {0.5 * major(line), minor, distance(ray, line)};
  }
  int node_inside(int node) const { return std::clamp(node, 2 * first_minor_, 2 * last_minor_); }
  // The nodes on either side of a crossing: half cells.
  int node_before(double minor) const { return static_cast<int>(std::floor(2 * minor)); }
  int node_behind(double minor) const { return std::min(node_before(minor) + 1, 2 * last_minor_); }

  // The block's targets on a line, samples, given where its rays cross it: those nearer to its own rays than
  // to others, within the side's half of the quadrant. Empty when from > to.
  struct Range {
    int from, to;
  };
  Range targets(int line, const std::vector<double>& minors) const;

  // From the base sample to the terrain's grid.
  int grid_major(int half_cells) const { return half_cells + 2 * base_major_; }
  int grid_minor(int half_cells) const { return half_cells + 2 * base_minor_; }
  int row_of(int line, int minor) const {
    return transposed_ ? base_major_ + major(line) / 2 : base_minor_ + minor;
  }
  int col_of(int line, int minor) const {
    return transposed_ ? base_minor_ + minor : base_major_ + major(line) / 2;
  }

 private:
  struct Ray {
    GeodesicRay path;
    double per_2r;
  };
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  void add_ray(const ProbableEye&, double bend, double slope, double reach);

  const bool transposed_;
  const int sign_;
  const int base_major_, base_minor_;
  const double major_, minor_;  // of the eye
  int first_minor_, last_minor_, first_major_, lines_;
  int own_from_, own_to_;
  bool first_of_side_, last_of_side_;
  std::vector<Ray> rays_;
};

}  // namespace sightbound
