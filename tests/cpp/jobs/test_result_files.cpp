// SPDX-License-Identifier: GPL-3.0-or-later
// What the files say and hold as a whole is tested in tests/python/test_bindings_files.py.
#include <gtest/gtest.h>

#include "base/error.h"
#include "jobs/option_names.h"
#include "jobs/result_files.h"
#include "support/says.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using testing::says;

class ResultFiles : public testing::Scratch {
 protected:
  ResultFiles() {
    result_.confidence = Grid<float>(2, 3, 0.5f);
    result_.verdict = Grid<std::uint8_t>(2, 3, kVisible);
    result_.geotransform = Geotransform({0, 10, 0, 0, 0, -10});
  }
  void write() {
    Progress progress;
    write_viewshed(result_, {Observer{}}, options_, files_, progress);
  }
  template <class Refusal>
  std::string refusal() {
    try {
      write();
    } catch (const Refusal& error) {
      return error.what();
    }
    return "";
  }

  ViewshedResult result_;
  ViewshedOptions options_;
  ViewshedFiles files_;
};

TEST_F(ResultFiles, AreWrittenWhereAPathIsGiven) {
  files_.confidence = path("c.tif");
  files_.count = path("n.tif");
  write();
  EXPECT_EQ(files(), (std::vector<std::string>{"c.tif", "n.tif"}));
}

TEST_F(ResultFiles, AreRefusedWhenNoneIsWanted) { EXPECT_TRUE(says(refusal<InvalidInput>(), "nothing")); }

TEST_F(ResultFiles, AreAllWrittenOrNone) {
  files_.confidence = path("c.tif");
  files_.verdict = path("nowhere/v.tif");
  EXPECT_TRUE(says(refusal<IoError>(), "nowhere"));
  EXPECT_TRUE(files().empty());
}

TEST_F(ResultFiles, NeedHeightsThatWereComputed) {
  files_.lowest_visible_height = path("h.tif");
  EXPECT_TRUE(says(refusal<InvalidInput>(), "heights=True"));
}

TEST(CountOf, OneObserver) {
  Grid<std::uint8_t> verdict(1, 4);
  verdict.at(0, 0) = kHidden;
  verdict.at(0, 1) = kUncertain;
  verdict.at(0, 2) = kVisible;
  verdict.at(0, 3) = kNoVerdict;
  const Grid<std::uint32_t> count = count_of(verdict);
  EXPECT_EQ(std::vector<std::uint32_t>(count.values().begin(), count.values().end()),
            (std::vector<std::uint32_t>{0, 0, 1, kNoCount}));
}

TEST(OptionNames, ComeBack) {
  for (const Stand one : {Stand::kModel, Stand::kGround}) EXPECT_EQ(stand_from(name_of(one)), one);
  for (const Combine one : {Combine::kBest, Combine::kWorst}) EXPECT_EQ(combine_from(name_of(one)), one);
  for (const HeightReference one : {HeightReference::kGround, HeightReference::kAbsolute}) {
    EXPECT_EQ(height_reference_from(name_of(one)), one);
  }
}

TEST(OptionNames, ThatAreUnknownAreRefusedWithThoseAllowed) {
  try {
    stand_from("air");
    FAIL() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_TRUE(says(error.what(), "stand is 'air'; allowed are 'model' and 'ground'"));
  }
}

}  // namespace
}  // namespace sightbound
