// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/error_rasters.h"
#include "support/says.h"
#include "support/scratch.h"

namespace sightbound {
namespace {

using Table = std::map<std::string, double>;
using testing::says;

class TerrainTableTest : public testing::Scratch {
 protected:
  Table read(const std::string& text) { return read_terrain_table(write_text("table.txt", text)); }

  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(TerrainTableTest, Json) {
  EXPECT_EQ(read(R"({"grass": 0.5, "crag": 4})"), (Table{{"grass", 0.5}, {"crag", 4}}));
}

TEST_F(TerrainTableTest, Csv) {
  const Table expected{{"grass", 0.5}, {"crag, high", 4}};
  EXPECT_EQ(read("grass,0.5\n\"crag, high\",4\n"), expected);
  EXPECT_EQ(read("class,metres\r\ngrass,0.5\r\n\"crag, high\",4\r\n"), expected);
  EXPECT_EQ(read("\xEF\xBB\xBF"
                 "Klasse;Meter\ngrass;0,5\ncrag, high;4"),
            expected);
  EXPECT_EQ(read("grass\t0.5\n\ncrag, high\t4\n"), expected);
}

TEST_F(TerrainTableTest, Refusals) {
  EXPECT_TRUE(says(refusal(""), "is empty"));
  EXPECT_TRUE(says(refusal("class,metres\n"), "is empty"));
  EXPECT_TRUE(says(refusal("{}"), "is empty"));
  EXPECT_TRUE(says(refusal("grass,0.5\ncrag,much\n"), "line 2"));
  EXPECT_TRUE(says(refusal("grass,-1\n"), "0 or more metres"));
  EXPECT_TRUE(says(refusal("grass,1\ngrass,2\n"), "twice"));
  EXPECT_TRUE(says(refusal(R"({"grass": "high"})"), "not a number"));
  EXPECT_TRUE(says(refusal(R"({"grass": )"), "JSON object"));
  EXPECT_TRUE(says(refusal("[1, 2]"), "JSON object"));
  EXPECT_THROW(read_terrain_table(path("missing.csv")), IoError);
  EXPECT_THROW(read_terrain_table(path("")), IoError);
}

}  // namespace
}  // namespace sightbound
