// SPDX-License-Identifier: GPL-3.0-or-later
#include "sight/volume_viewshed.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "sight/target_tile.h"

namespace sightbound {

namespace {

Xyz room_of(HoldsFor holds_for, const ErrorVolume& volume, const TargetLattice& targets) {
  if (holds_for == HoldsFor::kPlace) return {};
  const bool voxel = holds_for == HoldsFor::kVoxel;
  const double plan = voxel ? volume.voxel_m() : targets.spacing_m;
  return 0.5 * Xyz{plan, plan, voxel ? volume.voxel_height_m() : targets.height_spacing_m};
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

}  // namespace

HiddenVolume volume_viewshed(const VolumeSight& sight, const std::vector<ViewPlace>& views,
                             std::shared_ptr<const TargetLattice> targets,
                             const VolumeViewshedOptions& options, const Workers& workers,
                             Progress& progress) {
  const ErrorVolume& volume = sight.rays().volume();
  const double quantile = volume.quantile(options.confidence);
  if (views.empty()) throw InvalidInput("views is empty; give at least one place to look from.");
  const ViewTree tree(views);
  TileQuestion ask{sight,
                   *targets,
                   options,
                   quantile,
                   volume.largest_ratio(),
                   room_of(options.holds_for, volume, *targets),
                   volume.surface().metric() == Metric::kVertical,
                   volume.surface().sides() == Sides::kSolid,
                   tree,
                   {},
                   {},
                   {}};
  look_around(ask, workers);

  HiddenVolumeBuilder builder(targets);
  constexpr int kSide = TargetTile::kSide;
  const int across = (targets->nx + kSide - 1) / kSide, down = (targets->ny + kSide - 1) / kSide;
  const std::size_t tiles = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
  progress.begin(1, static_cast<double>(tiles));
  workers.for_each(tiles, [&](std::size_t n) {
    const int j = static_cast<int>(n / static_cast<std::size_t>(across)),
              i = static_cast<int>(n % static_cast<std::size_t>(across));
    TargetTile tile(ask, i * kSide, j * kSide, progress);
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

}  // namespace sightbound
