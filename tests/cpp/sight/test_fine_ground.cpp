// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <gtest/gtest.h>

#include "error_model/fractal_surface.h"
#include "error_model/posterior.h"
#include "sight/fine_ground.h"
#include "support/rough_ground.h"

namespace sightbound {
namespace {

constexpr int kSide = 40;

double parabola(double row, double col) {
  return 100 + 0.4 * col - 0.3 * (col - 20) * (col - 20) + 0.2 * (row - 15) * (row - 15);
}

// Ground that is known to be one, with the gain that belongs to it.
class Parabola {
 public:
  explicit Parabola(bool transposed)
      : ground_(smooth()),
        behind_(posterior(ground_.heights, ground_.error, Workers(1), progress_)),
        terrain_{ground_.heights, none_, ground_.error, 0, 0, 1, &behind_.rises},
        fine_(terrain_, transposed, 0, 0) {}
  Parabola(const Parabola&) = delete;
  Parabola& operator=(const Parabola&) = delete;
  const FineGround& fine() const { return fine_; }

 private:
  static testing::RoughGround smooth() {
    testing::RoughGround ground = testing::rough_ground(kSide, kSide, 0, false);
    for (int r = 0; r < kSide; ++r) {
      for (int c = 0; c < kSide; ++c) ground.heights.at(r, c) = static_cast<float>(parabola(r, c));
    }
    ground.error.profile = {GeologicShape::kGrowth, 0, 1.3, 5};
    ground.error.surface = fractal_surface(1.3, CellContent::kSamples);
    ground.error.ridge_gain = 0.125;
    return ground;
  }

  const testing::RoughGround ground_;
  const SampleField none_{0.0f};
  Progress progress_;
  const Posterior behind_;
  const OpenTerrain terrain_;
  const FineGround fine_;
};

double drawn(const Departure& own, double middle) {
  Lanes out;
  draw_about(
      own, 0, [&](int) { return static_cast<float>(middle); }, out);
  return out.v[3];
}

class FineGrounds : public ::testing::TestWithParam<bool> {};

TEST_P(FineGrounds, BendAsTheGroundAroundDoes) {
  const bool transposed = GetParam();
  const Parabola ground(transposed);
  const auto height = [&](double major, double minor) {
    return transposed ? parabola(major, minor) : parabola(minor, major);
  };
  for (const double part : {0.2, 0.5}) {
    const double minor = 17 + 0.5 * part, major = 22 + 0.5 * part;
    const double beside = (1 - part) * height(23, 17) + part * height(23, 17.5);
    EXPECT_NEAR(drawn(ground.fine().across({23, minor, 50}, {0, kNodeStep}, part), beside), height(23, minor),
                1e-4);
    const double along = (1 - part) * height(22, 12.5) + part * height(22.5, 12.5);
    EXPECT_NEAR(drawn(ground.fine().across({major, 12.5, 50}, {kNodeStep, 0}, part), along),
                height(major, 12.5), 1e-4);
  }
  const double four = (height(10, 11) + height(10.5, 11) + height(10, 11.5) + height(10.5, 11.5)) / 4;
  EXPECT_NEAR(drawn(ground.fine().inside({10.25, 11.25, 0}, 0.5, 0.5), four), height(10.25, 11.25), 1e-4);
  FinePlaces places;
  ground.fine().between({20, 30, 100}, {20.5, 30.2, 106}, 0, Fineness::kQuarters, places);
  EXPECT_NEAR(drawn(places[0].draw, (height(20, 30) + height(20.5, 30.2)) / 2), height(20.25, 30.1), 1e-4);
  EXPECT_NEAR(drawn(places[2].draw, (height(20.25, 30.1) + height(20.5, 30.2)) / 2), height(20.375, 30.15),
              1e-4);
}

INSTANTIATE_TEST_SUITE_P(BothWays, FineGrounds, ::testing::Bool());

}  // namespace
}  // namespace sightbound
