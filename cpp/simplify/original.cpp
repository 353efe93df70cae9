// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/original.h"

namespace sightbound {

namespace {

// A height is the sum of a dozen products, each rounded to 2^-53 of it.
constexpr double kHeightRounding = 0x1p-48;
// A place where lines cross: four roundings of its column or row, in either.
constexpr double kCrossingRounding = 0x1p-50;
// The way from a place to where it is written may lead round the tip of a hole (of 45 degrees at least): by
// 1 / sin(22.5) of its length, and that in columns and rows.
constexpr double kDetour = 4;

}  // namespace

Original::Original(const Grid<float>& heights, const Grid<float>& tolerance, double constant,
                   const Window& window, double place_rounding)
    : heights_(heights), tolerance_(tolerance), constant_(constant), window_(window) {
  double highest = 0, steepest = 0, loosest = constant, steepest_tolerance = 0;
  const auto rise = [](double& most, double here, double beside) {
    if (std::abs(here - beside) > most) most = std::abs(here - beside);  // not when one is NaN
  };
  for (int r = 0; r < heights.rows(); ++r) {
    for (int c = 0; c < heights.cols(); ++c) {
      const double z = heights.at(r, c);
      if (std::isnan(z)) continue;
      highest = std::max(highest, std::abs(z));
      if (c > 0) rise(steepest, z, heights.at(r, c - 1));
      if (r > 0) rise(steepest, z, heights.at(r - 1, c));
      if (tolerance.empty()) continue;
      const double e = tolerance.at(r, c);
      loosest = std::max(loosest, e);
      if (c > 0) rise(steepest_tolerance, e, tolerance.at(r, c - 1));
      if (r > 0) rise(steepest_tolerance, e, tolerance.at(r - 1, c));
    }
  }
  // A place of a new face, given by weights of its corners, has one height wherever these are written; so
  // what counts is how much the original and its tolerance change on the way there. New faces may be as steep
  // as they like.
  const double steps = steepest + steepest_tolerance;
  written_ = kDetour * place_rounding * steps;
  const double farthest = std::max(window.row_end(), window.col_end());
  rounding_ = written_ + kHeightRounding * (highest + loosest) + kCrossingRounding * farthest * steps;
}

}  // namespace sightbound
