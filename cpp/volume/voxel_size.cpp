// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/voxel_size.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/error.h"

namespace sightbound {

namespace {

constexpr double kSqrt2 = 1.4142135623730951;
constexpr double kLeastVoxel = 1e-3, kMostVoxel = 1e5;  // metres
constexpr std::size_t kFacesLookedAt = 200000;          // for quantiles and sums
constexpr double kLeafBytes = 2048 + 96, kNodeBytes = 34 * 1024;
constexpr double kMargin = 1.15;  // the sums below are within this of what was measured

// What a face asks of voxels.
struct FaceNeeds {
  double error = 0;             // least E(1 sigma), metres
  double widest = 0;            // largest sigma, metres
  double steepness = 0;         // tan(slope)
  double run_x = 0, run_y = 0;  // |dh/dx|, |dh/dy|
  double area = 0;              // in plan for the vertical metric, else in space, m^2
};

FaceNeeds needs_of(const Surface& surface, const SurfaceFace& face) {
  FaceNeeds needs;
  const Xyz normal = cross(face.corner[1] - face.corner[0], face.corner[2] - face.corner[0]);
  const double up = std::abs(normal.z);
  needs.run_x = std::abs(normal.x) / up;
  needs.run_y = std::abs(normal.y) / up;
  needs.steepness = std::hypot(normal.x, normal.y) / up;
  needs.area = 0.5 * (surface.metric() == Metric::kVertical ? up : length(normal));
  needs.error = std::max(*std::min_element(face.sampling.begin(), face.sampling.end()), kLeastSigma);
  const double amplitude = *std::max_element(face.amplitude.begin(), face.amplitude.end());
  const double longest =
      std::max({length(face.corner[1] - face.corner[0]), length(face.corner[2] - face.corner[1]),
                length(face.corner[0] - face.corner[2])});
  const double between = amplitude > 0 ? amplitude * surface.profile()(0.6 * longest, amplitude) : 0;
  needs.widest =
      std::max(*std::max_element(face.sampling.begin(), face.sampling.end()) + between, kLeastSigma);
  return needs;
}

template <class F>
void for_some_faces(const Surface& surface, const F& f) {
  const std::size_t step = std::max<std::size_t>(surface.face_count() / kFacesLookedAt, 1) |
                           1;  // odd: both kinds of a DEM's faces
  for (std::size_t number = 0; number < surface.face_count(); number += step) {
    if (const auto face = surface.face(number)) f(needs_of(surface, *face), static_cast<double>(step));
  }
}

// Voxel side that holds a face, height being `flatness` times the side.
double side_for(const Surface& surface, const FaceNeeds& needs, double quantile, double flatness) {
  const double eps = quantile * needs.error;
  if (surface.metric() == Metric::kVertical) return eps / (flatness + kSqrt2 * needs.steepness);
  return eps / std::sqrt(2 + flatness * flatness);
}

void check_length(double value, const char* name) {
  if (value == 0 || (value >= kLeastVoxel && value <= kMostVoxel)) return;
  throw InvalidInput(std::string(name) + " is " + std::to_string(value) +
                     "; give metres from 0.001 to 100000, or 0 to choose it.");
}

double quantile_of(double confidence, Tails tails, const char* name) {
  if (!(confidence > 0 && confidence < 1)) {
    throw InvalidInput(std::string(name) + " is " + std::to_string(confidence) +
                       "; it must lie between 0 and 1, e.g. 0.95.");
  }
  return two_sided_quantile(confidence, tails);
}

}  // namespace

double largest_ratio_of(const VolumeOptions& options) {
  const double wanted = quantile_of(options.confidence, options.tails, "confidence");
  if (options.largest_confidence == 0) return std::max(certain_ratio(options.tails), wanted);
  const double largest = quantile_of(options.largest_confidence, options.tails, "largest_confidence");
  if (largest < wanted) {
    throw InvalidInput("largest_confidence is " + std::to_string(options.largest_confidence) +
                       ", below confidence " + std::to_string(options.confidence) +
                       "; raise it or leave it out.");
  }
  return largest;
}

VoxelChoice choose_voxels(const Surface& surface, const VolumeOptions& options) {
  check_length(options.voxel_m, "voxel_m");
  check_length(options.voxel_height_m, "voxel_height_m");
  if (options.alpha != 0 && !(options.alpha >= 1 && options.alpha <= 1000)) {
    throw InvalidInput("alpha is " + std::to_string(options.alpha) +
                       "; give 1 to 1000, or 0 to take it from the slopes.");
  }
  const double quantile = quantile_of(options.confidence, options.tails, "confidence");
  VoxelChoice choice{options.voxel_m, options.voxel_height_m};
  if (choice.voxel_m == 0) {
    if (options.alpha > 0) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t number = 0; number < surface.face_count(); ++number) {
        if (const auto face = surface.face(number)) least = std::min(least, needs_of(surface, *face).error);
      }
      choice.voxel_m = std::max(quantile * least / options.alpha, kLeastVoxel);
    } else {
      std::vector<double> sides;
      for_some_faces(surface, [&](const FaceNeeds& needs, double) {
        sides.push_back(side_for(surface, needs, quantile, 1));
      });
      double side = surface.spacing_m();
      if (!sides.empty()) {
        const auto at = sides.begin() +
                        static_cast<std::ptrdiff_t>((1 - kFacesHeld) * static_cast<double>(sides.size() - 1));
        std::nth_element(sides.begin(), at, sides.end());
        side = *at;
      }
      const double spacing = surface.spacing_m();
      choice.voxel_m = std::clamp(std::clamp(side, kFinestShare * spacing, spacing), kLeastVoxel, kMostVoxel);
    }
  }
  if (choice.voxel_height_m == 0) choice.voxel_height_m = choice.voxel_m;
  const Box3& box = surface.bounds();
  const double most = std::max({box.high.x / choice.voxel_m, box.high.y / choice.voxel_m,
                                std::max(std::abs(box.low.z), std::abs(box.high.z)) / choice.voxel_height_m});
  if (!(most < 1 << 28)) {
    throw InvalidInput("voxel_m is " + std::to_string(choice.voxel_m) +
                       ", too small for a terrain of this extent; give a larger one.");
  }
  return choice;
}

HeldFaces count_held(const Surface& surface, const VoxelChoice& voxels, double confidence, Tails tails) {
  const double quantile = quantile_of(confidence, tails, "confidence"),
               flatness = voxels.voxel_height_m / voxels.voxel_m;
  HeldFaces held;
  held.finest_needed_m = std::numeric_limits<double>::infinity();
  for (std::size_t number = 0; number < surface.face_count(); ++number) {
    const auto face = surface.face(number);
    if (!face) continue;
    const double side = side_for(surface, needs_of(surface, *face), quantile, flatness);
    ++held.faces;
    held.not_held += side < voxels.voxel_m;
    held.finest_needed_m = std::min(held.finest_needed_m, side);
  }
  return held;
}

VolumeNeed estimate_need(const Surface& surface, const VolumeOptions& options) {
  const VoxelChoice voxels = choose_voxels(surface, options);
  const double ratio = largest_ratio_of(options), side = voxels.voxel_m, height = voxels.voxel_height_m;
  VolumeNeed need{side, height, 0, 0};
  double leaves = 0, nodes = 0;
  for_some_faces(surface, [&](const FaceNeeds& needs, double weight) {
    const double thick = 2 * ratio * needs.widest;
    // Layers of cubes of n voxels that a flat piece of band meets: its thickness, its rise across the cube,
    // and one for chance.
    const auto cubes = [&](double n) {
      if (surface.metric() == Metric::kNormal) {
        const double cube = n * std::min(side, height);
        return needs.area / (n * side * n * side) * (thick / cube + 2.5);
      }
      const double rise = n * side * (needs.run_x + needs.run_y);
      return needs.area / (n * side * n * side) * ((thick + rise) / (n * height) + 1);
    };
    need.voxels += weight * cubes(1);
    leaves += weight * cubes(8);
    nodes += weight * cubes(128);
  });
  const double blocks =
      std::ceil(surface.bounds().high.x / side / 128) * std::ceil(surface.bounds().high.y / side / 128);
  need.bytes =
      static_cast<std::size_t>(kMargin * (leaves * kLeafBytes + std::max(nodes, blocks) * kNodeBytes)) +
      surface.bytes();
  return need;
}

}  // namespace sightbound
