// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/hidden_volumes.h"
#include "support/says.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using testing::complaint;
using testing::random_answers;
using testing::random_lattice;
using testing::says;
using testing::volume_of;

class HiddenVolumeFile : public testing::Scratch {
 protected:
  std::string path_ = path("hidden.vdb");
  Progress progress_;
};

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(HiddenVolumeFile, OpensAsItWasSaved) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const auto lattice = random_lattice(seed);
    const HiddenVolume volume = volume_of(lattice, random_answers(*lattice, seed));
    volume.save(path_, progress_);
    const std::string once = bytes_of(path_);
    const HiddenVolume opened = HiddenVolume::open(path_, progress_);
    EXPECT_TRUE(opened == volume);
    EXPECT_EQ(opened.info().observers, volume.info().observers);
    EXPECT_EQ(opened.info().error_model, volume.info().error_model);
    EXPECT_TRUE(opened.info().made_by.starts_with("Sightbound "));
    opened.save(path_, progress_);
    EXPECT_EQ(bytes_of(path_), once);
  }
  EXPECT_EQ(files(), std::vector<std::string>{"hidden.vdb"});
}

TEST_F(HiddenVolumeFile, DamageIsSeen) {
  const auto lattice = random_lattice(2);
  volume_of(lattice, random_answers(*lattice, 2)).save(path_, progress_);
  const std::string whole = bytes_of(path_);
  const auto opens = [&](std::string bytes) {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
    HiddenVolume::open(path_, progress_);
  };
  std::mt19937 random(1);
  for (int n = 0; n < 200; ++n) {
    std::string bytes = whole;
    std::size_t at = std::uniform_int_distribution<std::size_t>(4, whole.size() - 25)(random);
    if (at >= 21 && at < 57) continue;  // the identifier says nothing of the content
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << n % 8));
    EXPECT_TRUE(says(complaint<IoError>([&] { opens(bytes); }), "damaged")) << at;
  }
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{30}, std::size_t{4}}) {
    EXPECT_TRUE(says(complaint<InvalidInput>([&] { opens(whole.substr(0, size)); }), "end is missing"))
        << size;
  }
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { opens(""); }), "no .vdb file"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { opens("ply\nformat"); }), "no .vdb file"));
  EXPECT_TRUE(
      says(complaint<IoError>([&] { HiddenVolume::open(path("none.vdb"), progress_); }), "cannot be opened"));
  const auto open_none = [&] { HiddenVolume::open(path("none.vdb"), progress_); };
  EXPECT_TRUE(says(complaint<IoError>(open_none), "cannot be opened"));
  const auto save_nowhere = [&] { volume_of(lattice, {}).save(path("no/folder.vdb"), progress_); };
  EXPECT_TRUE(says(complaint<IoError>(save_nowhere), "does not exist"));
}

}  // namespace
}  // namespace sightbound
