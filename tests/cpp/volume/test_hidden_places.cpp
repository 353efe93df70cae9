// SPDX-License-Identifier: GPL-3.0-or-later
// Areas and places against counts over plain maps of the same answers.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/hidden_volumes.h"
#include "support/says.h"
#include "volume/hidden_places.h"

namespace sightbound {
namespace {

using testing::Answers;
using testing::complaint;
using testing::random_answers;
using testing::random_lattice;
using testing::says;
using testing::volume_of;

// A target's columns up to `height`, by the definition.
struct Expected {
  std::set<std::array<int, 2>> asked, hides, surely;
};
Expected columns_for(const TargetLattice& lattice, const Answers& answers, double height) {
  Expected out;
  for (int j = 0; j < lattice.ny; ++j) {
    for (int i = 0; i < lattice.nx; ++i) {
      const TargetColumn& column = lattice.column(i, j);
      int asked = 0, visible = 0, core = 0;
      for (int k = column.first; k <= column.last; ++k) {
        const auto found = answers.find({i, j, k});
        if (found == answers.end()) continue;
        const double lower = lattice.corner.z + k * lattice.height_spacing_m;
        const bool reached = k == column.first || lower < static_cast<double>(column.ground) + height;
        if (!reached && asked > 0) continue;
        ++asked;
        visible += found->second.verdict == kVisible;
        core += found->second.verdict == kHidden;
      }
      if (asked > 0) out.asked.insert({i, j});
      if (asked > 0 && visible == 0) out.hides.insert({i, j});
      if (asked > 0 && core == asked) out.surely.insert({i, j});
    }
  }
  return out;
}

TEST(HiddenPlaces, AreaForAHeight) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto lattice = random_lattice(seed);
    const Answers answers = random_answers(*lattice, seed);
    const HiddenVolume volume = volume_of(lattice, answers);
    for (const double height : {0.5, 2.0, 7.3, 30.0}) {
      const Expected expected = columns_for(*lattice, answers, height);
      const HiddenArea area = hidden_area(volume, height);
      EXPECT_EQ(area.asked_m2, 100.0 * static_cast<double>(expected.asked.size()));
      EXPECT_EQ(area.hidden_m2, 100.0 * static_cast<double>(expected.hides.size()));
      EXPECT_EQ(area.core_m2, 100.0 * static_cast<double>(expected.surely.size()));
    }
  }
  const HiddenVolume volume = volume_of(random_lattice(1), {});
  for (const double height : {0.0, -1.0, 30.1, std::nan("")}) {
    const auto asked = [&] { hidden_area(volume, height); };
    EXPECT_TRUE(says(complaint<InvalidInput>(asked), "ceiling"));
  }
}

TEST(HiddenPlaces, ConnectedColumns) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto lattice = random_lattice(seed);
    const Answers answers = random_answers(*lattice, seed);
    for (const Hiding hiding : {Hiding::kNotVisible, Hiding::kSurelyHidden}) {
      const Expected expected = columns_for(*lattice, answers, 5);
      std::set<std::array<int, 2>> left = hiding == Hiding::kNotVisible ? expected.hides : expected.surely;
      std::multiset<std::pair<double, double>> wanted;  // area, volume
      while (!left.empty()) {
        double area = 0, layers = 0;
        const std::function<void(std::array<int, 2>)> take = [&](std::array<int, 2> at) {
          if (left.erase(at) == 0) return;
          area += 100;
          for (int k = -100; k < 100; ++k) {
            const auto found = answers.find({at[0], at[1], k});
            if (found == answers.end()) continue;
            layers += hiding == Hiding::kNotVisible ? found->second.verdict != kVisible
                                                    : found->second.verdict == kHidden;
          }
          take({at[0] + 1, at[1]});
          take({at[0] - 1, at[1]});
          take({at[0], at[1] + 1});
          take({at[0], at[1] - 1});
        };
        take(*left.begin());
        wanted.insert({area, 400 * layers});
      }
      const auto places = hidden_places(volume_of(lattice, answers), 5, hiding, 100000);
      std::multiset<std::pair<double, double>> found;
      for (std::size_t n = 0; n < places.size(); ++n) {
        found.insert({places[n].area_m2, places[n].volume_m3});
        if (n > 0) {
          EXPECT_GE(places[n - 1].area_m2, places[n].area_m2);
        }
      }
      EXPECT_EQ(found, wanted);
      EXPECT_EQ(hidden_places(volume_of(lattice, answers), 5, hiding, 2).size(),
                std::min<std::size_t>(2, wanted.size()));
    }
  }
}

// Two places known by hand: an L of three columns and a single one, deep.
TEST(HiddenPlaces, WhereTheyAre) {
  auto lattice = std::make_shared<TargetLattice>();
  lattice->frame = {1000, 2000, 0.5, ""};
  lattice->corner = {100, 200, 0};
  lattice->spacing_m = 10;
  lattice->height_spacing_m = 2;
  lattice->ceiling_m = 8;
  lattice->nx = lattice->ny = 4;
  lattice->columns.assign(16, {0, 0, 3});
  Answers answers;
  const std::map<std::array<int, 2>, int> hidden_layers{{{0, 0}, 1}, {{1, 0}, 2}, {{0, 1}, 1}, {{3, 3}, 4}};
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const auto found = hidden_layers.find({i, j});
      const int layers = found == hidden_layers.end() ? 0 : found->second;
      for (int k = 0; k < 4; ++k)
        answers[{i, j, k}] = k < layers ? TargetAnswer{0, kHidden} : TargetAnswer{1, kVisible};
    }
  }
  const HiddenVolume volume = volume_of(lattice, answers);
  const auto places = hidden_places(volume, 1.8, Hiding::kNotVisible, 10);
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].area_m2, 300);
  EXPECT_EQ(places[0].volume_m3, 4 * 200);
  EXPECT_DOUBLE_EQ(places[0].centroid_x, 1000 + (100 + 10 * (0.5 + 1.5 + 0.5) / 3) / 0.5);
  EXPECT_DOUBLE_EQ(places[0].centroid_y, 2000 + (200 + 10 * (0.5 + 0.5 + 1.5) / 3) / 0.5);
  EXPECT_DOUBLE_EQ(places[0].deepest_x, 1000 + 115 / 0.5);
  EXPECT_EQ(places[0].depth_m, 4);
  EXPECT_EQ(places[1].depth_m, 8);
  EXPECT_EQ(places[1].volume_m3, 4 * 200);

  // A thing of 2.1 m reaches into the second layer.
  EXPECT_EQ(hidden_area(volume, 2.1).hidden_m2, 200);
  const HiddenRasters rasters = rasters_of(volume);
  EXPECT_EQ(rasters.thickness.at(3, 1), 4);  // row 3 is the southernmost
  EXPECT_EQ(rasters.lowest_visible_height.at(3, 1), 5);
  EXPECT_TRUE(std::isnan(rasters.lowest_visible_height.at(0, 3)));
  const Xy where = geotransform_of(*lattice).of_sample(1, 3);
  EXPECT_DOUBLE_EQ(where.x, 1000 + 115 / 0.5);
  EXPECT_DOUBLE_EQ(where.y, 2000 + 205 / 0.5);
}

}  // namespace
}  // namespace sightbound
