// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <memory>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/bodies.h"
#include "support/random_dem.h"
#include "support/says.h"
#include "volume/dem_surface.h"
#include "volume/surface.h"
#include "volume/tin_surface.h"

namespace sightbound {
namespace {

using testing::random_dem;
using testing::RandomDem;
using testing::says;

bool meets(const SurfaceFace& face, const Box3& box) {
  const auto overlap = [&](double a, double b, double c, double low, double high) {
    return std::min({a, b, c}) <= high && std::max({a, b, c}) >= low;
  };
  const auto& p = face.corner;
  return overlap(p[0].x, p[1].x, p[2].x, box.low.x, box.high.x) &&
         overlap(p[0].y, p[1].y, p[2].y, box.low.y, box.high.y) &&
         overlap(p[0].z, p[1].z, p[2].z, box.low.z, box.high.z);
}

// All faces whose box meets the query are found; what else is found meets it in plan or nearly so.
void expect_all_found(const Surface& surface, unsigned seed, bool exactly) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-0.2, 1.2);
  const Box3 all = surface.bounds();
  const Xyz size = all.high - all.low;
  std::vector<std::uint32_t> found;
  for (int n = 0; n < 100; ++n) {
    const Xyz low = all.low + Xyz{unit(random) * size.x, unit(random) * size.y, unit(random) * size.z};
    const Box3 box{low, low + (n % 3 == 0 ? 0.0 : 0.15 * n / 100) * size};
    surface.faces_near(box, found);
    const std::set<std::uint32_t> set(found.begin(), found.end());
    ASSERT_EQ(set.size(), found.size());
    ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
    for (std::size_t f = 0; f < surface.face_count(); ++f) {
      const auto face = surface.face(f);
      if (!face) {
        EXPECT_FALSE(set.contains(static_cast<std::uint32_t>(f)));
      } else if (meets(*face, box)) {
        EXPECT_TRUE(set.contains(static_cast<std::uint32_t>(f)));
      } else if (exactly) {
        EXPECT_FALSE(set.contains(static_cast<std::uint32_t>(f)));
      }
    }
  }
}

TEST(Surface, FindsTheFacesNearABox) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    expect_all_found(*random_dem(seed).surface(), seed, false);
    const Tin tin = testing::bridge(seed);
    expect_all_found(TinSurface(tin, testing::random_error(tin, seed, 1, 2, 0), Metric::kNormal), seed, true);
  }
}

TEST(Surface, DemFacesAreItsTriangles) {
  std::size_t places = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const RandomDem dem = random_dem(seed);
    const auto surface = dem.surface();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const Box3 box = surface->bounds();
    for (int n = 0; n < 200; ++n) {
      const double x = unit(random) * box.high.x, y = unit(random) * box.high.y;
      const RandomDem::Place wanted = dem.place(x, y);
      std::size_t holding = 0;
      for (std::size_t f = 0; f < surface->face_count(); ++f) {
        const auto face = surface->face(f);
        if (!face) continue;
        const auto& p = face->corner;
        int signs = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          const Xyz &a = p[i], &b = p[(i + 1) % 3];
          signs += (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) > 0 ? 1 : -1;
        }
        if (std::abs(signs) != 3) continue;
        ++holding;
        const SurfacePlace place = place_on(*face, surface->profile(), x, y);
        ASSERT_NEAR(place.height, wanted.height, 1e-9);
        ASSERT_NEAR(place.sigma(), wanted.sigma, 1e-9 + 1e-6 * wanted.sigma);
        ++places;
      }
      EXPECT_EQ(holding, std::isnan(wanted.height) ? 0u : 1u);
    }
  }
  EXPECT_GT(places, 4000u);
}

TEST(Surface, FrameLeadsToTheCrsAndBack) {
  const auto surface = random_dem(7).surface();
  const Xyz local{12.5, 3.25, -4};
  const Xyz there = surface->frame().to_crs(local), back = surface->frame().from_crs(there);
  EXPECT_NEAR(back.x, local.x, 1e-9);
  EXPECT_NEAR(back.y, local.y, 1e-9);
  EXPECT_EQ(there.z, -4);
  const auto face = *surface->face(0);
  const Xyz first = surface->frame().to_crs(face.corner[0]);
  EXPECT_NEAR(first.x, 5e5 + surface->input().geotransform.coefficients()[1] / 2, 1e-6);
}

TEST(Surface, ClosestPlaceOfATin) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Tin tin = testing::rough_ball(seed, 20, 0.4);
    const TinError error = testing::random_error(tin, seed, 1, 2, 0);
    const TinSurface surface(tin, error, Metric::kNormal);
    const Box3 box = bounds_of(tin);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-0.5, 1.5);
    for (int n = 0; n < 300; ++n) {
      const Xyz size = box.high - box.low;
      const Xyz x = box.low + Xyz{unit(random) * size.x, unit(random) * size.y, unit(random) * size.z};
      const testing::NearestByHand wanted = testing::nearest_by_hand(tin, error, x);
      const ClosestPlace found = surface.closest(x - Xyz{box.low.x, box.low.y, 0});
      EXPECT_NEAR(found.distance, wanted.distance, 1e-9);
      EXPECT_TRUE(std::find(wanted.faces.begin(), wanted.faces.end(), found.face) != wanted.faces.end());
    }
  }
}

// Koppe at the steepest face around; along the normal cos and sin of the slope.
TEST(Surface, ErrorOfATin) {
  Tin tin;
  tin.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {10, 10, 10}};
  tin.faces = {{0, 1, 2}, {1, 3, 2}};  // flat, and rising by 1 in x and in y: tan(slope) = sqrt2
  ErrorModel model;
  model.vertical_rmse = 0.5;
  model.horizontal_rmse = 2;
  model.geologic_variation = 1.0;
  model.geologic_shape = GeologicShape::kGrowth;
  model.growth_exponent = 0.7;
  const TinError vertical = resolve_tin_error(tin, model, Metric::kVertical);
  EXPECT_NEAR(static_cast<double>(vertical.sampling[0]), 0.5, 1e-6);
  EXPECT_NEAR(static_cast<double>(vertical.sampling[1]), 0.5 + 2 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(static_cast<double>(vertical.amplitude[3]), 1 / kZ95, 1e-6);
  const TinError normal = resolve_tin_error(tin, model, Metric::kNormal);
  EXPECT_NEAR(static_cast<double>(normal.sampling[0]), 0.5, 1e-6);
  EXPECT_NEAR(static_cast<double>(normal.sampling[3]), 0.5 / std::sqrt(3.0) + 2 * std::sqrt(2.0 / 3), 1e-6);
  tin.sigma_v = {1, std::nanf(""), 1, 3};
  EXPECT_NEAR(static_cast<double>(resolve_tin_error(tin, model, Metric::kVertical).sampling[0]), 1, 1e-6);
  EXPECT_NEAR(static_cast<double>(resolve_tin_error(tin, model, Metric::kVertical).sampling[1]),
              0.5 + 2 * std::sqrt(2.0), 1e-6);
  model.vertical_rmse = FromDem{};
  try {
    resolve_tin_error(tin, model, Metric::kVertical);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(says(error.what(), "vertex 1"));
  }
}

TEST(Surface, RefusesWhatDoesNotFit) {
  DemInput small{.heights = Grid<float>(1, 5, 0.0f),
                 .error = {},
                 .geotransform = Geotransform({0, 1, 0, 0, 0, -1}),
                 .crs_wkt = ""};
  EXPECT_THROW(DemSurface(std::move(small)), InvalidInput);
  DemInput empty{.heights = Grid<float>(3, 3, std::nanf("")),
                 .error = {},
                 .geotransform = Geotransform({0, 1, 0, 0, 0, -1}),
                 .crs_wkt = ""};
  empty.error.cell_sizes.assign(3, {1, 1});
  EXPECT_THROW(DemSurface(std::move(empty)), InvalidInput);
  const Tin tin = testing::bridge(1);
  EXPECT_THROW(TinSurface(tin, TinError{}, Metric::kNormal), InvalidInput);
}

}  // namespace
}  // namespace sightbound
