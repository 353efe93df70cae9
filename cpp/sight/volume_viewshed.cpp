// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/volume_viewshed.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/error.h"
#include "sight/target_tile.h"

namespace sightbound {

namespace {

Xyz room_of(HoldsFor holds_for, const ErrorVolume& volume, const Xyz& target) {
  if (holds_for == HoldsFor::kPlace) return {};
  if (holds_for == HoldsFor::kTarget) return 0.5 * target;
  return 0.5 * Xyz{volume.voxel_m(), volume.voxel_m(), volume.voxel_height_m()};
}

// The ends of all lines at the views.
void look_around(TileQuestion& ask, const Workers& workers) {
  const std::vector<ViewPlace>& places = ask.views.places();
  const bool points = std::ranges::all_of(places, &ViewPlace::is_point);
  ask.rooms.resize(places.size());
  if (!points) ask.cells.resize(places.size());
  for (const ViewPlace& view : places) ask.zones.push_back(ask.sight.zone(view.place));
  workers.for_each(places.size(), [&](std::size_t n) {
    const Box3& cell = places[n].cell;
    ask.rooms[n] = ask.sight.room(places[n].place, {});
    if (!points) ask.cells[n] = ask.sight.room(0.5 * (cell.low + cell.high), 0.5 * (cell.high - cell.low));
  });
}

// `target`: the sizes of a target's box.
TileQuestion question(const VolumeSight& sight, const ViewTree& views, const VolumeViewshedOptions& options,
                      const Xyz& target, const Workers& workers) {
  const ErrorVolume& volume = sight.rays().volume();
  TileQuestion ask{sight,
                   options,
                   volume.quantile(options.confidence),
                   volume.largest_ratio(),
                   volume.tails(),
                   room_of(options.holds_for, volume, target),
                   volume.surface().metric() == Metric::kVertical,
                   volume.surface().sides() == Sides::kSolid,
                   views,
                   {},
                   {},
                   {}};
  look_around(ask, workers);
  return ask;
}

void require_views(const std::vector<ViewPlace>& views) {
  if (views.empty()) throw InvalidInput("views is empty; give at least one place to look from.");
}

}  // namespace

HiddenVolume volume_viewshed(const VolumeSight& sight, const std::vector<ViewPlace>& views,
                             std::shared_ptr<const TargetLattice> targets,
                             const VolumeViewshedOptions& options, const Workers& workers,
                             Progress& progress) {
  require_views(views);
  const ViewTree tree(views);
  const TileQuestion ask = question(
      sight, tree, options, {targets->spacing_m, targets->spacing_m, targets->height_spacing_m}, workers);

  HiddenVolumeBuilder builder(targets);
  constexpr int kSide = TargetTile::kSide;
  const int across = (targets->nx + kSide - 1) / kSide, down = (targets->ny + kSide - 1) / kSide;
  const std::size_t tiles = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
  progress.begin(1, static_cast<double>(tiles));
  workers.for_each(tiles, [&](std::size_t n) {
    const int j = static_cast<int>(n / static_cast<std::size_t>(across)),
              i = static_cast<int>(n % static_cast<std::size_t>(across));
    TargetTile tile(ask, *targets, i * kSide, j * kSide, progress);
    tile.see();
    tile.put_into(builder);
    progress.advance(1);
  });
  HiddenVolumeInfo info;
  info.confidence = options.confidence;
  HiddenVolume hidden = builder.finish(std::move(info), workers);
  progress.finish();
  return hidden;
}

std::vector<TargetAnswer> see_places(const VolumeSight& sight, const std::vector<ViewPlace>& views,
                                     const std::vector<Xyz>& targets, const VolumeViewshedOptions& options,
                                     const Workers& workers, Progress& progress) {
  require_views(views);
  const ViewTree tree(views);
  const TileQuestion ask = question(sight, tree, options, {}, workers);
  std::vector<TargetAnswer> answers(targets.size());
  progress.begin(1, static_cast<double>(targets.size()));
  workers.for_each(targets.size(), [&](std::size_t n) {
    std::vector<std::uint32_t> numbers;
    const Xyz& place = targets[n];
    const double ground = terrain_over(sight.rays().volume().surface(), place.x, place.y, numbers).ground;
    if (!std::isnan(ground)) {
      const TargetLattice alone = lattice_of(place, ground);
      TargetTile tile(ask, alone, 0, 0, progress);
      tile.see();
      answers[n] = tile.answers(0, 0).front();
    }
    progress.advance(1);
  });
  progress.finish();
  return answers;
}

}  // namespace sightbound
