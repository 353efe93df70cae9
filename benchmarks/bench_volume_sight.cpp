// SPDX-License-Identifier: GPL-3.0-or-later
// bench_volume_sight DEM sigma voxel [spacing [threads]]
//
// Lines a second on one thread, each with the hint of its neighbour, from the middle of the DEM to a ring 4.5
// km off, at three heights, and the seconds of volume viewsheds of one observer and of a patrol square there,
// targets up to 20 m above ground.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "bench_surface.h"

#include "sight/volume_viewshed.h"
#include "volume/error_volume.h"

namespace {

using namespace sightbound;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double ground_at(const DemSurface& surface, double x, double y) {
  std::vector<std::uint32_t> faces;
  surface.faces_near({{x, y, -1e6}, {x, y, 1e6}}, faces);
  for (const std::uint32_t number : faces) {
    if (const auto face = surface.face(number)) return place_on(*face, surface.profile(), x, y).height;
  }
  return 0;
}

void time_lines(const VolumeRays& rays, const DemSurface& surface, double eye, double target) {
  constexpr int kLines = 100000;
  constexpr double kReach = 4500;
  const Xyz high = surface.bounds().high;
  const double x = high.x / 2, y = high.y / 2;
  std::vector<VolumeLine> lines;
  for (int n = 0; n < kLines; ++n) {
    const double angle = 2 * std::numbers::pi * n / kLines, to_x = x + kReach * std::cos(angle),
                 to_y = y + kReach * std::sin(angle);
    lines.push_back(
        {{x, y, ground_at(surface, x, y) + eye}, {to_x, to_y, ground_at(surface, to_x, to_y) + target}, 1.4});
  }
  const auto start = Clock::now();
  int hidden = 0, visible = 0;
  double hint = VolumeRays::kNever;
  for (const VolumeLine& line : lines) {
    const auto [k, closest] = rays.least_near(line, 15 / kReach, 1 - 15 / kReach, hint);
    hint = closest;
    hidden += k.high <= -1.96f;
    visible += k.low >= 1.96f;
  }
  std::printf("eye %g m, targets %g m above ground: %.0f lines/s (%d %% hidden, %d %% visible)\n", eye,
              target, kLines / seconds_since(start), 100 * hidden / kLines, 100 * visible / kLines);
}

void time_viewshed(const VolumeSight& sight, const char* what, const std::vector<ViewPlace>& views,
                   const std::shared_ptr<const TargetLattice>& targets, const VolumeViewshedOptions& options,
                   const Workers& workers) {
  Progress progress;
  const auto start = Clock::now();
  const HiddenVolume hidden = volume_viewshed(sight, views, targets, options, workers, progress);
  const double seconds = seconds_since(start);
  const VerdictVolumes volumes = hidden.volumes();
  const double all = volumes.hidden_m3 + volumes.uncertain_m3 + volumes.visible_m3;
  std::printf("%s, %zu targets: %.1f s (%.1f %% hidden, %.1f %% uncertain)\n", what, targets->targets(),
              seconds, 100 * volumes.hidden_m3 / all, 100 * volumes.uncertain_m3 / all);
  std::fflush(stdout);
}

// A square of places 2 m above the ground, their cells as high as the ground within them.
std::vector<ViewPlace> patrol_square(const DemSurface& surface, double side, double spacing) {
  const Xyz high = surface.bounds().high;
  std::vector<ViewPlace> views;
  for (double y = high.y / 2 - side / 2 + spacing / 2; y < high.y / 2 + side / 2; y += spacing) {
    for (double x = high.x / 2 - side / 2 + spacing / 2; x < high.x / 2 + side / 2; x += spacing) {
      double low = 1e9, top = -1e9;
      for (int n = 0; n <= 16; ++n) {
        const double z =
            ground_at(surface, x + (n % 4 - 1.5) / 3 * spacing, y + (n / 4 % 4 - 1.5) / 3 * spacing);
        low = std::min(low, z), top = std::max(top, z);
      }
      const double half = spacing / 2;
      views.push_back({{x, y, ground_at(surface, x, y) + 2},
                       {{x - half, y - half, low + 2}, {x + half, y + half, top + 2}}});
    }
  }
  return views;
}

void time_viewsheds(const VolumeRays& rays, const DemSurface& surface, double spacing, int threads) {
  const Workers workers(threads);
  Progress progress;
  LatticeOptions targets;
  targets.spacing_m = spacing;
  const auto lattice = lattice_above(surface, targets, workers, progress);
  constexpr double kBend = (1 - 0.13) / (2 * 6371008.8);
  const VolumeSight sight(rays, {kBend, 0, kBend});
  const Xyz high = surface.bounds().high;
  const Xyz eye{high.x / 2, high.y / 2, ground_at(surface, high.x / 2, high.y / 2) + 2};
  VolumeViewshedOptions options;
  options.holds_for = HoldsFor::kPlace;
  time_viewshed(sight, "one observer, targets as places", {ViewPlace::point(eye)}, lattice, options, workers);
  options.holds_for = HoldsFor::kTarget;
  time_viewshed(sight, "one observer, targets as boxes", {ViewPlace::point(eye)}, lattice, options, workers);
  options.holds_for = HoldsFor::kVoxel;
  time_viewshed(sight, "one observer", {ViewPlace::point(eye)}, lattice, options, workers);
  time_viewshed(sight, "a patrol square of 200 m, cells of 25 m", patrol_square(surface, 200, 25), lattice,
                options, workers);
}

int run(int count, char** words) {
  if (count < 4) {
    std::fprintf(stderr, "bench_volume_sight DEM sigma voxel [spacing [threads]]\n");
    return 2;
  }
  const auto source = open_dem(words[1]);
  const auto surface = bench_surface(*source, std::atof(words[2]));
  VolumeOptions options;
  options.voxel_m = std::atof(words[3]);
  Progress progress;
  auto start = Clock::now();
  const ErrorVolume volume = ErrorVolume::build(surface, options, progress);
  std::printf("bounds of k: %.1f s, %.0f MiB\n", seconds_since(start),
              static_cast<double>(volume.report().bytes) / (1 << 20));
  start = Clock::now();
  const VolumeRays rays(volume);
  std::printf("summary for lines: %.1f s\n", seconds_since(start));
  time_lines(rays, *surface, 2, 5);
  time_lines(rays, *surface, 9, 9);
  time_lines(rays, *surface, 30, 30);
  time_lines(rays, *surface, 100, 60);
  time_viewsheds(rays, *surface, count > 4 ? std::atof(words[4]) : 10, count > 5 ? std::atoi(words[5]) : 0);
  return 0;
}

}  // namespace

int main(int count, char** words) {
  try {
    return run(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
