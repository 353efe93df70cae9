// SPDX-License-Identifier: GPL-3.0-or-later
// What the sweep proves must be so: every target is held against its own sight line, place by place.
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "sight/viewshed.h"

namespace sightbound {
namespace {

struct Ground {
  Grid<float> heights;
  ErrorField error;
};

Ground rough_ground(int rows, int cols, float sigma, bool holes) {
  std::mt19937 random(11);
  std::normal_distribution<float> step(0, 2);
  Ground ground{Grid<float>(rows, cols), {}};
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const float before = c > 0 ? ground.heights.at(r, c - 1) : 100,
                  above = r > 0 ? ground.heights.at(r - 1, c) : 100;
      ground.heights.at(r, c) = (before + above) / 2 + step(random);
    }
  }
  if (holes) ground.heights.at(rows / 3, cols / 4) = std::numeric_limits<float>::quiet_NaN();
  ground.error.sampling = SampleField(sigma);
  ground.error.amplitude = SampleField(0.0f);
  ground.error.cell_sizes.assign(static_cast<std::size_t>(rows), {10, 10});
  ground.error.farthest.assign(static_cast<std::size_t>(rows), 10 / std::sqrt(2.0));
  ground.error.larger_side_m = 10;
  return ground;
}

// Error in patches, some ten times that of others: a search that takes one place's sigma for another's is
// found out.
void vary_error(Ground& ground) {
  constexpr int kPatch = 9;
  std::mt19937 random(12);
  std::exponential_distribution<float> peaked(2);
  const int rows = ground.heights.rows(), cols = ground.heights.cols();
  Grid<float> patches(rows / kPatch + 1, cols / kPatch + 1), sampling(rows, cols), amplitude(rows, cols);
  for (float& p : patches.values()) p = peaked(random);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      amplitude.at(r, c) = patches.at(r / kPatch, c / kPatch);
      sampling.at(r, c) = 0.02f + 0.1f * amplitude.at(r, c);
    }
  }
  ground.error.sampling = SampleField(std::move(sampling));
  ground.error.amplitude = SampleField(std::move(amplitude));
  ground.error.profile = {GeologicShape::kGrowth, 0, 0.7, 5};
}

// k* from every judged place, none skipped.
double by_every_place(const Scene& scene, const SightLine& line) {
  double k = scene.largest_ratio;
  line.for_each_place([&](const JudgedPlace& place) {
    k = std::min(k, std::isnan(place.ground) ? 0 : (place.line - place.ground) / place.sigma);
  });
  return std::max(k, -scene.largest_ratio);
}

struct Case {
  float sigma;
  double col, row;  // of the observer
  bool holes;
  bool varied = false;  // the error differs from sample to sample, and grows between them
  int rows = 70, cols = 90;
};

class Bracket : public testing::TestWithParam<Case> {};

TEST_P(Bracket, proves_nothing_that_its_line_denies_and_visits_every_target_once) {
  const Case& test = GetParam();
  Ground ground = rough_ground(test.rows, test.cols, test.sigma, test.holes);
  if (test.varied) vary_error(ground);
  const Workers workers(2);
  Progress progress;
  const Scene scene(ground.heights, ground.error, {}, workers, progress);
  const int base_col = static_cast<int>(test.col), base_row = static_cast<int>(test.row);
  const Georeference plane{Geotransform({0, 10, 0, 0, 0, -10})};
  const ObserverFrame frame(plane, test.col - base_col, test.row - base_row,
                            {-base_col, -base_row, test.cols, test.rows});
  Eye eye;
  eye.frame = &frame;
  eye.base_col = base_col;
  eye.base_row = base_row;
  eye.height = 112;
  const TargetTops tops{&ground.heights, 1.5};
  const WedgeFan fan(scene, eye, tops, 1e9);

  std::set<std::pair<int, int>> visited;
  int hidden = 0, open = 0, cleared = 0, leapt = 0;
  for (std::size_t block = 0; block < fan.blocks(); ++block) {
    fan.march(block, [&](const FanColumn& column, const WedgeFan::OpenPartsOf& parts_of) {
      leapt += column.all_hidden();
      for (int i = 0; i < column.count; ++i) {
        const int minor = column.first_minor + i;
        const int row = column.transposed ? column.major : minor,
                  col = column.transposed ? minor : column.major;
        EXPECT_TRUE(visited.emplace(row, col).second) << row << " " << col;
        if (std::isnan(ground.heights.at(row, col))) continue;
        const SightLine line(scene, eye,
                             {double(col - base_col), double(row - base_row), tops.at(row, col), 0});
        const double truth = by_every_place(scene, line);
        if (column.all_hidden() || column.state[i] == kSurelyHidden) {
          ++hidden;
          EXPECT_EQ(truth, -scene.largest_ratio) << row << " " << col;
        } else {
          ++open;
          const OpenParts parts = parts_of(i);
          int steps = 0;
          for (const MajorRange& part : parts) steps += part.to - part.from;
          cleared += steps < std::abs(column.major - (column.transposed ? base_row : base_col)) - 8;
          EXPECT_EQ(line.settle(parts, -1).k, truth) << row << " " << col;
          EXPECT_EQ(line.settle().k, truth) << row << " " << col;
        }
      }
    });
  }
  const bool on_sample = test.col == base_col && test.row == base_row;
  EXPECT_EQ(visited.size(), static_cast<std::size_t>(test.rows * test.cols - (on_sample ? 1 : 0)));
  EXPECT_GT(hidden, 100);
  EXPECT_GT(open, 100);
  EXPECT_GT(cleared, 10);
  if (test.rows > 100) EXPECT_GT(leapt, 100);
}

INSTANTIATE_TEST_SUITE_P(Places, Bracket,
                         testing::Values(Case{0.5f, 40, 30, false}, Case{0.05f, 40.3, 30.7, false},
                                         Case{0.5f, 0, 0, false}, Case{0.5f, 89, 69, false},
                                         Case{0.2f, 17.5, 68.9, true}, Case{2.0f, 40, 30, true},
                                         Case{0, 130.4, 20.2, false, true, 260, 300},
                                         Case{0.3f, 20.4, 130.2, true, false, 261, 303},
                                         Case{0.3f, 301.5, 3, true, false, 260, 303},
                                         Case{0, 40, 30, true, true}));

}  // namespace
}  // namespace sightbound
