// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/dead_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "sight/lower_horizon.h"
#include "sight/terrain_column.h"

namespace sightbound {

namespace {

// At least so many wedges cross a cell side.
constexpr double kWedgesPerCell = 1;
// Steps from the observer at which squares may be hidden: nearer, distances say nothing.
constexpr double kFirst = 0.5;

// One block of wedges on its way outward, square by square.
class DeadGroundMarch {
 public:
  DeadGroundMarch(const Scene& scene, const Eye& eye, const FanBlock& block, double rise, double fall,
                  DeadGround& dead)
      : scene_(scene),
        columns_(scene, eye, block),
        rise_(static_cast<float>(rise) + pad_of_heights(eye)),
        fall_(static_cast<float>(fall) + pad_of_heights(eye)),
        horizon_(columns_, static_cast<float>(eye.height)),
        dead_(dead) {}

  void run() {
    load(columns_.first_major() - columns_.sign(), near_);
    Strip strip;
    while (take_strip(strip)) {
      if (is_off_grid(strip) || is_dead(strip)) {
        load(strip[strip.size() - 1].major, near_);
        continue;
      }
      for (std::size_t i = 1; i < strip.size(); ++i) step(strip[i].major);
    }
  }

 private:
  // The columns of the squares in one node of the finest pyramid, from the one reached, nearest first.
  using Strip = std::vector<ColumnPlace>;

  // False at the rim.
  bool take_strip(Strip& strip) const {
    constexpr int kMost = 1 << MaxPyramid::kFinest;
    const int sign = columns_.sign(), major = near_.place.major;
    const int square = major + columns_.base_major() - (sign < 0 ? 1 : 0), in_node = square % kMost;
    strip.assign(1, near_.place);
    if (square < 0 || square > columns_.majors() - 2) return false;
    const int count = sign > 0 ? std::min(kMost - in_node, columns_.majors() - 1 - square) : in_node + 1;
    for (int i = 1; i <= count; ++i) strip.push_back(columns_.place(major + i * sign));
    return true;
  }

  bool is_off_grid(const Strip& strip) const {
    return std::all_of(strip.begin(), strip.end(), [&](const auto& p) { return columns_.is_off_grid(p); });
  }

  bool is_dead(const Strip& strip) const {
    return strip.front().step >= kFirst && horizon_.hides(strip, highest(strip));
  }

  // What the ground of a strip may rise to.
  double highest(const Strip& strip) const {
    double low = strip.front().minor.low(), high = strip.front().minor.high();
    for (const ColumnPlace& p : strip) {
      low = std::min(low, p.minor.low());
      high = std::max(high, p.minor.high());
    }
    const int last = columns_.minors() - 2;  // square
    const auto node_at = [&](double minor) {
      return std::clamp(static_cast<int>(std::floor(minor)) + columns_.base_minor(), 0, last) >>
             MaxPyramid::kFinest;
    };
    const int along =
        (std::min(strip.front().major, strip.back().major) + columns_.base_major()) >> MaxPyramid::kFinest;
    float top = std::numeric_limits<float>::lowest();
    for (int across = node_at(low - TerrainColumn::kMargin); across <= node_at(high + TerrainColumn::kMargin);
         ++across) {
      top = std::max(top, columns_.transposed() ? scene_.highest.max(MaxPyramid::kFinest, along, across)
                                                : scene_.highest.max(MaxPyramid::kFinest, across, along));
    }
    return static_cast<double>(top) + static_cast<double>(rise_);
  }

  // Where there is no terrain nothing is seen, and nothing hides.
  void load(int major, TerrainColumn& column) {
    column.begin(columns_.place(major - columns_.sign()), columns_.place(major),
                 columns_.place(major + columns_.sign()));
    heights_.resize(column.above.size());
    copy_rows(scene_.heights, columns_, column, std::numeric_limits<float>::quiet_NaN(), heights_);
    ColumnBounds bounds;
    bounds.count = column.rows;
    bounds.unknown = -kUnbounded;
    bounds.full = rise_;
    bounds.near_end = fall_;
    bound_column(bounds, heights_.data(), column.above.data(), column.below.data());
  }

  void step(int major) {
    load(major, here_);
    while (horizon_.wedges() * kBlocksPerUnit < kWedgesPerCell * here_.place.step) horizon_.split();
    judge_squares();
    horizon_.raise(here_.place, here_.first, here_.rows, here_.below.data());
    std::swap(near_, here_);
  }

  // Of the squares between both columns, those that a wedge does not hide are taken.
  void judge_squares() {
    const ColumnPlace &near = near_.place, &here = here_.place;
    const int wedges = horizon_.wedges(),
              first = std::max({near_.first, here_.first, -columns_.base_minor() - 1}),
              last = std::min({near_.first + near_.rows, here_.first + here_.rows,
                               columns_.minors() - columns_.base_minor() + 1}) -
                     2;
    const Linear a = columns_.edges(near, first, wedges), b = columns_.edges(here, first, wedges),
                 drop = columns_.least_drop(near, wedges);
    const float pad = std::max(columns_.pad(near), columns_.pad(here));
    const bool too_near = near.step < kFirst;
    const float rising = too_near ? 0 : columns_.largest_inverse(near),
                falling = columns_.smallest_inverse(here);
    for (int i = 0; i < wedges; ++i) {
      const float k = static_cast<float>(i), horizon = horizon_.slopes()[i];
      const float from = std::min(a.first + k * a.step, b.first + k * b.step) - pad,
                  to = std::max(a.first + (k + 1) * a.step, b.first + (k + 1) * b.step) + pad;
      const int end = std::min(static_cast<int>(std::floor(to)), last - first);
      for (int j = std::max(static_cast<int>(std::floor(from)), 0); j <= end; ++j) {
        const float over = highest_corner(first + j) - (drop.first + k * drop.step) - horizon_.eye();
        const float slope = over * (over > 0 ? rising : falling);
        if (too_near || !(horizon > slope + 2e-6f * (std::abs(slope) + std::abs(horizon))))
          take(std::min(near.major, here.major), first + j);
      }
    }
  }

  // Of the square from row `minor` to the next one.
  float highest_corner(int minor) const {
    const float* near = near_.above.data() + (minor - near_.first);
    const float* here = here_.above.data() + (minor - here_.first);
    return std::max(std::max(near[0], near[1]), std::max(here[0], here[1]));
  }

  void take(int major, int minor) {
    const int along = major + columns_.base_major(), across = minor + columns_.base_minor();
    dead_.take_square(columns_.transposed() ? along : across, columns_.transposed() ? across : along);
  }

  const Scene& scene_;
  FanColumns columns_;
  float rise_, fall_;
  LowerHorizon horizon_;
  TerrainColumn near_, here_;
  DeadGround& dead_;
  std::vector<float> heights_;  // scratch
};

}  // namespace

DeadGround::DeadGround(const Grid<float>& heights)
    : rows_(heights.rows()), cols_(heights.cols()), in_view_(heights.size()) {}

void DeadGround::look_from(const Scene& scene, const Eye& eye, double rise, double fall,
                           const Workers& workers, Progress& progress) {
  // Every geodesic from the eye leaves it within the half of one side's diagonals.
  std::vector<FanBlock> blocks;
  for (const bool transposed : {false, true}) {
    for (const int sign : {1, -1}) {
      const double reach = reach_of_side(scene, eye, transposed, sign);
      if (reach <= 0) continue;
      for (int index = -kBlocksPerUnit; index < kBlocksPerUnit; ++index)
        blocks.push_back({transposed, sign, index, std::max(reach, 1.0)});
    }
  }
  workers.for_each(blocks.size(), [&](std::size_t n) {
    progress.check();
    DeadGroundMarch(scene, eye, blocks[n], rise, fall, *this).run();
  });
}

void DeadGround::take_square(int row, int col) {
  for (int r = std::max(row, 0); r <= std::min(row + 1, rows_ - 1); ++r) {
    for (int c = std::max(col, 0); c <= std::min(col + 1, cols_ - 1); ++c)
      in_view_[index(r, c)].store(true, std::memory_order_relaxed);
  }
}

}  // namespace sightbound
