// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_model/residual_growth.h"

#include <algorithm>
#include <cmath>

#include "error_model/fractal_surface.h"

namespace sightbound {

namespace {

constexpr int kReach = 8;              // of the widest spacing
constexpr int kTile = 32;              // samples: growth is measured on each by itself
constexpr double kOfNextOctave = 0.5;  // share of its change that the first octave is expected to have
constexpr double kOfTwists = 0.75;     // their share in the score
// In units of what means do: no DEM of means had more than 3; walls along the grid, whose twists stand at
// corners alone, have 5 and more.
constexpr double kMostOfMeans = 4;
constexpr double kMostContinued = 0.2;
constexpr double kLargestGain = 0.25;

// Doubled residual from samples `offset` away on both sides.
double residual(const float* z, std::ptrdiff_t offset) {
  return (static_cast<double>(*z) - z[-offset]) + (static_cast<double>(*z) - z[offset]);
}

double twist(const float* z, std::ptrdiff_t right, std::ptrdiff_t below) {
  return (static_cast<double>(z[0]) - z[right]) - (static_cast<double>(z[below]) - z[below + right]);
}

// The change from the first octave to the second, less what the terrain's own change may be.
double change(double first, double second, double third) {
  return (first - second) - kOfNextOctave * std::max(second - third, 0.0);
}

}  // namespace

void ResidualGrowth::add(const Grid<float>& block) {
  for (int top = kReach; top < block.rows() - kReach; top += kTile) {
    for (int left = kReach; left < block.cols() - kReach; left += kTile) {
      Tile tile{};
      add_tile(block, top, left, tile);
      if (tile.places == 0) continue;
      places_ += tile.places;
      for (std::size_t i = 0; i < kSpacings; ++i) squares_[i] += tile.squares[i];
      tiles_.push_back(tile);
    }
  }
}

void ResidualGrowth::add_tile(const Grid<float>& block, int top, int left, Tile& tile) {
  const std::ptrdiff_t stride = block.cols();
  const int bottom = std::min(top + kTile, block.rows() - kReach);
  const int right = std::min(left + kTile, block.cols() - kReach);
  for (int r = top; r < bottom; ++r) {
    for (int c = left; c < right; ++c) {
      const float* z = block.row(r) + c;
      for (const std::ptrdiff_t step : {std::ptrdiff_t{1}, stride}) {
        std::array<double, kSpacings> e;
        double all = 0;
        for (int i = 0; i < kSpacings; ++i)
          all += e[static_cast<std::size_t>(i)] = residual(z, step << i) / 2;
        const double far = static_cast<double>(z[-3 * step]) + z[3 * step];
        const double guide = 0.5 * ((static_cast<double>(z[-step]) + z[step]) - far);
        std::array<double, kTwists> twists;
        for (int i = 0; i < kTwists; ++i)
          all += twists[static_cast<std::size_t>(i)] = twist(z, std::ptrdiff_t{1} << i, stride << i);
        if (std::isnan(all + guide)) continue;
        ++tile.places;
        for (std::size_t i = 0; i < kSpacings; ++i) tile.squares[i] += e[i] * e[i];
        for (std::size_t i = 0; i < kTwists; ++i) tile.twists[i] += twists[i] * twists[i];
        guide_squares_ += guide * guide;
        guide_products_ += guide * e[0];
      }
    }
  }
}

double ResidualGrowth::rms(int spacing) const {
  return places_ > 0 ? std::sqrt(squares_[static_cast<std::size_t>(spacing)] / static_cast<double>(places_))
                     : 0;
}

double ResidualGrowth::exponent(int octave) const {
  const auto i = static_cast<std::size_t>(octave);
  double sum = 0, places = 0;
  for (const Tile& tile : tiles_) {
    if (tile.squares[i] <= 0 || tile.squares[i + 1] <= 0) continue;  // flat
    const auto n = static_cast<double>(tile.places);
    sum += n * 0.5 * std::log2(tile.squares[i + 1] / tile.squares[i]);
    places += n;
  }
  return places > 0 ? sum / places : 1;
}

double ResidualGrowth::continued(double h, int octave, CellContent content) const {
  const double of_content = apparent_exponent(h, content, octave) - apparent_exponent(h, content, octave + 1);
  const double change = exponent(octave) - exponent(octave + 1) - of_content;
  return h + std::clamp(kOfNextOctave * change, -kMostContinued, kMostContinued);
}

// log2 of twists over residuals, from spacing 2 to 1, tile by tile, averaged.
double ResidualGrowth::change_of_twists() const {
  double sum = 0, places = 0;
  for (const Tile& tile : tiles_) {
    const double product = tile.twists[0] * tile.squares[1], other = tile.twists[1] * tile.squares[0];
    if (product <= 0 || other <= 0) continue;  // flat
    const auto n = static_cast<double>(tile.places);
    sum += n * 0.5 * std::log2(product / other);
    places += n;
  }
  return places > 0 ? sum / places : 0;
}

double ResidualGrowth::means_score() const {
  const double h = exponent_from_apparent(exponent(0), CellContent::kMeans);
  const auto growth = [&](int octave) { return apparent_exponent(h, CellContent::kMeans, octave); };
  const auto twists = [&](int octave) { return twist_over_residual(h, CellContent::kMeans, octave); };
  const double by_growth =
      change(exponent(0), exponent(1), exponent(2)) / change(growth(0), growth(1), growth(2));
  const double by_twists = change_of_twists() / (twists(0) - twists(1));
  if (by_twists > kMostOfMeans) return 0;
  return kOfTwists * std::clamp(by_twists, 0.0, 1.0) + (1 - kOfTwists) * std::clamp(by_growth, 0.0, 1.0);
}

double ResidualGrowth::ridge_gain() const {
  return guide_squares_ > 0 ? std::clamp(guide_products_ / guide_squares_, 0.0, kLargestGain) : 0;
}

}  // namespace sightbound
