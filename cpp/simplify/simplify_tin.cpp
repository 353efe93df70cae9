// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify_tin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "simplify/tin_decimation.h"

namespace sightbound {

namespace {

constexpr std::size_t kBytesPerFace = 72, kBytesPerVertex = 160, kBytesPerEdgeQueued = 80;
constexpr double kLeastGain = 0.01;  // passes go on as long as one removes this part of the faces left
constexpr std::size_t kMostPasses = 12;

void check(const Tin& tin, const TinSimplifyOptions& options) {
  check_sizes(tin, "The TIN");
  if (!(options.outline_tolerance_m >= 0 && std::isfinite(options.outline_tolerance_m))) {
    throw InvalidInput("border_tolerance is " + number_text(options.outline_tolerance_m) +
                       "; give metres, 0 or more.");
  }
  if (!(options.break_tolerance_m >= 0 && std::isfinite(options.break_tolerance_m))) {
    throw InvalidInput("break_line_tolerance is " + number_text(options.break_tolerance_m) +
                       "; give metres, 0 or more.");
  }
  if (!options.keep.empty() && options.keep.size() != tin.vertices.size()) {
    throw InvalidInput("keep has " + std::to_string(options.keep.size()) + " values, the TIN " +
                       std::to_string(tin.vertices.size()) + " vertices; give one for each.");
  }
  if (options.target_faces < 0) {
    throw InvalidInput("target_faces is " + std::to_string(options.target_faces) +
                       "; give 0 (no target) or more.");
  }
}

bool is_enough(const TinMesh& mesh, const TinSimplifyOptions& options) {
  const auto faces = static_cast<double>(mesh.count_faces()),
             vertices = static_cast<double>(mesh.count_vertices());
  const SimplifyOptions::Bytes& bytes = options.target_bytes;
  return faces <= static_cast<double>(options.target_faces) ||
         bytes.of_vertex * vertices + bytes.of_face * faces <= bytes.most;
}

float rounded_up(double value) {
  const auto near = static_cast<float>(value);
  return near < value ? std::nextafter(near, std::numeric_limits<float>::infinity()) : near;
}

void write(const TinMesh& mesh, const Containment& containment, const Tin& original, TinSimplified& result,
           Progress& progress) {
  Tin& tin = result.tin;
  tin.origin = original.origin;
  tin.metres_per_unit = original.metres_per_unit;
  tin.crs_wkt = original.crs_wkt;
  std::vector<std::int32_t> number(original.vertices.size(), -1);
  for (std::int32_t v = 0; v < mesh.vertices(); ++v) {
    if (!mesh.has_faces(v)) continue;
    number[static_cast<std::size_t>(v)] = static_cast<std::int32_t>(tin.vertices.size());
    tin.vertices.push_back(mesh.place(v));
  }
  TinAttribute deviation{"deviation", {}};
  tin.faces.reserve(mesh.count_faces());
  for (std::int32_t f = 0; f < mesh.faces(); ++f) {
    if (f % 4096 == 0) progress.check();
    if (!mesh.alive(f)) continue;
    Face face = mesh.face(f);
    const auto off =
        containment.deviation_of(f, {mesh.place(face[0]), mesh.place(face[1]), mesh.place(face[2])});
    if (off) {
      deviation.values.push_back(rounded_up(off->metres));
      result.largest_deviation_m = std::max(result.largest_deviation_m.value_or(0), off->metres);
      result.largest_ratio = std::max(result.largest_ratio.value_or(0), off->ratio);
    }
    for (std::int32_t& v : face) v = number[static_cast<std::size_t>(v)];
    tin.faces.push_back(face);
  }
  if (!deviation.values.empty()) tin.face_attributes.push_back(std::move(deviation));
}

}  // namespace

std::size_t simplify_tin_memory(const Tin& tin) {
  return tin.faces.size() * (kBytesPerFace + 3 * kBytesPerEdgeQueued / 2) +
         tin.vertices.size() * kBytesPerVertex;
}

TinSimplified simplify_tin(const Tin& tin, Containment& containment, const TinSimplifyOptions& options,
                           Progress& progress) {
  check(tin, options);
  TinSimplified result;
  result.faces_before = tin.faces.size();
  TinMesh mesh(tin);
  const TinLineRules rules{options.outline_tolerance_m, options.break_tolerance_m, options.height_field};
  TinLines lines(mesh, options.break_lines, rules, progress);
  result.fixed_vertices = lines.not_manifold();
  for (std::size_t v = 0; v < options.keep.size(); ++v) {
    if (options.keep[v] != 0) lines.fix(static_cast<std::int32_t>(v));
  }
  progress.check();
  TinDecimation decimation(mesh, lines, containment, options.height_field);
  const auto enough = [&] { return is_enough(mesh, options); };
  double left = 1;
  for (std::size_t n = 0; n < kMostPasses && !enough(); ++n) {
    const double share = (n == 0 ? 0.7 : 0.5) * left;
    left -= share;
    const std::size_t gone = decimation.pass(enough, share, progress);
    if (static_cast<double>(gone) <= kLeastGain * static_cast<double>(mesh.count_faces())) break;
  }
  write(mesh, containment, tin, result, progress);
  return result;
}

}  // namespace sightbound
