// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/wedge_march.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightbound {

namespace {

// At least so many wedges cross a cell side: more cost more than the cells they would prove.
constexpr double kWedgesPerCell = 1.0 / 3;
// Steps from the observer where the upper horizon begins: nearer, a corner's slope says nothing; and where
// strips may be leapt over: nearer, their distances differ too much.
constexpr double kFirstAbove = 2, kFirstLeap = 16;

double moving(const Scene& scene, const Eye& eye) {
  return scene.ends_move ? scene.largest_ratio * eye.sampling : 0;
}

}  // namespace

WedgeMarch::WedgeMarch(const Scene& scene, const Eye& eye, const TargetTops& tops, const FanBlock& block)
    : scene_(scene),
      tops_(tops),
      columns_(scene, eye, block),
      eye_above_(static_cast<float>(eye.height - moving(scene, eye))),
      height_pad_(pad_of_heights(eye)),
      loader_(scene, tops_, columns_, height_pad_),
      below_(columns_, static_cast<float>(eye.height + moving(scene, eye))),
      above_(columns_.base_major(), columns_.observer_major(), block.sign, block.reach, below_.wedges()) {}

void WedgeMarch::run(double reach_m, const WedgeFan::Visitor& visit) {
  const int first = columns_.first_major(), sign = columns_.sign();
  before_.place = columns_.place(first - 2 * sign);
  near_.place = columns_.place(first - sign);
  Strip strip;
  for (int major = first; take_strip(major, strip); major += sign * strip.count) {
    if (strip.first().distance.low() > reach_m) return;
    if (leap(strip, visit)) continue;
    for (std::size_t i = 0; i < static_cast<std::size_t>(strip.count); ++i) {
      if (strip.places[i].distance.low() > reach_m) return;
      step(strip.places[i], strip.places[i + 1], visit);
    }
  }
}

// From a column to the end of its node; false beyond the grid.
bool WedgeMarch::take_strip(int major, Strip& strip) const {
  if (!columns_.on_grid(major)) return false;
  const int on_grid = major + columns_.base_major(), in_node = on_grid % Strip::kMost;
  strip.count =
      columns_.sign() > 0 ? std::min(Strip::kMost - in_node, columns_.majors() - on_grid) : in_node + 1;
  for (int i = 0; i <= strip.count; ++i)
    strip.places[static_cast<std::size_t>(i)] = columns_.place(major + i * columns_.sign());
  return true;
}

void WedgeMarch::step(const ColumnPlace& here, const ColumnPlace& next, const WedgeFan::Visitor& visit) {
  if (columns_.is_off_grid(here)) {
    // Should a bent block come back, nothing is known of what it missed.
    above_.forget();
    here_.place = here;
    here_.rows = 0;
    here_.leapt = false;
  } else {
    loader_.load(near_.place, here, next, here_);
    targets(here_, visit);
    split(here.step);
    below_.raise(here, here_.first, here_.rows, here_.below.data());
  }
  move_on();
}

// The upper horizon stays two columns behind the targets: nearer places are judged without the measurement
// error.
void WedgeMarch::move_on() {
  raise(before_, near_);
  std::swap(before_, near_);
  std::swap(near_, here_);
}

// When the lower horizon hides all targets of the strip, and stands higher than all of its terrain at +K
// sigma: then the strip says nothing to those behind it either.
bool WedgeMarch::leap(const Strip& strip, const WedgeFan::Visitor& visit) {
  StripBounds most;
  if (strip.first().step < kFirstLeap || !bound(strip, most)) return false;
  const double wide = scene_.largest_ratio * (1 + 1e-6) * static_cast<double>(most.sigma),
               highest = static_cast<double>(most.height) + wide + height_pad_;
  const double ground = tops_.surface == nullptr ? 0.0 : static_cast<double>(most.height),
               top = ground + tops_.height + (scene_.ends_move ? wide : 0) + height_pad_;
  for (const ColumnPlace& p : strip.columns()) {
    if (is_thin(p)) return false;
  }
  if (!below_.hides(strip.columns(), std::max(top, highest))) return false;

  for (int i = 0; i < strip.count; ++i) {
    const ColumnPlace& here = strip.places[static_cast<std::size_t>(i)];
    const RowRange rows = columns_.targets_at(here);
    if (!rows.empty()) visit(column_at(here, rows), [](int) { return OpenParts(); });
  }
  split(strip.last().step);
  here_.place = strip.last();
  here_.leapt = true;
  here_.highest = static_cast<float>(highest);
  move_on();
  return true;
}

// False where more than the pyramids tell has a say: holes, the rim, targets that stand on something else.
bool WedgeMarch::bound(const Strip& strip, StripBounds& most) const {
  if (tops_.surface != nullptr && tops_.surface != &scene_.heights) return false;
  double low = near_.place.minor.low(), high = near_.place.minor.high();
  for (int i = 0; i <= strip.count; ++i) {
    const Fan3& minor = strip.places[static_cast<std::size_t>(i)].minor;
    low = std::min(low, minor.low());
    high = std::max(high, minor.high());
  }
  const int from = static_cast<int>(std::floor(low)) - TerrainColumn::kMargin + columns_.base_minor(),
            to = static_cast<int>(std::ceil(high)) + TerrainColumn::kMargin + columns_.base_minor();
  if (from < 0 || to >= columns_.minors()) return false;
  constexpr int kLevel = MaxPyramid::kFinest;
  // The last sample of all may have no node of its own.
  const int along = std::min((strip.first().major + columns_.base_major()) >> kLevel,
                             scene_.highest.finest_nodes(columns_.transposed()) - 1);
  most = {std::numeric_limits<float>::lowest(), static_cast<float>(scene_.least_sigma)};
  for (int across = from >> kLevel; across <= (to - 1) >> kLevel; ++across) {
    const int row = columns_.transposed() ? along : across, col = columns_.transposed() ? across : along;
    if (scene_.highest.has_hole(kLevel, row, col)) return false;
    most.height = std::max(most.height, scene_.highest.max(kLevel, row, col));
    if (!scene_.uniform) most.sigma = std::max(most.sigma, scene_.widest.max(kLevel, row, col));
  }
  return true;
}

// Wedges too thin for their pad.
bool WedgeMarch::is_thin(const ColumnPlace& p) const {
  return 2 * columns_.pad(p) >= static_cast<float>(columns_.width(p, below_.wedges()));
}

void WedgeMarch::targets(const TerrainColumn& column, const WedgeFan::Visitor& visit) {
  const ColumnPlace& here = column.place;
  const RowRange rows = columns_.targets_at(here);
  if (rows.empty()) return;
  TargetStep step;
  step.first_row = rows.low - column.first;
  step.rows = rows.count();
  step.wedges = below_.wedges();
  step.edges = columns_.edges(here, column.first, below_.wedges());
  step.pad = columns_.pad(here);
  step.drop_low = columns_.least_drop(here, below_.wedges());
  step.drop_high = columns_.most_drop(here, below_.wedges());
  step.eye_above = eye_above_;
  step.eye_below = below_.eye();
  step.least = columns_.largest_inverse(here);
  step.most = columns_.smallest_inverse(here);
  const bool sure = !is_thin(here);
  states_.resize(static_cast<std::size_t>(whole_vectors(step.rows)));
  if (sure) {
    judge_targets(step, below_.slopes(), column.top_below.data(), states_.data());
  } else {
    std::fill(states_.begin(), states_.end(), static_cast<std::int32_t>(kOpen));
  }
  FanColumn out = column_at(here, rows);
  out.state = states_.data();
  visit(out, [&](int i) {
    const WedgePair wedge = wedges_of(step, i);
    const float top = column.top_above[static_cast<std::size_t>(step.first_row + i)];
    return above_.open_parts(wedge, flattest_slope(step, wedge.a, top), sure, out.major);
  });
}

FanColumn WedgeMarch::column_at(const ColumnPlace& here, const RowRange& rows) const {
  FanColumn out;
  out.transposed = columns_.transposed();
  out.major = here.major + columns_.base_major();
  out.first_minor = rows.low + columns_.base_minor();
  out.count = rows.count();
  out.least_distance = here.distance.low();
  out.most_distance = here.distance.high();
  return out;
}

void WedgeMarch::split(double step) {
  while (below_.wedges() * kBlocksPerUnit < kWedgesPerCell * step) {
    below_.split();
    above_.split();
  }
}

void WedgeMarch::raise(const TerrainColumn& near_column, const TerrainColumn& column) {
  const ColumnPlace &near = near_column.place, &here = column.place;
  if (near.step < kFirstAbove) return;
  if (near_column.leapt || column.leapt || near_column.rows == 0 || column.rows == 0) {
    raise_all(near_column, column);
    return;
  }
  const int first = std::max(near_column.first, column.first);
  const int end = std::min(near_column.first + near_column.rows, column.first + column.rows);
  WedgeStep step;
  step.wedges = below_.wedges();
  step.near = columns_.edges(near, first, below_.wedges());
  step.far = columns_.edges(here, first, below_.wedges());
  step.pad = std::max(columns_.pad(near), columns_.pad(here));
  step.rows = end - first;
  const double shift = std::max(std::abs(here.minor.a - near.minor.a), std::abs(here.minor.b - near.minor.b));
  step.window =
      window_for(std::max(columns_.width(near, below_.wedges()), columns_.width(here, below_.wedges())) +
                 shift + 2 * static_cast<double>(step.pad));
  cells_.resize(static_cast<std::size_t>(end - first + step.window + 2 * kVector));
  highest_corners(end - first - 1, near_column.above.data() + (first - near_column.first),
                  column.above.data() + (first - column.first), cells_.data());
  widen_highest(end - first - 1, step.window, cells_.data());
  step.drop_low = columns_.least_drop(near, below_.wedges());
  step.eye_above = eye_above_;
  step.near_least = columns_.largest_inverse(near);
  step.far_most = columns_.smallest_inverse(here);
  raise_above(step, cells_.data(), above_.between(near.major, here.major));
}

void WedgeMarch::raise_all(const TerrainColumn& near, const TerrainColumn& here) {
  const float over = std::max(near.highest_above(), here.highest_above()) -
                     columns_.least_drop_of_all(near.place, below_.wedges()) - eye_above_;
  const float slope =
      over * (over > 0 ? columns_.largest_inverse(near.place) : columns_.smallest_inverse(here.place));
  above_.raise_all(near.place.major, here.place.major, slope);
}

}  // namespace sightbound
