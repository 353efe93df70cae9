// SPDX-License-Identifier: GPL-3.0-or-later
// Coarse to fine against line by line, and what is said of whole cells and targets against the other engine.
#include <algorithm>
#include <deque>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "sight/volume_viewshed.h"
#include "support/rolling_ground.h"

namespace sightbound {
namespace {

using testing::kBent;
using testing::Lines;
using testing::RandomDem;
using testing::rolling_dem;
using testing::volume_of;

struct Ground {
  RandomDem dem;
  std::shared_ptr<const DemSurface> surface;
  ErrorVolume volume;
  VolumeRays rays;
  VolumeSight sight;
  Workers workers{2};
  std::shared_ptr<const TargetLattice> targets;

  explicit Ground(unsigned seed)
      : dem(rolling_dem(seed)),
        surface(dem.surface()),
        volume(volume_of(surface, 1, 0.5)),
        rays(volume),
        sight(rays, kBent) {
    Progress progress;
    LatticeOptions options;
    options.spacing_m = 7;
    options.height_spacing_m = 3;
    options.ceiling_m = 15;
    targets = lattice_above(*surface, options, workers, progress);
  }
  Xyz over(double x, double y, double up) const { return {x, y, dem.place(x, y).height + up}; }
  HiddenVolume see(const std::vector<ViewPlace>& views, const VolumeViewshedOptions& options,
                   int threads = 2) const {
    Progress progress;
    return volume_viewshed(sight, views, targets, options, Workers(threads), progress);
  }
  // Columns and rows of the samples.
  Xy col_row(const Xyz& at) const {
    return {at.x / dem.cell_x, (at.y + dem.cell_y * (dem.rows - 1)) / dem.cell_y};
  }
};

std::vector<ViewPlace> points(const Ground& ground, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const Xyz high = ground.surface->bounds().high;
  std::vector<ViewPlace> views;
  for (int n = 0; n < 4; ++n)
    views.push_back(
        ViewPlace::point(ground.over(unit(random) * high.x, unit(random) * high.y, 2 + 8 * unit(random))));
  // Two close together, so that boxes of the tree say something.
  views.push_back(ViewPlace::point(views.back().place + Xyz{3, 2, 0.5}));
  return views;
}

// Every line by itself.
HiddenVolume line_by_line(const Ground& ground, const std::vector<ViewPlace>& views,
                          const VolumeViewshedOptions& options) {
  const double quantile = ground.volume.quantile(options.confidence);
  const auto most = static_cast<float>(ground.volume.largest_ratio());
  HiddenVolumeBuilder builder(ground.targets);
  for (int j = 0; j < ground.targets->ny; ++j) {
    for (int i = 0; i < ground.targets->nx; ++i) {
      const TargetColumn& column = ground.targets->column(i, j);
      std::vector<TargetAnswer> answers(static_cast<std::size_t>(column.size()));
      for (int k = column.first; k <= column.last; ++k) {
        TargetAnswer& answer = answers[static_cast<std::size_t>(k - column.first)];
        const Xyz target = ground.targets->centre(i, j, k);
        for (const ViewPlace& view : views) {
          if (std::hypot(target.x - view.place.x, target.y - view.place.y) > options.max_distance_m) continue;
          const RatioInterval ratio =
              ground.sight.ratio(ground.sight.zone(view.place), ground.sight.zone(target));
          const RatioInterval told{std::clamp(ratio.low, -most, most), std::clamp(ratio.high, -most, most)};
          const TargetAnswer one{static_cast<float>(proven_probability(told, Tails::kNormal)),
                                 verdict_of(ratio, quantile)};
          answer = options.seen_from == SeenFrom::kAny ? better_of(answer, one) : worse_of(answer, one);
        }
      }
      if (!answers.empty()) builder.set_column(i, j, answers);
    }
  }
  return builder.finish({}, Workers(1));
}

TEST(VolumeViewshed, gives_what_all_its_lines_give) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Ground ground(seed);
    VolumeViewshedOptions options;
    options.holds_for = HoldsFor::kPlace;
    options.seen_from = seed % 3 == 2 ? SeenFrom::kAll : SeenFrom::kAny;
    if (seed % 2) options.max_distance_m = 120;
    const std::vector<ViewPlace> views = points(ground, seed);
    const HiddenVolume seen = ground.see(views, options);
    EXPECT_TRUE(seen == line_by_line(ground, views, options)) << seed;
    const VerdictVolumes volumes = seen.volumes();
    EXPECT_GT(volumes.hidden_m3, 0);
    EXPECT_GT(volumes.visible_m3, 0);
  }
}

TEST(VolumeViewshed, is_the_same_for_any_number_of_threads) {
  const Ground ground(3);
  const std::vector<ViewPlace> views = points(ground, 3);
  EXPECT_TRUE(ground.see(views, {}, 1) == ground.see(views, {}, 3));
}

// A place by itself is told what the lattice's target there is told; p but for the half floats.
TEST(VolumeViewshed, listed_places_are_told_what_the_lattice_is_told) {
  std::size_t visible = 0, hidden = 0;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Ground ground(seed);
    VolumeViewshedOptions options;
    options.holds_for = HoldsFor::kPlace;
    options.seen_from = seed == 2 ? SeenFrom::kAll : SeenFrom::kAny;
    if (seed == 1) options.max_distance_m = 90;
    const std::vector<ViewPlace> views = points(ground, seed + 80);
    const HiddenVolume seen = ground.see(views, options);
    std::vector<Xyz> places;
    std::vector<TargetAnswer> expected;
    for (int j = 0; j < ground.targets->ny; ++j) {
      for (int i = 0; i < ground.targets->nx; ++i) {
        const TargetColumn& column = ground.targets->column(i, j);
        for (int k = column.first; k <= column.last; ++k) {
          places.push_back(ground.targets->centre(i, j, k));
          expected.push_back(seen.at(i, j, k));
        }
      }
    }
    Progress progress;
    const std::vector<TargetAnswer> found =
        see_places(ground.sight, views, places, options, Workers(2), progress);
    for (std::size_t n = 0; n < places.size(); ++n) {
      ASSERT_EQ(found[n].verdict, expected[n].verdict);
      if (found[n].verdict != kNoVerdict) {
        EXPECT_NEAR(found[n].p, expected[n].p, 1e-3);
      }
      visible += found[n].verdict == kVisible;
      hidden += found[n].verdict == kHidden;
    }
    EXPECT_EQ(found, see_places(ground.sight, views, places, options, Workers(1), progress));
    // Off the terrain nothing is told.
    const Xyz off = ground.surface->bounds().high + Xyz{50, 50, 0};
    EXPECT_EQ(see_places(ground.sight, views, {off}, options, Workers(1), progress)[0].verdict, kNoVerdict);
  }
  EXPECT_GT(visible, 1000u);
  EXPECT_GT(hidden, 1000u);
}

// A layer is the list of its centres.
TEST(VolumeViewshed, a_layer_is_told_what_its_places_are_told) {
  for (const HoldsFor holds_for : {HoldsFor::kPlace, HoldsFor::kTarget}) {
    Ground ground(5);
    Progress progress;
    ground.targets = layer_above(*ground.surface, 7, 8, Workers(2), progress);
    VolumeViewshedOptions options;
    options.holds_for = holds_for;
    const std::vector<ViewPlace> views = points(ground, 85);
    const HiddenVolume seen = ground.see(views, options);
    int same = 0, more = 0, visible = 0;
    for (int j = 0; j < ground.targets->ny; ++j) {
      for (int i = 0; i < ground.targets->nx; ++i) {
        const Xyz centre = ground.targets->centre(i, j, 0);
        if (ground.targets->column(i, j).size() == 0) continue;
        const TargetAnswer alone =
            see_places(ground.sight, views, {centre}, options, Workers(1), progress)[0];
        const TargetAnswer told = seen.at(i, j, 0);
        if (told.verdict == kUncertain && alone.verdict != kUncertain) {
          ++more;
        } else {
          ASSERT_EQ(told.verdict, alone.verdict);
          ++same;
        }
        visible += told.verdict == kVisible;
      }
    }
    EXPECT_GT(same, 100);
    EXPECT_GT(visible, 20);
    // Claims for whole squares are fewer than for their middles.
    EXPECT_EQ(more > 0, holds_for == HoldsFor::kTarget);
  }
}

// Claims only shrink as they have to hold for more, and never turn round.
TEST(VolumeViewshed, claims_less_the_farther_claims_have_to_hold) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Ground ground(seed);
    const std::vector<ViewPlace> views = points(ground, seed + 50);
    VolumeViewshedOptions options;
    options.holds_for = HoldsFor::kPlace;
    const HiddenVolume place = ground.see(views, options);
    options.holds_for = HoldsFor::kVoxel;
    const HiddenVolume voxel = ground.see(views, options);
    const auto claims = [](const HiddenVolume& v) { return v.volumes().hidden_m3 + v.volumes().visible_m3; };
    EXPECT_LT(claims(voxel), claims(place));
    EXPECT_GT(claims(voxel), 0.5 * claims(place));
    for (int j = 0; j < ground.targets->ny; ++j) {
      for (int i = 0; i < ground.targets->nx; ++i) {
        const TargetColumn& column = ground.targets->column(i, j);
        for (int k = column.first; k <= column.last; ++k) {
          const std::uint8_t claim = voxel.at(i, j, k).verdict;
          if (claim != kUncertain) {
            EXPECT_EQ(claim, place.at(i, j, k).verdict);
          }
        }
      }
    }
  }
}

// Hidden: from every place of the cells, every place of the target. Visible: some view place sees all of it.
TEST(VolumeViewshed, speaks_for_whole_cells_and_targets) {
  int hidden = 0, visible = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Ground ground(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<ViewPlace> views;
    const double side = 12;
    for (int n = 0; n < 4; ++n) {
      const Xyz middle = ground.over(80 + side * (n % 2), 100 + side * (n / 2), 6);
      const Xyz room{side / 2, side / 2, 2};
      views.push_back({middle, {middle - room, middle + room}});
    }
    VolumeViewshedOptions options;
    options.holds_for = seed % 2 ? HoldsFor::kTarget : HoldsFor::kVoxel;
    const HiddenVolume seen = ground.see(views, options);
    const Xyz room = seed % 2 ? Xyz{3.5, 3.5, 1.5} : Xyz{0.5, 0.5, 0.25};
    const auto within = [&](const Xyz& middle, const Xyz& half) {
      const auto draw = [&](double h) { return h * (2 * unit(random) - 1); };
      return middle + Xyz{draw(half.x), draw(half.y), draw(half.z)};
    };
    std::deque<Lines> from_places, from_cells;
    for (const ViewPlace& view : views) {
      const Xy at = ground.col_row(view.place);
      from_places.emplace_back(ground.dem, at.x, at.y, view.place.z, true);
      const Xyz other = within(view.place, 0.5 * (view.cell.high - view.cell.low));
      const Xy other_at = ground.col_row(other);
      from_cells.emplace_back(ground.dem, other_at.x, other_at.y, other.z, true);
    }
    for (int j = 0; j < ground.targets->ny; ++j) {
      for (int i = 0; i < ground.targets->nx; ++i) {
        const TargetColumn& column = ground.targets->column(i, j);
        for (int k = column.first; k <= column.last; ++k) {
          const std::uint8_t claim = seen.at(i, j, k).verdict;
          if (claim != kVisible && claim != kHidden) continue;
          (claim == kVisible ? visible : hidden)++;
          std::vector<double> least(views.size(), 10);
          for (int n = 0; n < 4; ++n) {
            Xyz target = within(ground.targets->centre(i, j, k), room);
            const Xy at = ground.col_row(target);
            if (at.x < 0 || at.y < 0 || at.x > ground.dem.cols - 1 || at.y > ground.dem.rows - 1) continue;
            target.z = std::max(target.z, ground.dem.place(target.x, target.y).height + 1e-3);
            for (std::size_t v = 0; v < views.size(); ++v) {
              least[v] = std::min(least[v], from_places[v].ratio(at.x, at.y, target.z));
              if (claim == kHidden) {
                EXPECT_LT(from_cells[v].ratio(at.x, at.y, target.z), 1.96);
              }
            }
          }
          if (claim == kVisible) {
            EXPECT_GE(*std::ranges::max_element(least), 1.96 - 1e-3);
          }
        }
      }
    }
  }
  EXPECT_GT(hidden, 500);
  EXPECT_GT(visible, 500);
}

}  // namespace
}  // namespace sightbound
