// SPDX-License-Identifier: GPL-3.0-or-later
// bench_volume DEM (covers|bounds|file) (columns|faces|normals) sigma voxel [variation [threads]]
//
// One line: seconds to build, and the process's peak memory less what it held before. Columns read the DEM's
// grid, faces a TIN made of it. benchmarks/volume.sh runs the lot.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>

#include "bench_surface.h"
#include <sys/resource.h>

#include "base/memory_budget.h"
#include "terrain/regular_tin.h"
#include "volume/error_volume.h"
#include "volume/tin_surface.h"

namespace {

using namespace sightbound;

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

std::shared_ptr<const Surface> surface_of(const DemSource& source, const std::string& how, double sigma,
                                          double variation) {
  Progress progress;
  if (how != "columns") {
    const Metric metric = how == "faces" ? Metric::kVertical : Metric::kNormal;
    Tin tin = regular_tin(source, 1, MemoryBudget(), progress).tin;
    ErrorModel model;
    model.vertical_rmse = sigma;
    model.geologic_variation = variation;
    TinError error = resolve_tin_error(tin, model, metric);
    return std::make_shared<TinSurface>(std::move(tin), std::move(error), metric);
  }
  return bench_surface(source, sigma, variation);
}

int run(int count, char** words) {
  if (count < 6) {
    std::fprintf(
        stderr,
        "bench_volume DEM (covers|bounds|file) (columns|faces|normals) sigma voxel [variation [threads]]\n");
    return 2;
  }
  const std::string what = words[2], how = words[3];
  const double sigma = std::atof(words[4]), voxel = std::atof(words[5]),
               variation = count > 6 ? std::atof(words[6]) : 0;
  const auto source = open_dem(words[1]);
  const std::shared_ptr<const Surface> surface = surface_of(*source, how, sigma, variation);
  VolumeOptions options;
  options.voxel_m = voxel;
  options.threads = count > 7 ? std::atoi(words[7]) : 0;
  Progress progress;
  const double before = peak_mib();
  const VolumeNeed need = estimate_need(*surface, options);
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  if (what == "covers") {
    const CoverMasks covers = build_covers(surface, 0.95, options, progress);
    const double took = seconds();
    std::printf(
        "covers %-7s sigma %g voxel %g: %6.2f s, peak %6.0f MiB (+%.0f); masks %.0f MiB, %zu inner, %zu "
        "outer\n",
        how.c_str(), sigma, voxel, took, peak_mib(), peak_mib() - before,
        static_cast<double>(covers.inner.bytes() + covers.outer.bytes()) / 1048576, covers.inner.count(),
        covers.outer.count());
    return 0;
  }
  const ErrorVolume volume = ErrorVolume::build(surface, options, progress);
  const double took = seconds();
  std::printf(
      "bounds %-7s sigma %g voxel %g: %6.2f s, peak %6.0f MiB (+%.0f); volume %.0f MiB, estimated %.0f; %zu "
      "voxels, estimated %.0f\n",
      how.c_str(), sigma, voxel, took, peak_mib(), peak_mib() - before,
      static_cast<double>(volume.report().bytes) / 1048576, static_cast<double>(need.bytes) / 1048576,
      volume.report().voxels, need.voxels);
  if (what == "file") {
    const std::string path = std::string(words[1]) + ".vdb";
    const double built = seconds();
    volume.save(path, progress);
    const double written = seconds();
    const ErrorVolume again = ErrorVolume::open(path, progress);
    std::printf("  written in %.2f s (%.0f MiB), opened in %.2f s, peak %.0f MiB\n", written - built,
                static_cast<double>(std::filesystem::file_size(path)) / 1048576, seconds() - written,
                peak_mib());
    std::filesystem::remove(path);
  }
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
