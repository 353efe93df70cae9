// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers in the rasters are tested in cpp/volume/test_hidden_rasters.cpp.
#include <string>

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "io/tin_reader.h"
#include "jobs/hidden_files.h"
#include "support/hidden_volumes.h"
#include "support/says.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using testing::complaint;
using testing::says;

// 3 x 2 columns of four targets 5 m apart, 2 m high, on level ground at 10 m.
HiddenVolume hidden_volume(std::uint8_t verdict) {
  auto lattice = std::make_shared<TargetLattice>();
  lattice->frame = {1000, 2000, 1, ""};
  lattice->spacing_m = 5;
  lattice->height_spacing_m = 2;
  lattice->ceiling_m = 8;
  lattice->nx = 3;
  lattice->ny = 2;
  lattice->columns.assign(6, {10, 5, 8});
  testing::Answers answers;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 2; ++j) {
      for (int k = 5; k <= 8; ++k)
        answers[{i, j, k}] = {static_cast<float>(verdict) / 2, k < 7 ? verdict : std::uint8_t{kVisible}};
    }
  }
  return testing::volume_of(lattice, answers);
}

class HiddenFilesTest : public testing::Scratch {
 protected:
  std::vector<std::string> write() {
    Progress progress;
    return write_hidden(hidden_, files_, 1, progress);
  }
  GDALDatasetUniquePtr open(const std::string& name) const {
    return GDALDatasetUniquePtr(GDALDataset::Open(path(name).c_str()));
  }

  HiddenVolume hidden_ = hidden_volume(kHidden);
  HiddenFiles files_;
};

TEST_F(HiddenFilesTest, AreWrittenWhereAPathIsGiven) {
  files_.thickness = path("t.tif");
  files_.top = path("top.ply");
  EXPECT_TRUE(write().empty());
  EXPECT_EQ(files(), (std::vector<std::string>{"t.tif", "top.ply"}));
}

TEST_F(HiddenFilesTest, SayWhatTheyHold) {
  files_.lowest_visible_height = path("h.tif");
  files_.thickness = path("t.tif");
  files_.core_thickness = path("c.tif");
  hidden_.info().confidence = 0.9;
  hidden_.info().observers = {"{\"a\":1}", "{\"b\":2}"};
  write();
  const auto height = open("h.tif"), core = open("c.tif");
  ASSERT_TRUE(height && core);
  const auto item = [](const auto& file, const char* name) {
    const char* value = file->GetMetadataItem(name);
    return std::string(value == nullptr ? "" : value);
  };
  EXPECT_TRUE(says(item(height, "SIGHTBOUND_QUANTITY"), "lowest height"));
  EXPECT_TRUE(says(item(core, "SIGHTBOUND_QUANTITY"), "surely hidden core"));
  EXPECT_EQ(item(height, "SIGHTBOUND_CONFIDENCE"), "0.9");
  EXPECT_EQ(item(height, "SIGHTBOUND_OBSERVERS"), "{\"a\":1}\n{\"b\":2}");
  EXPECT_EQ(item(height, "SIGHTBOUND_TARGET_SPACING"), "5");
  EXPECT_EQ(item(height, "SIGHTBOUND_TARGET_HEIGHT_SPACING"), "2");
  EXPECT_EQ(item(height, "SIGHTBOUND_TARGET_CEILING"), "8");
  EXPECT_TRUE(says(item(height, "SIGHTBOUND_ERROR_MODEL"), "vertical_rmse"));
  std::array<double, 6> at{};
  ASSERT_EQ(height->GetGeoTransform(at.data()), CE_None);
  EXPECT_EQ(at, (std::array<double, 6>{1000, 5, 0, 2010, 0, -5}));
  float thickness = 0;
  ASSERT_EQ(core->GetRasterBand(1)->RasterIO(GF_Read, 2, 1, 1, 1, &thickness, 1, 1, GDT_Float32, 0, 0),
            CE_None);
  EXPECT_EQ(thickness, 4);  // two of the four targets
}

TEST_F(HiddenFilesTest, TheTopIsAMeshOfTheHiddenColumns) {
  files_.top = path("top.ply");
  write();
  Progress progress;
  const Tin top = read_tin(files_.top, {}, progress);
  EXPECT_EQ(top.faces.size(), 12u);
  for (const Xyz& v : top.vertices) EXPECT_NEAR(top.to_crs(v).z, 14, 1e-6);
}

TEST_F(HiddenFilesTest, NothingHiddenHasNoTop) {
  hidden_ = hidden_volume(kVisible);
  files_.top = path("top.ply");
  files_.thickness = path("t.tif");
  const std::vector<std::string> warnings = write();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(says(warnings[0], "top.ply' was not written"));
  EXPECT_EQ(files(), std::vector<std::string>{"t.tif"});
}

TEST_F(HiddenFilesTest, AreAllRefusedOrWritten) {
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { write(); }), "nothing to write"));
  files_.thickness = path("t.tif");
  files_.core_thickness = path("nowhere/c.tif");
  EXPECT_TRUE(says(complaint<IoError>([&] { write(); }), "nowhere"));
  files_.core_thickness = files_.thickness;
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { write(); }), "t.tif"));
  files_.core_thickness.clear();
  files_.creation_options = {"COMPRESS"};
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { write(); }), "COMPRESS"));
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace sightbound
