// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/verify_job.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/memory_budget.h"
#include "io/crs.h"
#include "io/tin_crs.h"

namespace sightbound {

namespace {

constexpr std::size_t kBytesOfSample = 13;     // height, tolerance, deviation, used
constexpr std::size_t kBytesOfFace = 400;      // of the simplified, in its bins or in a tree of boxes
constexpr std::size_t kBytesOfOriginal = 150;  // of a face of a TIN, in a tree of boxes

void require_one_crs(const std::string& original, const std::string& simplified) {
  if (original.empty() || simplified.empty() ||
      same_crs(horizontal_crs(original), horizontal_crs(simplified)))
    return;
  throw InvalidInput("original and simplified have different CRSs (" + short_crs(horizontal_crs(original)) +
                     " and " + short_crs(horizontal_crs(simplified)) + "); bring them into one.");
}

void require_memory(std::size_t samples, std::size_t faces, const Tin& simplified,
                    const VerifyJobOptions& options) {
  MemoryBudget(options.memory_budget)
      .require(samples * kBytesOfSample + faces * kBytesOfOriginal + simplified.faces.size() * kBytesOfFace,
               "Verifying " + std::to_string(simplified.faces.size()) + " faces against " +
                   std::to_string(samples) + " samples",
               "Verify a part of them.");
}

VerifyOptions used_options(const VerifyJobOptions& options) {
  return {options.resolution_m, options.threads};
}

// Rows of a raster, first one last.
template <class T>
std::vector<T> flipped(std::span<const T> values, int rows, int cols) {
  std::vector<T> turned(values.begin(), values.end());
  for (int top = 0, bottom = rows - 1; top < bottom; ++top, --bottom) {
    const auto row = [&](int r) { return turned.begin() + static_cast<std::ptrdiff_t>(r) * cols; };
    std::swap_ranges(row(top), row(top) + cols, row(bottom));
  }
  return turned;
}

}  // namespace

VerifyReport run_verify(const DemSource& original, const Tin& simplified, const Tolerance& tolerance,
                        const VerifyJobOptions& options, Progress& progress) {
  require_one_crs(original.crs_wkt(), simplified.crs_wkt);
  const double unit = metres_per_plan_unit(original.crs_wkt());
  if (unit != simplified.metres_per_unit) {
    throw InvalidInput(
        "simplified has no CRS, or another unit of length in plan than original; give it the CRS "
        "of the DEM.");
  }
  require_memory(original.window().cells(), 0, simplified, options);
  Tolerance used = tolerance;
  std::vector<float> turned;
  const bool fits = tolerance.of_vertices.size() == original.window().cells();  // else verify() refuses it
  if (original.flipped() && fits) {
    turned = flipped(tolerance.of_vertices, original.rows(), original.cols());
    used.of_vertices = turned;
  }
  progress.begin(0.1, original.rows());
  const OriginalDem surface(original.read(original.window(), progress), original.geotransform(), simplified);
  VerifyReport report = verify_heights(surface, simplified, used, used_options(options), progress);
  if (original.flipped()) {
    report.vertex_deviation =
        flipped(std::span<const float>(report.vertex_deviation), original.rows(), original.cols());
  }
  return report;
}

VerifyReport run_verify(const Tin& original, const Tin& simplified, const Tolerance& tolerance,
                        const VerifyJobOptions& options, Progress& progress) {
  require_one_crs(original.crs_wkt, simplified.crs_wkt);
  require_memory(original.vertices.size(), original.faces.size(), simplified, options);
  return verify(original, simplified, tolerance, used_options(options), progress);
}

}  // namespace sightbound
