// SPDX-License-Identifier: GPL-3.0-or-later
// Hidden volumes against counts over plain arrays of the same answers.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/random_dem.h"
#include "support/says.h"
#include "support/scratch.h"
#include "terrain/tin_height_field.h"
#include "volume/hidden_places.h"

namespace sightbound {
namespace {

using testing::random_dem;
using testing::RandomDem;
using testing::says;

// What f() complains about.
template <class E, class F>
std::string complaint(F f) {
  try {
    f();
  } catch (const E& error) {
    return error.what();
  } catch (const std::exception& error) {
    return std::string("another kind of error: ") + error.what();
  }
  return "no error";
}

using Key = std::array<int, 3>;
using Answers = std::map<Key, TargetAnswer>;  // of targets with a verdict

// p that halves hold.
float exact_p(std::mt19937& random) {
  return static_cast<float>(std::uniform_int_distribution<int>(0, 512)(random)) / 512;
}

std::shared_ptr<TargetLattice> random_lattice(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  auto lattice = std::make_shared<TargetLattice>();
  lattice->frame = {500000.25, 5e6, seed % 2 ? 0.3048 : 1.0, ""};
  lattice->corner = {20, -40, -8};
  lattice->spacing_m = 10;
  lattice->height_spacing_m = 4;
  lattice->ceiling_m = 30;
  lattice->nx = seed == 0 ? 141 : 1 + static_cast<int>(unit(random) * 20);
  lattice->ny = seed == 1 ? 131 : 1 + static_cast<int>(unit(random) * 20);
  for (int n = 0; n < lattice->nx * lattice->ny; ++n) {
    TargetColumn column;
    if (unit(random) < 0.1) {
      column.ground = std::numeric_limits<float>::quiet_NaN();
    } else {
      column.ground = static_cast<float>(200 * unit(random) - 100);
      column.first = static_cast<int>(std::ceil((static_cast<double>(column.ground) + 8) / 4 - 0.5));
      column.last = column.first + static_cast<int>(9 * unit(random)) - 1;
    }
    lattice->columns.push_back(column);
  }
  return lattice;
}

// Answers with uniform parts, holes and runs; `seed` differs from the lattice's.
Answers random_answers(const TargetLattice& lattice, unsigned seed) {
  std::mt19937 random(seed + 1000);
  std::uniform_real_distribution<double> unit(0, 1);
  Answers answers;
  for (int j = 0; j < lattice.ny; ++j) {
    for (int i = 0; i < lattice.nx; ++i) {
      const TargetColumn& column = lattice.column(i, j);
      const bool plain = unit(random) < 0.6;
      for (int k = column.first; k <= column.last; ++k) {
        if (unit(random) < 0.05) continue;
        const auto verdict =
            static_cast<std::uint8_t>(plain ? (k > column.first + 2 ? kVisible : kHidden)
                                            : std::uniform_int_distribution<int>(0, 2)(random));
        answers[{i, j, k}] = {plain ? verdict / 2.0f : exact_p(random), verdict};
      }
    }
  }
  return answers;
}

HiddenVolume volume_of(const std::shared_ptr<const TargetLattice>& lattice, const Answers& answers,
                       int threads = 1) {
  HiddenVolumeBuilder builder(lattice);
  const Workers workers(threads);
  workers.for_each(lattice->columns.size(), [&](std::size_t n) {
    const int i = static_cast<int>(n) % lattice->nx, j = static_cast<int>(n) / lattice->nx;
    const TargetColumn& column = lattice->column(i, j);
    std::vector<TargetAnswer> given(static_cast<std::size_t>(column.size()));
    for (int k = column.first; k <= column.last; ++k) {
      const auto found = answers.find({i, j, k});
      if (found != answers.end()) given[static_cast<std::size_t>(k - column.first)] = found->second;
    }
    builder.set_column(i, j, given);
  });
  HiddenVolumeInfo info;
  info.observers = {R"({"point": [1, 2, 3]})"};
  info.error_model = R"({"vertical_rmse": 1})";
  return builder.finish(info, workers);
}

void expect_answers(const HiddenVolume& volume, const Answers& answers, unsigned seed) {
  const TargetLattice& lattice = volume.lattice();
  for (int j = 0; j < lattice.ny; ++j) {
    for (int i = 0; i < lattice.nx; ++i) {
      const TargetColumn& column = lattice.column(i, j);
      for (int k = column.first - 2; k <= column.last + 2; ++k) {
        const auto found = answers.find({i, j, k});
        ASSERT_EQ(volume.at(i, j, k), found == answers.end() ? TargetAnswer{} : found->second)
            << "seed " << seed << " target " << i << ' ' << j << ' ' << k;
      }
    }
  }
}

TEST(HiddenVolume, GivesBackWhatWasPut) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    const auto lattice = random_lattice(seed);
    const Answers answers = random_answers(*lattice, seed);
    const HiddenVolume volume = volume_of(lattice, answers), again = volume_of(lattice, answers, 4);
    expect_answers(volume, answers, seed);
    EXPECT_TRUE(volume == again);
    VerdictVolumes expected;
    for (const auto& [key, answer] : answers) {
      (answer.verdict == kHidden      ? expected.hidden_m3
       : answer.verdict == kUncertain ? expected.uncertain_m3
                                      : expected.visible_m3) += 10 * 10 * 4;
    }
    const VerdictVolumes found = volume.volumes();
    EXPECT_DOUBLE_EQ(found.hidden_m3, expected.hidden_m3);
    EXPECT_DOUBLE_EQ(found.uncertain_m3, expected.uncertain_m3);
    EXPECT_DOUBLE_EQ(found.visible_m3, expected.visible_m3);
  }
}

TEST(HiddenVolume, DiffersWhenOneTargetDoes) {
  const auto lattice = random_lattice(3);
  Answers answers = random_answers(*lattice, 3);
  const HiddenVolume before = volume_of(lattice, answers);
  auto& first = answers.begin()->second;
  first.p = first.p > 0.5f ? 0.25f : 0.75f;
  EXPECT_FALSE(before == volume_of(lattice, answers));
}

TEST(HiddenVolume, PIsRoundedTowardsOneHalf) {
  auto lattice = random_lattice(5);
  lattice->columns[0] = {0, 0, 7};
  const std::array<float, 8> given{0, 1e-7f, 0.1f, 0.5f, 0.9f, 0.99999f, 1, 0.3333f};
  Answers answers;
  for (int k = 0; k < 8; ++k) answers[{0, 0, k}] = {given[static_cast<std::size_t>(k)], kUncertain};
  const HiddenVolume volume = volume_of(lattice, answers);
  for (int k = 0; k < 8; ++k) {
    const float p = given[static_cast<std::size_t>(k)], kept = volume.at(0, 0, k).p;
    EXPECT_LE(std::abs(kept - 0.5f), std::abs(p - 0.5f));
    EXPECT_NEAR(kept, p, 1.0 / 1024);
    EXPECT_EQ(kept == p, p == 0 || p == 0.5f || p == 1);
  }
}

// Nothing but air that is seen: tiles, not voxels.
TEST(HiddenVolume, UniformPartsCostNothing) {
  auto lattice = std::make_shared<TargetLattice>();
  lattice->spacing_m = lattice->height_spacing_m = 1;
  lattice->ceiling_m = 128;
  lattice->nx = lattice->ny = 128;
  lattice->columns.assign(128 * 128, {0, 0, 127});
  HiddenVolumeBuilder builder(lattice);
  const std::vector<TargetAnswer> seen(128, {1, kVisible});
  for (int j = 0; j < 128; ++j) {
    for (int i = 0; i < 128; ++i) builder.set_column(i, j, seen);
  }
  const HiddenVolume volume = builder.finish({}, Workers(1));
  EXPECT_LT(volume.bytes(), 1000000u);  // 2 097 152 targets
  EXPECT_EQ(volume.volumes().visible_m3, 128.0 * 128 * 128);
}

TEST(HiddenVolume, SetOperationsTargetByTarget) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const auto lattice = random_lattice(seed);
    const Answers a = random_answers(*lattice, seed), b = random_answers(*lattice, seed + 500);
    const HiddenVolume va = volume_of(lattice, a), vb = volume_of(lattice, b);
    Answers in_union, in_both, gained;
    for (const auto& [key, answer] : a) {
      const auto other = b.find(key);
      if (other == b.end()) {
        in_union[key] = answer;
        continue;
      }
      const TargetAnswer& q = other->second;
      in_union[key] = {answer.p > q.p ? answer.p : q.p,
                       answer.verdict > q.verdict ? answer.verdict : q.verdict};
      in_both[key] = {answer.p < q.p ? answer.p : q.p,
                      answer.verdict < q.verdict ? answer.verdict : q.verdict};
      gained[key] = answer.verdict == kVisible ? TargetAnswer{0, kHidden} : q;
    }
    for (const auto& [key, answer] : b) in_union.emplace(key, answer);
    const HiddenVolume all = union_of_seen(va, vb);
    expect_answers(all, in_union, seed);
    expect_answers(intersection_of_seen(va, vb), in_both, seed);
    expect_answers(difference_of_seen(va, vb), gained, seed);
    EXPECT_TRUE(union_of_seen(vb, va) == all);
    EXPECT_TRUE(union_of_seen(va, va) == va);
    EXPECT_EQ(all.info().observers.size(), 2u);
    EXPECT_EQ(all.info().operations, std::vector<std::string>{"union of seen"});
  }
}

TEST(HiddenVolume, OnlyTheSameTargetsAndConfidenceGoTogether) {
  const auto lattice = random_lattice(4);
  auto other = std::make_shared<TargetLattice>(*lattice);
  other->columns.back().first += 1;
  const HiddenVolume a = volume_of(lattice, {}), b = volume_of(other, {});
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { union_of_seen(a, b); }), "different targets"));
  HiddenVolume c = volume_of(lattice, {});
  c.info().confidence = 0.9;
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { union_of_seen(a, c); }), "different confidences"));
}

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

// Every centre above ground and up to the ceiling is asked, and no other.
TEST(TargetLattice, AboveTheGroundOfADem) {
  Progress progress;
  std::size_t none = 0, some = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const RandomDem dem = random_dem(seed);
    const LatticeOptions options{3.7, seed % 2 ? 0.0 : 1.3, 9};
    const auto lattice = lattice_above(*dem.surface(), options, Workers(2), progress);
    EXPECT_EQ(lattice->height_spacing_m, seed % 2 ? 2.25 : 1.3);
    for (int j = 0; j < lattice->ny; ++j) {
      for (int i = 0; i < lattice->nx; ++i) {
        const Xyz centre = lattice->centre(i, j, 0);
        const double ground = dem.place(centre.x, centre.y).height;
        const TargetColumn& column = lattice->column(i, j);
        ASSERT_EQ(std::isnan(ground), std::isnan(column.ground));
        if (std::isnan(ground)) {
          EXPECT_EQ(column.size(), 0);
          ++none;
          continue;
        }
        ++some;
        ASSERT_NEAR(column.ground, ground, 1e-4);
        EXPECT_GE(lattice->height_of(column.first), ground - 1e-6);
        EXPECT_LT(lattice->height_of(column.first - 1), ground + 1e-6);
        EXPECT_LE(lattice->height_of(column.last), ground + 9 + 1e-6);
        EXPECT_GT(lattice->height_of(column.last + 1), ground + 9 - 1e-6);
      }
    }
  }
  EXPECT_GT(none, 100u);
  EXPECT_GT(some, 1000u);
}

TEST(TargetLattice, RefusesNonsense) {
  Progress progress;
  const auto surface = random_dem(1).surface();
  const auto made = [&](LatticeOptions options) { lattice_above(*surface, options, Workers(1), progress); };
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made({0, 0, 20}); }), "target_spacing is 0"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made({10, 0, -1}); }), "target_ceiling is -1"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made({10, 30, 20}); }), "at most the ceiling"));
  EXPECT_TRUE(says(complaint<InvalidInput>([&] { made({std::nan(""), 0, 20}); }), "target_spacing"));
}

}  // namespace
}  // namespace sightbound
