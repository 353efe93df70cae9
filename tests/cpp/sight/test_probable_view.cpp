// SPDX-License-Identifier: GPL-3.0-or-later
// What is not drawn would have changed nothing: with bounds so wide that they prove nothing, and so all is
// drawn everywhere, fine ground included, the same is seen to the last bit.
#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sight/probable_view.h"
#include "support/rough_ground.h"

namespace sightbound {
namespace {

constexpr int kRows = 70, kCols = 90, kSixteens = 3;
const std::vector<float> kHeights = {1.7f, 0.0f, 12.0f};

struct Seen {
  std::vector<std::uint16_t> bits;  // by cell, height and sixteen
  std::size_t in_doubt = 0;
};

Seen look(const OpenTerrain& terrain, double col, double row, const Refinement& refinement) {
  const int base_col = static_cast<int>(col), base_row = static_cast<int>(row);
  const Georeference plane{Geotransform({0, 10, 0, 0, 0, -10})};
  const ObserverFrame frame(plane, col - base_col, row - base_row, {-base_col, -base_row, kCols, kRows});
  const ProbableEye eye{&frame, base_col, base_row, 1.7, {0, 0, kCols, kRows}, [&](int r, int c) {
                          return !std::isnan(terrain.mean.at(r, c));
                        }};
  ProbableView view(terrain, eye, kHeights, 0.87, refinement);
  CellLayers cells{Grid<Layers>(kRows, kCols, 0), Grid<Layers>(kRows, kCols, 0),
                   Grid<std::uint32_t>(kRows, kCols)};
  for (std::size_t b = 0; b < view.blocks(); ++b) view.bound(b, cells);
  Seen seen;
  seen.bits.resize(cells.open.size() * kHeights.size() * kSixteens);
  for (std::size_t n = 0; n < cells.open.size(); ++n) {
    cells.item.data()[n] = static_cast<std::uint32_t>(n * kHeights.size());
    for (std::size_t l = 0; l < kHeights.size(); ++l) {
      if (cells.seen.data()[n] >> l & 1)
        std::fill_n(seen.bits.begin() + static_cast<std::ptrdiff_t>((n * kHeights.size() + l) * kSixteens),
                    kSixteens, 0xFFFF);
    }
    seen.in_doubt += cells.open.data()[n] != 0 ? 1 : 0;
  }
  for (std::size_t b = 0; b < view.blocks(); ++b)
    view.look(b, cells, {32, kSixteens}, {seen.bits.data(), kSixteens});
  return seen;
}

struct Case {
  double col, row;
  float spread;  // of the samples
  bool holes, is_refined, is_learnt;
  bool is_steep = false;  // heavy tails, steps that count, errors that are correlated
  bool is_bent = false;   // ridges between nodes rise by more than draws do
};
class ProbableViews : public ::testing::TestWithParam<Case> {};

TEST_P(ProbableViews, see_the_same_as_when_all_is_drawn) {
  const Case& test = GetParam();
  testing::RoughGround ground = testing::rough_ground(kRows, kCols, 0, test.holes);
  testing::vary_error(ground);
  if (test.is_learnt) {
    ground.error.surface =
        fractal_surface(0.7, test.spread > 0 ? CellContent::kSamples : CellContent::kMeans);
    ground.error.ridge_gain = 0.1;
  }
  ground.error.sampling = SampleField(test.spread);
  if (test.is_steep) {
    ground.error.tails = Tails::kLaplace;
    ground.error.steps = {{0.3, 1.3}, {2.5, 0.2}, true};
    ground.error.noise = CorrelatedNoise(40, {10, 10});
  }
  if (test.is_bent) {
    ground.error.ridge_gain = 1;
    ground.error.amplitude = SampleField(0.002f);
    ground.error.profile.half_spacing_m = 5;
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kCols; ++c)
        ground.heights.at(r, c) = static_cast<float>(5 * std::sin(0.6 * c) * std::cos(0.5 * r));
    }
  }
  Progress progress;
  const Posterior behind = posterior(ground.heights, ground.error, Workers(1), progress);
  const Refinement refinement = test.is_refined ? Refinement::end_zones() : Refinement::none();
  OpenTerrain terrain{behind.mean.empty() ? ground.heights : behind.mean,
                      behind.spread,
                      ground.error,
                      5,
                      7,
                      3,
                      test.is_learnt ? &behind.rises : nullptr,
                      behind.has_shared() ? &behind.shared : nullptr,
                      largest_draw(ground.error)};
  const Seen made = look(terrain, test.col, test.row, refinement);
  terrain.largest_draw = 1e4f;
  const Seen everywhere = look(terrain, test.col, test.row, refinement);
  EXPECT_EQ(made.bits, everywhere.bits);
  EXPECT_LE(made.in_doubt, everywhere.in_doubt);
  const auto some = std::ranges::count_if(made.bits, [](std::uint16_t b) { return b != 0 && b != 0xFFFF; });
  EXPECT_GT(some, 100);  // or the test would say nothing
}

INSTANTIATE_TEST_SUITE_P(
    Eyes, ProbableViews,
    ::testing::Values(Case{45, 35, 0, false, true, false}, Case{45.3, 35.6, 0.2f, false, true, false},
                      Case{0, 0, 0.2f, true, true, false}, Case{89, 20, 0, true, false, false},
                      Case{30.5, 69, 0.5f, false, false, false}, Case{45, 35, 0, true, true, true},
                      Case{0.4, 60.5, 0.1f, false, true, true},
                      Case{45.3, 35.6, 0.2f, true, true, true, true},
                      Case{45.3, 35.6, 0, false, true, true, false, true}));

}  // namespace
}  // namespace sightbound
