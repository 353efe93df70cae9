// SPDX-License-Identifier: GPL-3.0-or-later
// Dead ground must be so on every line, also between samples: strewn lines to it are walked place by place.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "sight/dead_ground.h"
#include "support/rough_ground.h"

namespace sightbound {
namespace {

struct Case {
  double col, row;    // of the observer
  double rise, fall;  // metres
  bool holes = false;
  double latitude = -1;  // of a raster in degrees; none: a plane
  int rows = 90, cols = 110;
  bool slits = false;  // walls around the observer with narrow notches instead
};

// Lines of sight are narrow here: they pass between samples that are hidden, and touch squares by their
// corners alone.
testing::RoughGround walls_with_slits(const Case& test) {
  testing::RoughGround ground = testing::rough_ground(test.rows, test.cols, 0, false);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> depth(0.5f, 1), bumps(0, 0.5f);
  for (int r = 0; r < test.rows; ++r) {
    for (int c = 0; c < test.cols; ++c) {
      const double off = std::max(std::abs(r - test.row), std::abs(c - test.col));
      const float wall = off > 5 && off <= 6 ? 60.0f : off > 11 && off <= 12 ? 80.0f : 0.0f;
      ground.heights.at(r, c) = random() % 5 == 0 ? wall * (1 - depth(random)) : wall + bumps(random);
    }
  }
  return ground;
}

class Dead : public ::testing::TestWithParam<Case> {};

// NaN where a corner of the triangle is.
double height_at(const Grid<float>& z, double col, double row) {
  const int c = std::min(static_cast<int>(col), z.cols() - 2),
            r = std::min(static_cast<int>(row), z.rows() - 2);
  const double x = col - c, y = row - r;
  const double nw = z.at(r, c), se = z.at(r + 1, c + 1), corner = x >= y ? z.at(r, c + 1) : z.at(r + 1, c);
  return nw * (1 - std::max(x, y)) + corner * std::abs(x - y) + se * std::min(x, y);
}

// Along a line whose ends are equally high: where it passes over dead squares the ground, raised, must be
// below what has been passed, lowered. Returns the number of such places.
template <class IsDead>
int walk(const SightLine& line, const Eye& eye, const Case& test, const IsDead& is_dead) {
  std::vector<JudgedPlace> places;
  line.for_each_place([&](const JudgedPlace& place) { places.push_back(place); });
  std::ranges::sort(places, {}, &JudgedPlace::share);
  // Slopes of lines from the eye, the bulge of the Earth taken off.
  const auto slope = [&](const JudgedPlace& at, double z) {
    return (z - eye.height) / at.share - (eye.height - at.line) / (1 - at.share);
  };
  double horizon = -1e300;
  int found = 0;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const JudgedPlace &here = places[i], &next = places[i + 1];
    const double between = (here.xi + next.xi) / 2;
    const bool dead = is_dead(line.col(between) + eye.base_col, line.row(between) + eye.base_row);
    if (dead && !std::isnan(here.ground)) {
      ++found;
      EXPECT_LT(slope(here, here.ground + test.rise), horizon)
          << line.col(between) << " " << line.row(between);
    }
    if (!std::isnan(here.ground)) horizon = std::max(horizon, slope(here, here.ground - test.fall));
    if (dead && !std::isnan(next.ground)) {
      EXPECT_LT(slope(next, next.ground + test.rise), horizon)
          << line.col(between) << " " << line.row(between);
    }
  }
  return found;
}

Georeference ground_of(const Case& test) {
  if (test.latitude < 0) return Georeference(Geotransform({0, 10, 0, 0, 0, -10}));
  return Georeference(Geotransform({10, 0.02, 0, test.latitude, 0, -0.01}), Ellipsoid{},
                      [](std::span<double>, std::span<double>) {});
}

TEST_P(Dead, is_what_no_line_comes_near) {
  const Case& test = GetParam();
  testing::RoughGround ground =
      test.slits ? walls_with_slits(test) : testing::rough_ground(test.rows, test.cols, 0.1f, test.holes);
  const Georeference georeference = ground_of(test);
  if (test.latitude >= 0) {  // cells of a kilometre
    for (float& z : ground.heights.values()) z *= 200;
  }
  const Workers workers(2);
  Progress progress;
  const Scene scene(ground.heights, ground.error, {}, workers, progress);
  Eye eye;
  eye.base_col = static_cast<int>(test.col), eye.base_row = static_cast<int>(test.row);
  const ObserverFrame frame(georeference.of_window({eye.base_col, eye.base_row, 1, 1}),
                            test.col - eye.base_col, test.row - eye.base_row,
                            {-eye.base_col, -eye.base_row, test.cols, test.rows});
  eye.frame = &frame;
  eye.height = height_at(ground.heights, test.col, test.row) + 1;
  DeadGround dead(ground.heights);
  dead.look_from(scene, eye, test.rise, test.fall, workers, progress);

  EXPECT_FALSE(dead.holds(static_cast<int>(std::lround(test.row)), static_cast<int>(std::lround(test.col))));
  int samples = 0, lines = 0;
  for (int r = 0; r < test.rows; ++r) {
    for (int c = 0; c < test.cols; ++c) samples += dead.holds(r, c);
  }
  EXPECT_GT(samples, test.rows * test.cols / 20);
  const auto is_dead = [&](double col, double row) {
    const int c = static_cast<int>(col), r = static_cast<int>(row);
    for (const int i : {r, r + 1}) {
      for (const int j : {c, c + 1}) {
        if (i < test.rows && j < test.cols && dead.holds(i, j)) return true;
      }
    }
    return false;
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  int places = 0;
  for (int n = 0; n < 10000; ++n) {
    const double col = share(random) * (test.cols - 1), row = share(random) * (test.rows - 1);
    const SightLine line(scene, eye, {col - eye.base_col, row - eye.base_row, eye.height, 0});
    places += walk(line, eye, test, is_dead);
    ASSERT_FALSE(HasFailure()) << col << " " << row;
  }
  EXPECT_GT(places, 10000);
}

INSTANTIATE_TEST_SUITE_P(Places, Dead,
                         ::testing::Values(Case{40, 30, 0.5, 0.1}, Case{40.3, 30.7, 0.5, 0.1},
                                           Case{40.5, 30, 0, 0}, Case{0, 0, 1, 0.5}, Case{109, 89, 1, 0.5},
                                           Case{0, 44.2, 1, 0}, Case{40.3, 30.7, 0.5, 0.1, true},
                                           Case{12.2, 80.6, 2, 1, true}, Case{40.3, 30.7, 5, 1, false, 47},
                                           Case{12.2, 80.6, 5, 1, true, 68}, Case{109, 3, 5, 1, false, 20},
                                           Case{40.3, 30.7, 2, 0.1, false, -1, 90, 110, true},
                                           Case{60, 44, 5, 0, false, -1, 90, 110, true},
                                           Case{31, 52.5, 2, 1, false, -1, 90, 110, true}));

// Two see less dead ground than one, and any number of threads says the same.
TEST(DeadGround, is_dead_from_every_eye) {
  const testing::RoughGround ground = testing::rough_ground(70, 90, 0.1f, false);
  const Georeference plane{Geotransform({0, 10, 0, 0, 0, -10})};
  Progress progress;
  const Scene scene(ground.heights, ground.error, {}, Workers(1), progress);
  const auto look = [&](DeadGround& dead, int col, int row, const Workers& workers) {
    const ObserverFrame frame(plane.of_window({col, row, 1, 1}), 0, 0, {-col, -row, 90, 70});
    Eye eye;
    eye.frame = &frame, eye.base_col = col, eye.base_row = row;
    eye.height = static_cast<double>(ground.heights.at(row, col)) + 1;
    dead.look_from(scene, eye, 0.5, 0.1, workers, progress);
  };
  DeadGround first(ground.heights), second(ground.heights), both(ground.heights);
  look(first, 20, 50, Workers(1));
  look(second, 70, 15, Workers(1));
  look(both, 70, 15, Workers(3));
  look(both, 20, 50, Workers(2));
  for (int r = 0; r < 70; ++r) {
    for (int c = 0; c < 90; ++c) EXPECT_EQ(both.holds(r, c), first.holds(r, c) && second.holds(r, c));
  }
}

}  // namespace
}  // namespace sightbound
