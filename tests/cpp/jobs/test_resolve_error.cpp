// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/crs.h"
#include "io/raster_writer.h"
#include "jobs/resolve_error.h"
#include "support/says.h"
#include "support/scratch.h"
#include "support/terrains.h"

namespace sightbound {
namespace {

using testing::dem_of;
using testing::grid_from;
using testing::hills;
using testing::kNan;
using testing::part_of;
using testing::says;

constexpr int kRows = 60, kCols = 50;

Grid<float> terrain() {
  return grid_from(kRows, kCols, [](int r, int c) { return hills(r, c, 1, 6); });
}

ErrorModel given(double sigma_v, double delta) {
  ErrorModel model;
  model.vertical_rmse = sigma_v;
  model.geologic_variation = delta;
  return model;
}

struct Resolved {
  ErrorModel model;
  Grid<float> heights;
  ErrorField field;
  std::vector<std::string> warnings;
};

Resolved resolve(const ErrorModel& model, const DemSource& dem, const Window& window, int threads = 2) {
  Progress progress;
  Resolved out;
  out.model = complete_model(model, dem, out.warnings, progress);
  out.heights = dem.read(window, progress);
  out.field = resolve_error(out.model, dem, georeference_of(dem), window, out.heights, out.warnings,
                            Workers(threads), progress);
  return out;
}

Resolved resolve(const ErrorModel& model) {
  const auto dem = dem_of(terrain());
  return resolve(model, *dem, dem->window());
}

SharedGrid shared(Grid<float> values) { return std::make_shared<const Grid<float>>(std::move(values)); }

TEST(CompleteModel, ReadsNothingWhenNothingIsOpen) {
  class Unreadable final : public DemSource {
   public:
    Unreadable() : DemSource(10, 10, Geotransform(testing::kNorthUp), "") {}
    Grid<float> read(const Window&, Progress&) const override { throw IoError("read"); }
  };
  Progress progress;
  std::vector<std::string> warnings;
  EXPECT_NO_THROW(complete_model(given(1, 2), Unreadable(), warnings, progress));
  EXPECT_THROW(complete_model(ErrorModel(), Unreadable(), warnings, progress), IoError);
  EXPECT_THROW(complete_model(given(-1, 2), Unreadable(), warnings, progress), InvalidInput);
}

TEST(ResolveError, NumbersStayNumbers) {
  const Resolved r = resolve(given(0.75, 2));
  ASSERT_TRUE(r.field.sampling.is_constant());
  ASSERT_TRUE(r.field.amplitude.is_constant());
  EXPECT_EQ(r.field.sampling.constant(), 0.75f);
  EXPECT_FLOAT_EQ(r.field.amplitude.constant(), static_cast<float>(2 / kZ95));
  EXPECT_EQ(r.field.profile.shape, GeologicShape::kGaussian);
  EXPECT_EQ(r.field.profile.range_m, 0);
  EXPECT_DOUBLE_EQ(r.field.larger_side_m, 10);
  ASSERT_EQ(r.field.cell_sizes.size(), static_cast<std::size_t>(kRows));
  EXPECT_DOUBLE_EQ(r.field.farthest[7], std::hypot(5, 5));
}

TEST(ResolveError, ZeroIsZero) {
  const Resolved r = resolve(given(0, 0));
  EXPECT_EQ(r.field.sampling.constant(), 0);
  EXPECT_EQ(r.field.amplitude.constant(), 0);
  EXPECT_TRUE(r.warnings.empty());
}

TEST(ResolveError, NothingSaidIsLearnt) {
  ErrorModel model;
  model.samples_or_means = CellContent::kSamples;
  const Resolved r = resolve(model);
  EXPECT_TRUE(r.field.sampling.is_constant());
  EXPECT_EQ(r.field.sampling.constant(), 0);  // heights are not rounded
  ASSERT_FALSE(r.field.amplitude.is_constant());
  EXPECT_GT(r.field.amplitude.at(30, 30), 0);
  EXPECT_EQ(r.field.profile.shape, GeologicShape::kGrowth);
  EXPECT_EQ(r.field.profile.exponent, *r.model.growth_exponent);
  EXPECT_DOUBLE_EQ(r.field.profile.half_spacing_m, 5);
}

TEST(ResolveError, RecipesResolveTheSameAfterJson) {
  const auto dem = dem_of(terrain());
  const Resolved first = resolve(ErrorModel(), *dem, dem->window());
  const Resolved again = resolve(ErrorModel::from_json(first.model.to_json()), *dem, dem->window());
  EXPECT_EQ(first.model.to_json(), again.model.to_json());
  EXPECT_EQ(std::memcmp(first.field.amplitude.values().data(), again.field.amplitude.values().data(),
                        first.heights.size() * sizeof(float)),
            0);
}

TEST(ResolveError, HorizontalErrorCountsBySlope) {
  ErrorModel model = given(0.5, 0);
  model.horizontal_rmse = 2;
  const auto dem = dem_of(grid_from(20, 20, [](int, int c) { return 3.0 * c; }));  // tan 0.3
  const Resolved r = resolve(model, *dem, dem->window());
  EXPECT_FLOAT_EQ(r.field.sampling.at(10, 10), 1.1f);
}

TEST(ResolveError, ArraysAreCutToTheWindow) {
  ErrorModel model;
  model.vertical_rmse = shared(grid_from(kRows, kCols, [](int r, int c) { return r + 0.01 * c; }));
  model.geologic_variation = shared(grid_from(kRows, kCols, [](int r, int c) { return c + 0.01 * r; }));
  const auto dem = dem_of(terrain());
  const Resolved r = resolve(model, *dem, {10, 20, 5, 6});
  EXPECT_FLOAT_EQ(r.field.sampling.at(2, 3), 22.13f);
  EXPECT_FLOAT_EQ(r.field.amplitude.at(2, 3), static_cast<float>(13.22f / kZ95));
}

TEST(ResolveError, WithoutAValueTheGroundIsUnknown) {
  Grid<float> sigma(kRows, kCols, 1.0f), delta(kRows, kCols, 1.0f), heights = terrain();
  sigma.at(5, 5) = kNan;
  sigma.at(6, 5) = kNan;
  delta.at(7, 7) = kNan;
  heights.at(6, 5) = kNan;  // a hole already: not counted again
  ErrorModel model;
  model.vertical_rmse = shared(std::move(sigma));
  model.geologic_variation = shared(std::move(delta));
  const auto dem = dem_of(std::move(heights));
  const Resolved r = resolve(model, *dem, dem->window());
  EXPECT_TRUE(std::isnan(r.heights.at(5, 5)));
  EXPECT_TRUE(std::isnan(r.heights.at(7, 7)));
  EXPECT_FALSE(std::isnan(r.heights.at(5, 7)));
  ASSERT_EQ(r.warnings.size(), 2u);
  EXPECT_TRUE(says(r.warnings[0], "vertical_rmse has no value at 1 of 3000 cells"));
  EXPECT_TRUE(says(r.warnings[1], "geologic_variation has no value at 1 of 3000 cells"));
  for (const float s : r.field.sampling.values().values()) EXPECT_TRUE(std::isfinite(s));
  for (const float a : r.field.amplitude.values().values()) EXPECT_TRUE(std::isfinite(a));
}

TEST(ResolveError, BadArraysAreNamed) {
  const auto refusal = [](Grid<float> values) {
    ErrorModel model = given(1, 1);
    model.vertical_rmse = shared(std::move(values));
    try {
      resolve(model);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_TRUE(says(refusal(Grid<float>(3, 4, 1.0f)),
                   "vertical_rmse is an array of 3 x 4 values, but the DEM has 60 x 50"));
  EXPECT_TRUE(says(refusal(Grid<float>(kRows, kCols, -9999.0f)), "vertical_rmse (array) holds -9999"));
}

TEST(ResolveError, AnIncompleteModelIsRefused) {
  const auto dem = dem_of(terrain());
  Progress progress;
  std::vector<std::string> warnings;
  Grid<float> heights = dem->read(dem->window(), progress);
  EXPECT_THROW(resolve_error(ErrorModel(), *dem, georeference_of(*dem), dem->window(), heights, warnings,
                             Workers(1), progress),
               InvalidInput);
}

TEST(ResolveError, WindowsOfOneDemAgreeToTheLastBit) {
  Grid<float> sigma = grid_from(kRows, kCols, [](int r, int c) { return 1 + 0.1 * r + 0.001 * c; });
  sigma.at(30, 20) = kNan;  // its neighbours' slopes and local values still see the height
  ErrorModel model;
  model.vertical_rmse = shared(std::move(sigma));
  model.horizontal_rmse = 1.5;
  for (const auto& geotransform : {testing::kNorthUp, testing::kSouthUp}) {
    const auto dem = dem_of(terrain(), geotransform);
    const Resolved whole = resolve(model, *dem, dem->window(), 1);
    for (const Window& w :
         {Window{0, 0, 25, 30}, Window{21, 29, 9, 11}, Window{48, 58, 2, 2}, Window{0, 31, 50, 29}}) {
      const Resolved part = resolve(whole.model, *dem, w, 3);
      const auto same = [&](const Grid<float>& a, const Grid<float>& b) {
        const Grid<float> expected = part_of(b, w);
        return std::memcmp(a.data(), expected.data(), a.size() * sizeof(float)) == 0;
      };
      EXPECT_TRUE(same(part.field.sampling.values(), whole.field.sampling.values()));
      EXPECT_TRUE(same(part.field.amplitude.values(), whole.field.amplitude.values()));
      EXPECT_TRUE(same(part.heights, whole.heights));
      EXPECT_EQ(part.field.larger_side_m, whole.field.larger_side_m);
    }
  }
}

class ResolveErrorFiles : public testing::Scratch {};

TEST_F(ResolveErrorFiles, RastersAlignByGeoreference) {
  Progress progress;
  // Twice the DEM's cells, the same area: sigma rises by 0.1 m per 20 m eastwards.
  const Grid<float> sigma = grid_from(kRows / 2, kCols / 2, [](int, int c) { return 1 + 0.1 * c; });
  write_raster(path("sigma.tif"), sigma, Geotransform({0, 20, 0, 0, 0, -20}), "", {}, 1, progress);
  ErrorModel model = given(0, 1);
  model.vertical_rmse = RasterFile{path("sigma.tif"), 1};
  const Resolved r = resolve(model);
  EXPECT_NEAR(r.field.sampling.at(30, 20), 1 + 0.1 * (20.5 / 2 - 0.5), 1e-5);
}

TEST_F(ResolveErrorFiles, TerrainTypesReplaceTheVariationInside) {
  // The northern half is craggy.
  const std::string polygons = write_text("types.geojson", R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"kind": "craggy"}, "geometry": {"type": "Polygon",
     "coordinates": [[[-10, 10], [600, 10], [600, -300], [-10, -300], [-10, 10]]]}}]})");
  ErrorModel model = given(0, 1);
  model.terrain_types = TerrainTypes{polygons, "", "kind", {}};
  const Resolved number = resolve(model);
  EXPECT_FLOAT_EQ(number.field.amplitude.at(10, 10), static_cast<float>(4 / kZ95));
  EXPECT_FLOAT_EQ(number.field.amplitude.at(50, 10), static_cast<float>(1 / kZ95));

  model.geologic_variation = FromDem{};
  const Resolved learnt = resolve(model);
  EXPECT_EQ(learnt.field.profile.shape, GeologicShape::kGrowth);
  EXPECT_FLOAT_EQ(learnt.field.amplitude.at(10, 10), static_cast<float>(4 / kZ95));
  EXPECT_EQ(learnt.field.amplitude.at(50, 10), resolve(ErrorModel()).field.amplitude.at(50, 10));
}

TEST(ResolveError, MemoryIsToldBeforehand) {
  const Window w{0, 0, 100, 10};
  const std::size_t grid = w.cells() * sizeof(float);
  EXPECT_EQ(resolve_error_memory(given(1, 1), w).peak, 0u);
  EXPECT_EQ(resolve_error_memory(ErrorModel(), w).kept, grid);
  ErrorModel slopes = given(1, 1);
  slopes.horizontal_rmse = 1;
  EXPECT_EQ(resolve_error_memory(slopes, w).kept, grid);
}

}  // namespace
}  // namespace sightbound
