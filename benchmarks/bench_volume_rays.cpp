// SPDX-License-Identifier: GPL-3.0-or-later
// bench_volume_rays DEM sigma voxel [lines [rounds]]
//
// Which of many lines of 4.5 km, both ends 4 m above the outer cover at 95 %, meet that cover? Asked of
// VolumeRays, and of OpenVDB's own means: VolumeHDDA for the spans of leaves on the way, DDA over the voxels
// within. One thread, in turn; medians, and how often both say the same.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "bench_surface.h"
#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>

#include "volume/error_volume.h"
#include "volume/vdb.h"
#include "volume/volume_ray.h"

namespace {

using namespace sightbound;
using Clock = std::chrono::steady_clock;

constexpr double kReach = 4500, kAboveCover = 4, kQuantile = 1.95996;

std::vector<VolumeLine> lines_close_to(const DemSurface& surface, double half_width, int count) {
  const Xyz high = surface.bounds().high;
  std::vector<std::uint32_t> faces;
  const auto end = [&](double x, double y) -> std::optional<Xyz> {
    faces.clear();
    surface.faces_near({{x, y, -1e6}, {x, y, 1e6}}, faces);
    for (const std::uint32_t number : faces) {
      if (const auto face = surface.face(number))
        return Xyz{x, y, place_on(*face, surface.profile(), x, y).height + half_width + kAboveCover};
    }
    return {};
  };
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<VolumeLine> lines;
  while (lines.size() < static_cast<std::size_t>(count)) {
    const double x = high.x * share(random), y = high.y * share(random),
                 angle = 2 * std::numbers::pi * share(random);
    const auto from = end(x, y), to = end(x + kReach * std::cos(angle), y + kReach * std::sin(angle));
    if (from && to) lines.push_back({*from, *to, 0});
  }
  return lines;
}

class OpenVdbRays {
 public:
  OpenVdbRays(const BitTree& cover, double side, double height)
      : cover_(cover), access_(cover), side_(side), height_(height) {}

  bool meets(const VolumeLine& line) {
    const Ray whole = along(line);
    for (double begin = whole.t0(); begin < whole.t1();) {
      Ray rest = whole;
      rest.setTimes(begin, whole.t1());
      const Ray::TimeSpan span = hdda_.march(rest, access_);
      if (!span.valid()) return false;
      openvdb::math::DDA<Ray> voxels(whole, span.t0, span.t1);
      do {
        if (access_.isValueOn(voxels.voxel())) return true;
      } while (voxels.step());
      begin = span.t1 + kBeyondSpan;
    }
    return false;
  }

 private:
  using Ray = openvdb::math::Ray<double>;
  static constexpr double kBeyondSpan = 1e-6;  // voxels

  Ray along(const VolumeLine& line) const {
    const openvdb::Vec3d from(line.from.x / side_, line.from.y / side_, line.from.z / height_),
        to(line.to.x / side_, line.to.y / side_, line.to.z / height_);
    const openvdb::Vec3d way = to - from;
    return {from, way / way.length(), 0, way.length()};
  }

  const BitTree& cover_;
  openvdb::tree::ValueAccessor<const BitTree, false> access_;
  double side_, height_;
  openvdb::math::VolumeHDDA<BitTree, Ray, BitTree::RootNodeType::ChildNodeType::LEVEL> hdda_;
};

template <class Meets>
double lines_a_second(const std::vector<VolumeLine>& lines, std::vector<bool>& met, const Meets& meets) {
  met.assign(lines.size(), false);
  const auto start = Clock::now();
  for (std::size_t n = 0; n < lines.size(); ++n) met[n] = meets(lines[n]);
  return static_cast<double>(lines.size()) / std::chrono::duration<double>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) {
    std::fprintf(stderr, "bench_volume_rays DEM sigma voxel [lines [rounds]]\n");
    return 2;
  }
  const double sigma = std::atof(words[2]);
  const auto surface = bench_surface(*open_dem(words[1]), sigma);
  VolumeOptions options;
  options.voxel_m = std::atof(words[3]);
  Progress progress;
  const ErrorVolume volume = ErrorVolume::build(surface, options, progress);
  const VolumeRays rays(volume);
  const VolumeMask cover = volume.outer(0.95);
  OpenVdbRays peer(cover.tree().bits, volume.voxel_m(), volume.voxel_height_m());
  const auto lines = lines_close_to(*surface, kQuantile * sigma, count > 4 ? std::atoi(words[4]) : 100000);

  std::vector<double> ours, least, theirs, ratios;
  std::vector<bool> we_say, they_say, unused;
  for (int round = 0; round < (count > 5 ? std::atoi(words[5]) : 7); ++round) {
    ours.push_back(lines_a_second(lines, we_say, [&](const VolumeLine& line) {
      return rays.first(line, kQuantile) != VolumeRays::kNever;
    }));
    theirs.push_back(
        lines_a_second(lines, they_say, [&](const VolumeLine& line) { return peer.meets(line); }));
    least.push_back(lines_a_second(lines, unused, [&](const VolumeLine& line) {
      return static_cast<double>(rays.least(line).low) < kQuantile;
    }));
    ratios.push_back(ours.back() / theirs.back());
  }
  std::size_t same = 0, met = 0;
  for (std::size_t n = 0; n < lines.size(); ++n) same += we_say[n] == they_say[n], met += we_say[n];
  std::printf("first entry: %.0f lines/s; OpenVDB's HDDA and DDA: %.0f lines/s; ratio %.2f\n", median(ours),
              median(theirs), median(ratios));
  std::printf("bounds of the least k: %.0f lines/s\n", median(least));
  std::printf("%.1f %% of the lines meet the cover; both agree on %.3f %%\n",
              100 * static_cast<double>(met) / static_cast<double>(lines.size()),
              100 * static_cast<double>(same) / static_cast<double>(lines.size()));
  return 0;
}
