// SPDX-License-Identifier: GPL-3.0-or-later
// What the sweep proves must be so: every target is held against its own sight line, place by place.
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "sight/viewshed.h"
#include "support/rough_ground.h"

namespace sightbound {
namespace {

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
  bool ends_move = false;
  bool walled = false;  // a plain behind a wall instead, and hills behind the plain
};

// What is known well but for the plain, which lies in the shadow of the wall and just below lines to the
// hills: leapt over, it still has a say.
testing::RoughGround walled_plain(int rows, int cols, double eye_row, double eye_col) {
  testing::RoughGround ground = testing::rough_ground(rows, cols, 0, false);
  Grid<float> sampling(rows, cols);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const double off = std::max(std::abs(r - eye_row), std::abs(c - eye_col));
      const bool plain = off > 32 && off < 64;
      ground.heights.at(r, c) = off < 8    ? 100.0f
                                : off < 9  ? 111.9f
                                : plain    ? 107.0f
                                : off < 64 ? 100.0f
                                           : 116.0f;
      sampling.at(r, c) = plain ? 3.0f : 0.02f;
    }
  }
  ground.error.sampling = SampleField(std::move(sampling));
  return ground;
}

class Bracket : public ::testing::TestWithParam<Case> {};

TEST_P(Bracket, proves_nothing_that_its_line_denies_and_visits_every_target_once) {
  const Case& test = GetParam();
  testing::RoughGround ground = test.walled
                                    ? walled_plain(test.rows, test.cols, test.row, test.col)
                                    : testing::rough_ground(test.rows, test.cols, test.sigma, test.holes);
  if (test.varied) testing::vary_error(ground);
  const Workers workers(2);
  Progress progress;
  SceneOptions options;
  options.ends_move = test.ends_move;
  const Scene scene(ground.heights, ground.error, options, workers, progress);
  const auto sampling = [&](int row, int col) {
    return test.ends_move ? double(ground.error.sampling.at(row, col)) : 0.0;
  };
  const int base_col = static_cast<int>(test.col), base_row = static_cast<int>(test.row);
  const Georeference plane{Geotransform({0, 10, 0, 0, 0, -10})};
  const ObserverFrame frame(plane, test.col - base_col, test.row - base_row,
                            {-base_col, -base_row, test.cols, test.rows});
  Eye eye;
  eye.frame = &frame;
  eye.base_col = base_col;
  eye.base_row = base_row;
  eye.height = 112;
  eye.sampling = sampling(base_row, base_col);
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
        const SightLine line(
            scene, eye,
            {double(col - base_col), double(row - base_row), tops.at(row, col), sampling(row, col)});
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
  if (test.rows > 100) {
    EXPECT_GT(leapt, 100);
  }
}

INSTANTIATE_TEST_SUITE_P(Places, Bracket,
                         ::testing::Values(Case{0.5f, 40, 30, false}, Case{0.05f, 40.3, 30.7, false},
                                           Case{0.5f, 0, 0, false}, Case{0.5f, 89, 69, false},
                                           Case{0.2f, 17.5, 68.9, true}, Case{2.0f, 40, 30, true},
                                           Case{0, 130.4, 20.2, false, true, 260, 300},
                                           Case{0.3f, 20.4, 130.2, true, false, 261, 303},
                                           Case{0.3f, 301.5, 3, true, false, 260, 303},
                                           Case{0, 40, 30, true, true},
                                           Case{0.5f, 40, 30, false, false, 70, 90, true},
                                           Case{0.3f, 130.4, 20.2, false, false, 150, 170, true},
                                           Case{0, 20.4, 130.2, false, true, 151, 173, true},
                                           Case{0, 80, 75, false, false, 151, 163, false, true}));

// A canvas may be hidden everywhere to begin with: a cell that the fan passed over would be a false claim.
TEST(Fan, visits_every_cell_once_however_the_grid_lies_on_the_earth) {
  constexpr int kRows = 61, kCols = 83;
  const testing::RoughGround ground = testing::rough_ground(kRows, kCols, 0.1f, true);
  const Workers workers(2);
  Progress progress;
  const Scene scene(ground.heights, ground.error, {}, workers, progress);
  for (const double latitude : {-33.0, 0.2, 52.0, 71.0}) {
    const Georeference degrees(Geotransform({10, 0.05, 0, latitude, 0, -0.02}), Ellipsoid{},
                               [](std::span<double>, std::span<double>) {});
    for (const auto& [col, row] : {std::pair{41.0, 30.0},
                                   {40.4, 30.9},
                                   {0.0, 0.0},
                                   {82.0, 60.0},
                                   {0.5, 59.3},
                                   {81.7, 0.0},
                                   {82.0, 0.0},
                                   {33.0, 60.0}}) {
      const int base_col = static_cast<int>(col), base_row = static_cast<int>(row);
      const ObserverFrame frame(degrees.of_window({base_col, base_row, 1, 1}), col - base_col, row - base_row,
                                {-base_col, -base_row, kCols, kRows});
      Eye eye;
      eye.frame = &frame, eye.base_col = base_col, eye.base_row = base_row, eye.height = 110;
      const TargetTops tops{&ground.heights, 0};
      const WedgeFan fan(scene, eye, tops, 1e9);
      Grid<int> visits(kRows, kCols, 0);
      for (std::size_t block = 0; block < fan.blocks(); ++block) {
        fan.march(block, [&](const FanColumn& column, const WedgeFan::OpenPartsOf&) {
          for (int minor = column.first_minor; minor < column.first_minor + column.count; ++minor)
            ++(column.transposed ? visits.at(column.major, minor) : visits.at(minor, column.major));
        });
      }
      if (col == base_col && row == base_row) ++visits.at(base_row, base_col);  // his own, which is no target
      for (int r = 0; r < kRows; ++r) {
        for (int c = 0; c < kCols; ++c)
          ASSERT_EQ(visits.at(r, c), 1) << latitude << ": " << c << " " << r << " from " << col << " " << row;
      }
    }
  }
}

}  // namespace
}  // namespace sightbound
