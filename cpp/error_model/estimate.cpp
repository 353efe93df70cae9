// SPDX-License-Identifier: GPL-3.0-or-later
// Method. At each sample and for q = 1, 2 (spacing 2q; the sample lies half a spacing from its neighbours):
//
//   e_q = z - (z before + z after) / 2, neighbours q away along the row, the column and the NW-SE diagonal
//
// H comes from rows and columns alone, at the same places for both q; the diagonal, sqrt2 times as far, joins
// in afterwards. The same three residuals make the local map (local_variation.h). Wider spacings tell samples
// from means (residual_growth.h); tails and scale are what the DEM's own samples show (self_check.h).
#include "error_model/estimate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>

#include "error_model/fractal_surface.h"
#include "error_model/local_variation.h"
#include "error_model/residual_growth.h"
#include "error_model/rounding.h"
#include "error_model/self_check.h"

namespace sightbound {

namespace {

constexpr std::size_t kEnough = 1000;  // places; with fewer, further blocks are read
constexpr std::size_t kFewest = 64;    // places that H may be measured on
constexpr double kUsualExponent = 1;   // bare earth: median 1.0-1.1 of sixteen lidar terrains
constexpr double kLeastExponent = 0.1, kLargestExponent = 2;
// Of the score. What is taken for means by mistake comes out too cautious, not too bold.
constexpr double kMeansFrom = 0.65;
constexpr double kLeastOfMeans =
    0.12;                         // H; if means had to be rougher, it is H that changes with the spacing
constexpr float kHighest = 1e5f;  // metres; no height on Earth, but a spike or an undeclared nodata value

struct Residuals {
  std::size_t places = 0, near_places = 0;      // with both q; with q = 1
  double edge = 0, edge_far = 0, diagonal = 0;  // sums of squares at `places`
  double near_edge = 0, near_diagonal = 0;      // at `near_places`
  double highest = 0;                           // absolute height of those blocks
};

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof(buffer), "%.2f", value);
  return buffer;
}

// Doubled residual of the sample at `z` from neighbours `offset` away on both sides.
double residual(const float* z, std::ptrdiff_t offset) {
  return (static_cast<double>(*z) - z[-offset]) + (static_cast<double>(*z) - z[offset]);
}

void add_place(const float* z, std::ptrdiff_t stride, bool far_known, Residuals& sums) {
  const double row = residual(z, 1), col = residual(z, stride), diagonal = residual(z, stride + 1);
  const double edge = (row * row + col * col) / 8, along_diagonal = diagonal * diagonal / 4;
  if (std::isnan(edge + along_diagonal)) return;
  ++sums.near_places;
  sums.near_edge += edge;
  sums.near_diagonal += along_diagonal;
  if (!far_known) return;
  const double row_far = residual(z, 2), col_far = residual(z, 2 * stride);
  const double edge_far = (row_far * row_far + col_far * col_far) / 8;
  if (std::isnan(edge_far)) return;
  ++sums.places;
  sums.edge += edge;
  sums.edge_far += edge_far;
  sums.diagonal += along_diagonal;
}

// Growth is measured on small tiles, each by itself, and then averaged: where terrain is cut off at a coast,
// or a cliff stands in a plain, the few large steps would else speak for all.
constexpr int kTile = 32;
struct Tile {
  double places, near_ms, far_ms;
};

void add_block(const Grid<float>& block, Residuals& sums, std::vector<Tile>& tiles) {
  const int rows = block.rows(), cols = block.cols();
  for (int top = 0; top < rows; top += kTile) {
    for (int left = 0; left < cols; left += kTile) {
      const std::size_t places = sums.places;
      const double near = sums.edge, far = sums.edge_far;
      for (int r = std::max(top, 1); r < std::min(top + kTile, rows - 1); ++r) {
        const bool row_far = r >= 2 && r < rows - 2;
        for (int c = std::max(left, 1); c < std::min(left + kTile, cols - 1); ++c) {
          add_place(block.row(r) + c, cols, row_far && c >= 2 && c < cols - 2, sums);
        }
      }
      if (sums.places == places) continue;
      const auto n = static_cast<double>(sums.places - places);
      tiles.push_back({n, (sums.edge - near) / n, (sums.edge_far - far) / n});
    }
  }
}

void drop_spikes(Grid<float>& block, Residuals& sums) {
  for (float& z : block.values()) {
    if (std::abs(z) > kHighest) z = std::numeric_limits<float>::quiet_NaN();
    if (z == z) sums.highest = std::max(sums.highest, std::abs(static_cast<double>(z)));
  }
}

// Windows (core's row order) on a lattice anchored to the file's first row and column: the spread ones first,
// then the rest.
class Blocks {
 public:
  explicit Blocks(const DemSource& source)
      : rows_(source.rows()), cols_(source.cols()), flipped_(source.flipped()) {
    constexpr int kSide = kEstimateBlockSide;
    constexpr std::size_t kSmall = std::size_t{kEstimateBlocks} * kSide * kSide;
    if (source.window().cells() <= kSmall) {
      windows_.push_back(source.window());
      spread_ = 1;
      return;
    }
    const int down = (rows_ + kSide - 1) / kSide, across = (cols_ + kSide - 1) / kSide;
    int take_down = std::min(down, 8);
    const int take_across = std::min(across, kEstimateBlocks / take_down);
    take_down = std::min(down, kEstimateBlocks / take_across);
    std::vector<char> taken(static_cast<std::size_t>(down) * static_cast<std::size_t>(across));
    for (int i = 0; i < take_down; ++i) {
      for (int j = 0; j < take_across; ++j) {
        const int r = middle(i, take_down, down), c = middle(j, take_across, across);
        taken[static_cast<std::size_t>(r) * static_cast<std::size_t>(across) + static_cast<std::size_t>(c)] =
            1;
        windows_.push_back(tile(r, c));
      }
    }
    spread_ = windows_.size();
    for (int r = 0; r < down; ++r) {
      for (int c = 0; c < across; ++c) {
        if (!taken[static_cast<std::size_t>(r) * static_cast<std::size_t>(across) +
                   static_cast<std::size_t>(c)]) {
          windows_.push_back(tile(r, c));
        }
      }
    }
  }

  const std::vector<Window>& windows() const { return windows_; }
  std::size_t spread() const { return spread_; }

 private:
  // Tile at the middle of the i-th of n equal parts.
  static int middle(int i, int n, int tiles) { return static_cast<int>((2LL * i + 1) * tiles / (2LL * n)); }

  Window tile(int r, int c) const {
    constexpr int kSide = kEstimateBlockSide;
    Window w{c * kSide, r * kSide, 0, 0};
    w.cols = std::min(kSide, cols_ - w.col);
    w.rows = std::min(kSide, rows_ - w.row);
    if (flipped_) w.row = rows_ - w.row_end();
    return w;
  }

  int rows_, cols_;
  bool flipped_;
  std::vector<Window> windows_;
  std::size_t spread_ = 0;
};

// A residual holds the sample's own rounding and half of the sum of two others'.
constexpr double kRoundingShare = 1.5;

// Rounded heights add the same to the residuals of every spacing and hide the growth of what is left.
double exponent_of(const std::vector<Tile>& tiles, double rounding_m, double float_noise) {
  constexpr double kLeastLeft = 0.1;
  const double rounding = kRoundingShare * rounding_m * rounding_m;
  double sum = 0, places = 0;
  for (const Tile& tile : tiles) {
    if (std::sqrt(tile.near_ms) <= float_noise) continue;  // flat
    const double left = std::max(tile.near_ms - rounding, kLeastLeft * tile.near_ms);
    sum += tile.places * 0.5 * std::log2(std::max(tile.far_ms - rounding, left) / left);
    places += tile.places;
  }
  return places > 0 ? sum / places : kUsualExponent;
}

void judge_growth(const Residuals& sums, const std::vector<Tile>& tiles, Estimate& out) {
  const auto places = static_cast<double>(sums.places);
  out.edge_ms = sums.edge / places;
  out.diagonal_ms = sums.diagonal / places;
  const double float_noise = std::numeric_limits<float>::epsilon() * sums.highest;
  if (std::sqrt(out.edge_ms) <= float_noise) {
    out.edge_ms = out.diagonal_ms = 0;
    out.warnings.push_back(
        "The DEM is flat or one plane as far as looked at: nothing can be learnt of what lies between its "
        "samples, and the error between them is taken as 0. If it is not flat in truth, give vertical_rmse "
        "and geologic_variation.");
    return;
  }
  const double exponent = exponent_of(tiles, out.rounding_m, float_noise);
  out.growth_exponent = out.content == CellContent::kMeans
                            ? exponent_from_apparent(exponent, out.content)
                            : std::clamp(exponent, kLeastExponent, kLargestExponent);
  if (exponent > kOversampledExponent) {
    out.warnings.push_back(
        "The DEM is smoother than its cell size (growth exponent H = " + text(exponent) +
        "): it was probably resampled from a coarser one, or smoothed, and does not show the ground as "
        "finely as "
        "its cells suggest. The estimated error is too small; give vertical_rmse and geologic_variation.");
  }
}

void judge_few(const Residuals& sums, Estimate& out) {
  out.growth_exponent = kUsualExponent;
  if (sums.near_places > 0) {
    const auto places = static_cast<double>(sums.near_places);
    out.edge_ms = sums.near_edge / places;
    out.diagonal_ms = sums.near_diagonal / places;
  }
  out.warnings.push_back("The DEM has only " + std::to_string(sums.places) +
                         " places to measure its error at (needed: " + std::to_string(kFewest) +
                         "), because it is small or full of holes. The growth of the error is "
                         "taken as usual for bare earth (H = 1) and its size from " +
                         std::to_string(sums.near_places) +
                         " places; better give vertical_rmse and geologic_variation.");
}

void judge_content(const ResidualGrowth& growth, std::optional<CellContent> asked, Estimate& out) {
  out.content = asked.value_or(CellContent::kSamples);
  if (growth.places() < kEnough || growth.rms(0) <= 0) return;
  for (int i = 0; i < 3; ++i) out.rms_of_spacing[i] = growth.rms(i);
  out.ridge_gain = growth.ridge_gain();
  out.content_score = growth.means_score();
  const bool rough_enough = exponent_from_apparent(growth.exponent(0), CellContent::kMeans) >= kLeastOfMeans;
  if (!asked && rough_enough && out.content_score >= kMeansFrom) out.content = CellContent::kMeans;
}

// Residuals are so small that rounding hides how they grow and how they are distributed.
bool rounding_shows(const Estimate& found) {
  constexpr double kHidden = 0.05;  // its share in them
  return kRoundingShare * found.rounding_m * found.rounding_m > kHidden * found.edge_ms;
}

// What lies between the samples is of shorter spacings than those measured.
void continue_growth(const ResidualGrowth& growth, Estimate& out) {
  if (growth.places() < kEnough || out.edge_ms <= 0 || rounding_shows(out)) return;
  out.growth_exponent =
      std::clamp(growth.continued(out.growth_exponent, 0, out.content), kLeastExponent, kLargestExponent);
}

void check_itself(const std::vector<Grid<float>>& blocks, const ResidualGrowth& growth, Estimate& out,
                  Progress& progress) {
  if (out.rms_of_spacing[0] <= 0) return;
  const double measured = growth.exponent(1);
  const double exponent =
      rounding_shows(out) ? measured : growth.continued(measured, 1, CellContent::kSamples);
  SelfCheck check(std::clamp(exponent, kLeastExponent, kLargestExponent), out.rms_of_spacing[0]);
  for (const Grid<float>& block : blocks) check.add(block, progress);
  check.finish();
  if (check.places() < kEnough) return;
  const auto q = [&](double share) { return check.quantile(share); };
  out.self_check = {check.places(), q(0.5), q(0.683), q(0.9), q(0.95), q(0.99)};
  out.steps = check.steps();
  if (rounding_shows(out)) out.steps.level.tail = out.steps.step.tail = 0;
  out.tails = check.tails();
  out.local_scale = check.scale();
}

}  // namespace

double Estimate::typical_with(double exponent) const {
  const ResidualScale scale = residual_scale(exponent, content, local_scale);
  return scale.to_half_spacing * std::sqrt((2 * edge_ms + scale.diagonal * diagonal_ms) / 3);
}

Estimate estimate(const DemSource& source, std::optional<CellContent> content, Progress& progress) {
  Residuals sums;
  ResidualGrowth growth;
  std::vector<Tile> tiles;
  std::vector<Grid<float>> kept;
  RoundingDetector rounding;
  const Blocks blocks(source);
  for (std::size_t i = 0; i < blocks.windows().size(); ++i) {
    if (i >= blocks.spread() && sums.places >= kEnough) break;
    progress.check();
    Grid<float> block = source.read(blocks.windows()[i], progress);
    drop_spikes(block, sums);
    add_block(block, sums, tiles);
    growth.add(block);
    rounding.add(block);
    if (i < blocks.spread()) kept.push_back(std::move(block));
  }
  Estimate out;
  judge_content(growth, content, out);
  out.rounding_m = rounding.sd_m();
  if (sums.places >= kFewest) {
    judge_growth(sums, tiles, out);
  } else {
    judge_few(sums, out);
  }
  continue_growth(growth, out);
  check_itself(kept, growth, out, progress);
  out.typical_m = out.typical_with(out.growth_exponent);
  return out;
}

ErrorModel with_estimate(ErrorModel model, const Estimate& estimate) {
  if (std::holds_alternative<FromDem>(model.vertical_rmse)) model.vertical_rmse = estimate.rounding_m;
  if (std::holds_alternative<FromDem>(model.geologic_variation)) {
    model.geologic_shape = GeologicShape::kGrowth;
    if (!model.growth_exponent) model.growth_exponent = estimate.growth_exponent;
    if (!model.typical_m) model.typical_m = estimate.typical_with(*model.growth_exponent);
    if (!model.samples_or_means) model.samples_or_means = estimate.content;
    if (!model.local_scale) model.local_scale = estimate.local_scale;
    if (!model.ridge_gain) model.ridge_gain = estimate.ridge_gain;
    if (!model.tails) {
      model.tails = estimate.tails;
      if (!model.level_tail && !estimate.steps.is_normal()) {
        model.level_tail = estimate.steps.level.tail;
        model.step_tail = estimate.steps.step.tail;
      }
    }
    if (!estimate.steps.has_one_variance()) {
      if (!model.level_variance) model.level_variance = estimate.steps.level.variance;
      if (!model.step_variance) model.step_variance = estimate.steps.step.variance;
    }
  }
  return model;
}

}  // namespace sightbound
