// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters and the top against plain maps of the same answers.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/hidden_volumes.h"
#include "support/says.h"
#include "terrain/tin_height_field.h"
#include "volume/hidden_places.h"

namespace sightbound {
namespace {

using testing::Answers;
using testing::complaint;
using testing::random_answers;
using testing::random_lattice;
using testing::says;
using testing::volume_of;

TEST(HiddenPlaces, Rasters) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto lattice = random_lattice(seed);
    const Answers answers = random_answers(*lattice, seed);
    const HiddenRasters rasters = rasters_of(volume_of(lattice, answers));
    for (int j = 0; j < lattice->ny; ++j) {
      for (int i = 0; i < lattice->nx; ++i) {
        const TargetColumn& column = lattice->column(i, j);
        int asked = 0, not_visible = 0, core = 0, lowest = 1000;
        for (int k = column.last; k >= column.first; --k) {  // downwards
          const auto found = answers.find({i, j, k});
          if (found == answers.end()) continue;
          ++asked;
          if (found->second.verdict != kVisible) ++not_visible;
          if (found->second.verdict == kHidden) ++core;
          if (not_visible == 0) lowest = k;
        }
        const int row = lattice->ny - 1 - j;
        const float thickness = rasters.thickness.at(row, i),
                    height = rasters.lowest_visible_height.at(row, i);
        ASSERT_EQ(std::isnan(thickness), asked == 0);
        ASSERT_EQ(std::isnan(height), lowest == 1000);
        if (asked > 0) {
          ASSERT_EQ(thickness, 4.0f * static_cast<float>(not_visible));
          ASSERT_EQ(rasters.core_thickness.at(row, i), 4.0f * static_cast<float>(core));
        }
        if (lowest < 1000) {
          ASSERT_NEAR(height, -8 + 4 * (lowest + 0.5) - static_cast<double>(column.ground), 1e-4);
        }
      }
    }
  }
}

TEST(HiddenPlaces, TopCoversTheHiddenColumns) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto lattice = random_lattice(seed);
    const Answers answers = random_answers(*lattice, seed);
    const HiddenVolume volume = volume_of(lattice, answers);
    std::set<std::array<int, 2>> hidden;
    double highest = -1e9;
    for (const auto& [key, answer] : answers) {
      if (answer.verdict == kVisible) continue;
      hidden.insert({key[0], key[1]});
      highest = std::max(highest, -8 + 4.0 * (key[2] + 1));
    }
    if (hidden.empty()) {
      EXPECT_TRUE(says(complaint<InvalidInput>([&] { top_of(volume); }), "no top"));
      continue;
    }
    const Tin top = top_of(volume);
    EXPECT_EQ(top.faces.size(), 2 * hidden.size());
    EXPECT_TRUE(is_height_field(top));
    double area = 0;
    for (const Face& face : top.faces) area += normal_of(top, face).z / 2;
    EXPECT_NEAR(area, 100.0 * static_cast<double>(hidden.size()), 1e-3);
    ASSERT_EQ(top.vertex_attributes.size(), 2u);
    for (std::size_t v = 0; v < top.vertices.size(); ++v) {
      EXPECT_LE(top.to_crs(top.vertices[v]).z, highest + 1e-9);
      EXPECT_GE(top.vertex_attributes[0].values[v], 0);
      EXPECT_GE(top.vertex_attributes[1].values[v], 4);
    }
  }
}

}  // namespace
}  // namespace sightbound
