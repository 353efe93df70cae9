// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM is compared as the TIN of all its samples is.
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "verify/verify.h"
#include <gtest/gtest.h>

#include "base/error.h"
#include "terrain/regular_tin.h"
#include "terrain/triangulate.h"

namespace sightbound {
namespace {

constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

struct RoughDem {
  int rows = 14, cols = 17;
  std::vector<float> heights;

  RoughDem(unsigned seed, double holes) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int n = 0; n < rows * cols; ++n)
      heights.push_back(unit(random) < holes ? kHole : static_cast<float>(200 + 9 * unit(random)));
  }
  ArrayDem dem(const Geotransform& geotransform) const {
    return ArrayDem({heights.data(), rows, cols, std::nan(""), 1, nullptr}, geotransform, "");
  }
};

const Geotransform kNorthUp({500000, 10, 0, 4600000, 0, -10}), kSouthUp({500000, 10, 0, 4599860, 0, 10});

// Every third sample or so, over the same ground.
Tin thinned(const Tin& full, unsigned seed) {
  std::mt19937 random(seed);
  SurveyedPoints survey;
  for (const Xyz& p : full.vertices) {
    if (random() % 3 == 0) survey.points.push_back(full.to_crs(p));
  }
  Progress progress;
  Tin tin = triangulate(survey, {}, progress).tin;
  set_origin(tin, 1);
  return tin;
}

TEST(VerifyDem, is_the_regular_tin) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const RoughDem rough(seed, seed % 3 == 0 ? 0 : 0.1);
    const ArrayDem dem = rough.dem(seed % 2 ? kNorthUp : kSouthUp);
    Progress progress;
    const RegularTin regular = regular_tin(dem, 1, MemoryBudget(), progress);
    const Tin simplified = thinned(regular.tin, seed);

    std::vector<float> of_samples(dem.window().cells());
    for (std::size_t n = 0; n < of_samples.size(); ++n)
      of_samples[n] = 1 + 0.01f * static_cast<float>(n % 50);
    std::vector<float> of_vertices;
    for (std::size_t n = 0; n < regular.tin.vertices.size(); ++n)
      of_vertices.push_back(
          regular.samples.empty() ? of_samples[n] : of_samples[static_cast<std::size_t>(regular.samples[n])]);

    const VerifyReport of_tin = verify(regular.tin, simplified, {0, of_vertices}, {}, progress);
    const OriginalDem original(dem.read(dem.window(), progress), dem.geotransform(), simplified);
    const VerifyReport of_dem = verify_heights(original, simplified, {0, of_samples}, {}, progress);
    EXPECT_EQ(of_tin.original_faces, of_dem.original_faces);
    EXPECT_NEAR(of_tin.largest_deviation.bound, of_dem.largest_deviation.bound, 1e-9);
    EXPECT_NEAR(of_tin.largest_ratio.bound, of_dem.largest_ratio.bound, 1e-9);
    EXPECT_NEAR(of_tin.uncovered.m2, of_dem.uncovered.m2, 1e-6);
    EXPECT_NEAR(of_tin.surplus.m2, of_dem.surplus.m2, 1e-6);
    EXPECT_EQ(of_tin.uncovered_vertices, of_dem.uncovered_vertices);
    EXPECT_NEAR(of_tin.rms_deviation, of_dem.rms_deviation, 1e-9);
    // The thinned TIN closes the holes: what lies over them is surplus.
    if (seed % 3 != 0) {
      EXPECT_GT(of_dem.surplus.m2, 100);
    }
  }
}

TEST(VerifyDem, a_dem_without_a_face_is_refused) {
  const std::vector<float> nothing(4, kHole);
  const ArrayDem dem({nothing.data(), 2, 2, std::nan(""), 1, nullptr}, kNorthUp, "");
  Progress progress;
  const RoughDem rough(1, 0);
  const Tin tin = regular_tin(rough.dem(kNorthUp), 1, MemoryBudget(), progress).tin;
  const OriginalDem original(dem.read(dem.window(), progress), dem.geotransform(), tin);
  EXPECT_THROW(verify_heights(original, tin, {1}, {}, progress), InvalidInput);
}

}  // namespace
}  // namespace sightbound
