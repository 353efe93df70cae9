// SPDX-License-Identifier: GPL-3.0-or-later
// Hidden volumes against counts over plain maps of the same answers.
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/hidden_volumes.h"
#include "support/says.h"

namespace sightbound {
namespace {

using testing::Answers;
using testing::complaint;
using testing::random_answers;
using testing::random_lattice;
using testing::says;
using testing::volume_of;

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

}  // namespace
}  // namespace sightbound
