// SPDX-License-Identifier: GPL-3.0-or-later
// bench_simplify DEM tolerance [threads [target_faces [least_gain]]]
//
// One line: faces before and after, seconds, and the process's peak memory less what it held before.
// benchmarks/simplify.sh runs the lot. Cells count as they are, whatever the CRS: heights alone matter.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include <sys/resource.h>

#include "io/raster_dem.h"
#include "simplify/simplify.h"

namespace {

using namespace sightbound;

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
}

int run(int count, char** words) {
  if (count < 3) {
    std::fprintf(stderr, "bench_simplify DEM tolerance [threads [target_faces [least_gain]]]\n");
    return 2;
  }
  const auto source = open_dem(words[1]);
  Progress progress;
  const Grid<float> heights = source->read(source->window(), progress);
  SimplifyOptions options;
  options.tolerance_m = std::atof(words[2]);
  options.threads = count > 3 ? std::atoi(words[3]) : 0;
  options.target_faces = count > 4 ? std::atoll(words[4]) : 0;
  if (count > 5) options.least_gain = std::atof(words[5]);
  const double before = peak_mib(), used_before = processor_seconds();
  const auto start = std::chrono::steady_clock::now();
  const SimplifiedTin made = simplify_dem({heights, source->geotransform(), 1, ""}, options, progress);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf(
      "%g m: %9zu -> %7zu faces, deviation %.6g m (%.6f of the tolerance); %6.2f s (%.2f s of processors), "
      "peak %.0f MiB (+%.0f)\n",
      options.tolerance_m, made.report.faces_before, made.report.faces_after, made.report.largest_deviation_m,
      made.report.largest_ratio, took.count(), processor_seconds() - used_before, peak_mib(),
      peak_mib() - before);
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
