// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/bodies.h"
#include "support/random_dem.h"
#include "support/says.h"
#include "support/scratch.h"
#include "volume/error_volume.h"
#include "volume/tin_surface.h"

namespace sightbound {
namespace {

using testing::says;

class VolumeFile : public testing::Scratch {
 protected:
  static ErrorVolume built(const std::shared_ptr<const Surface>& surface, double voxel) {
    VolumeOptions options;
    options.voxel_m = voxel;
    options.voxel_height_m = voxel / 2;
    options.error_model = R"({"vertical_rmse": 1})";
    Progress progress;
    return ErrorVolume::build(surface, options, progress);
  }
  static std::shared_ptr<const Surface> surface_of(const Tin& tin, unsigned seed) {
    return std::make_shared<TinSurface>(tin, testing::random_error(tin, seed, 0.3, 0.9, seed % 2),
                                        Metric::kNormal);
  }
  std::string saved(const ErrorVolume& volume, const std::string& name) const {
    Progress progress;
    volume.save(path(name), progress);
    return path(name);
  }
  static ErrorVolume opened(const std::string& path) {
    Progress progress;
    return ErrorVolume::open(path, progress);
  }
  static std::string read(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  // What opening says; empty when it goes well.
  static std::string refusal(const std::string& path) {
    try {
      opened(path);
    } catch (const InvalidInput& error) {
      return std::string("InvalidInput: ") + error.what();
    } catch (const IoError& error) {
      return std::string("IoError: ") + error.what();
    }
    return {};
  }
};

void expect_same(const ErrorVolume& a, const ErrorVolume& b) {
  EXPECT_EQ(a.voxel_m(), b.voxel_m());
  EXPECT_EQ(a.voxel_height_m(), b.voxel_height_m());
  EXPECT_EQ(a.largest_ratio(), b.largest_ratio());
  EXPECT_EQ(a.tails(), b.tails());
  EXPECT_EQ(a.error_model(), b.error_model());
  EXPECT_EQ(a.report().voxels, b.report().voxels);
  EXPECT_EQ(a.report().warnings, b.report().warnings);
  const Box3& box = a.surface().bounds();
  EXPECT_EQ(box.high, b.surface().bounds().high);
  EXPECT_EQ(a.surface().sides(), b.surface().sides());
  EXPECT_EQ(a.surface().metric(), b.surface().metric());
  EXPECT_EQ(a.surface().frame().crs_wkt, b.surface().frame().crs_wkt);
  EXPECT_EQ(a.surface().frame().x, b.surface().frame().x);
  const Voxel low = a.voxel_of(box.low - Xyz{12, 12, 700}), high = a.voxel_of(box.high + Xyz{12, 12, 12});
  for (int i = low.i; i <= high.i; ++i) {
    for (int j = low.j; j <= high.j; ++j) {
      ASSERT_EQ(a.unknown_columns().at(i, j), b.unknown_columns().at(i, j));
      for (int k = low.k; k <= high.k; k += k < high.k - 200 ? 37 : 1) {
        ASSERT_EQ(a.at({i, j, k}), b.at({i, j, k})) << i << ' ' << j << ' ' << k;
        ASSERT_EQ(a.is_ambiguous({i, j, k}), b.is_ambiguous({i, j, k}));
      }
    }
  }
  ASSERT_EQ(a.surface().face_count(), b.surface().face_count());
  for (std::size_t n = 0; n < a.surface().face_count(); ++n) {
    const auto p = a.surface().face(n), q = b.surface().face(n);
    ASSERT_EQ(p.has_value(), q.has_value());
    if (!p) continue;
    EXPECT_EQ(p->corner, q->corner);
    EXPECT_EQ(p->sampling, q->sampling);
    EXPECT_EQ(p->amplitude, q->amplitude);
    EXPECT_EQ(p->to_ground, q->to_ground);
    const SurfacePlace s = place_on(*p, a.surface().profile(), p->corner[0].x + 0.3, p->corner[0].y + 0.2);
    const SurfacePlace t = place_on(*q, b.surface().profile(), p->corner[0].x + 0.3, p->corner[0].y + 0.2);
    EXPECT_EQ(s.between, t.between);
  }
}

TEST_F(VolumeFile, TailsComeBackAndNormalOnesLeaveNoTrace) {
  const auto surface = testing::random_dem(3).surface();
  VolumeOptions options;
  options.voxel_m = 1;
  for (const Tails tails : {Tails::kNormal, Tails::kLaplace, Tails::kStudent}) {
    options.tails = tails;
    Progress progress;
    const ErrorVolume volume = ErrorVolume::build(surface, options, progress);
    EXPECT_EQ(volume.largest_ratio(), certain_ratio(tails));
    EXPECT_EQ(volume.quantile(0.99), two_sided_quantile(0.99, tails));
    const std::string path = saved(volume, name_of(tails) + ".vdb");
    expect_same(volume, opened(path));
    EXPECT_EQ(read(path).find("tails") == std::string::npos, tails == Tails::kNormal);
  }
}

TEST_F(VolumeFile, ComesBackBitByBit) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const ErrorVolume dem = built(testing::random_dem(seed).surface(), 1);
    expect_same(dem, opened(saved(dem, "dem.vdb")));
    const ErrorVolume ball = built(surface_of(testing::rough_ball(seed, 20, 0.3), seed), 1.5);
    expect_same(ball, opened(saved(ball, "ball.vdb")));
    const ErrorVolume bridge = built(surface_of(testing::bridge(seed), seed), 1.5);
    expect_same(bridge, opened(saved(bridge, "bridge.vdb")));
  }
}

TEST_F(VolumeFile, SavedTwiceIsTheSameFile) {
  const ErrorVolume volume = built(testing::random_dem(3).surface(), 1);
  const std::string first = read(saved(volume, "a.vdb"));
  EXPECT_EQ(first, read(saved(volume, "b.vdb")));
  EXPECT_EQ(first, read(saved(opened(path("a.vdb")), "c.vdb")));
  EXPECT_EQ(files().size(), 3u);  // nothing half-written lies about
}

TEST_F(VolumeFile, AnyVdbToolReadsIt) {
  const std::string file = saved(built(testing::random_dem(3).surface(), 1), "a.vdb");
  ASSERT_EQ(std::system(("vdb_print -l -m '" + file + "' > '" + path("told") + "' 2>&1").c_str()), 0);
  const std::string told = read(path("told"));
  for (const char* part : {"k_low", "k_high", "Tree_float_5_4_3", "is_saved_as_half_float: true"})
    EXPECT_TRUE(says(told, part));
}

TEST_F(VolumeFile, DamageIsToldAndNeverCrashes) {
  const std::string whole = read(saved(built(testing::random_dem(5).surface(), 2), "whole.vdb"));
  std::mt19937 random(1);
  for (int n = 0; n < 60; ++n) {
    std::string bytes = whole;
    if (n % 2 == 0) {
      bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
    } else {
      bytes.resize(random() % bytes.size());
    }
    EXPECT_FALSE(refusal(write_text("damaged.vdb", bytes)).empty()) << n;
  }
}

TEST_F(VolumeFile, WhatIsNoErrorVolumeIsRefused) {
  EXPECT_TRUE(says(refusal(path("missing.vdb")), "IoError"));
  EXPECT_TRUE(says(refusal(write_text("empty.vdb", "")), "InvalidInput"));
  EXPECT_TRUE(says(refusal(write_text("text.vdb", "this is no volume")), "is not an error volume"));
}

TEST_F(VolumeFile, FailedSaveKeepsWhatStoodThere) {
  const ErrorVolume volume = built(testing::random_dem(3).surface(), 2);
  Progress progress;
  EXPECT_THROW(volume.save(path("no_such_folder/a.vdb"), progress), IoError);
  write_text("kept.vdb", "old");
  Progress cancelled([](double) { return false; });
  EXPECT_THROW(volume.save(path("kept.vdb"), cancelled), Cancelled);
  EXPECT_EQ(read(path("kept.vdb")), "old");
}

}  // namespace
}  // namespace sightbound
