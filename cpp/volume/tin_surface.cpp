// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/tin_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "terrain/tin_height_field.h"

namespace sightbound {

namespace {

Box3 box_of(const std::array<Xyz, 3>& p) {
  return {{std::min({p[0].x, p[1].x, p[2].x}), std::min({p[0].y, p[1].y, p[2].y}),
           std::min({p[0].z, p[1].z, p[2].z})},
          {std::max({p[0].x, p[1].x, p[2].x}), std::max({p[0].y, p[1].y, p[2].y}),
           std::max({p[0].z, p[1].z, p[2].z})}};
}

bool meet(const Box3& a, const Box3& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

}  // namespace

Metric TinSurface::metric_of(const Tin& tin) {
  return is_height_field(tin) ? Metric::kVertical : Metric::kNormal;
}

TinSurface::TinSurface(Tin tin, TinError error, Metric metric)
    : tin_(std::move(tin)), error_(std::move(error)) {
  check_sizes(tin_, "The TIN");
  if (error_.sampling.size() != tin_.vertices.size() ||
      (!error_.amplitude.empty() && error_.amplitude.size() != tin_.vertices.size())) {
    throw InvalidInput("The TIN's error has " + std::to_string(error_.sampling.size()) + " values for " +
                       std::to_string(tin_.vertices.size()) + " vertices.");
  }
  const Box3 box = bounds_of(tin_);
  shift_ = {box.low.x, box.low.y, -tin_.origin.z};
  bounds_ = {{0, 0, box.low.z - shift_.z}, box.high - shift_};
  const Xyz corner = tin_.to_crs({box.low.x, box.low.y, 0});
  frame_ = {corner.x, corner.y, tin_.metres_per_unit, tin_.crs_wkt};
  metric_ = metric;
  profile_ = error_.profile;
  has_between_ = !error_.amplitude.empty();
  spacing_m_ = error_.spacing_m;
  face_count_ = tin_.faces.size();
  if (metric == Metric::kNormal) {
    topology_ = topology_of(tin_);
    const auto whole = [](const TinTopology::Component& c) { return c.closed && c.orientable; };
    if (!std::all_of(topology_.components.begin(), topology_.components.end(), whole)) sides_ = Sides::kSheet;
  }
}

std::optional<SurfaceFace> TinSurface::face(std::size_t number) const {
  SurfaceFace face;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int32_t v = tin_.faces[number][i];
    face.corner[i] = vertex(v);
    face.sampling[i] = static_cast<double>(error_.sampling[static_cast<std::size_t>(v)]);
    if (has_between_) face.amplitude[i] = static_cast<double>(error_.amplitude[static_cast<std::size_t>(v)]);
  }
  return face;
}

const BoxTree& TinSurface::boxes() const {
  std::call_once(indexed_, [this] {
    boxes_ = BoxTree(face_count_, [this](std::size_t number) {
      const Face& f = tin_.faces[number];
      return box_of({vertex(f[0]), vertex(f[1]), vertex(f[2])});
    });
  });
  return boxes_;
}

void TinSurface::faces_near(const Box3& box, std::vector<std::uint32_t>& found) const {
  found.clear();
  boxes().visit([&](const Box3& node) { return meet(node, box); },
                [&](std::size_t number) {
                  const Face& f = tin_.faces[number];
                  if (meet(box_of({vertex(f[0]), vertex(f[1]), vertex(f[2])}), box)) {
                    found.push_back(static_cast<std::uint32_t>(number));
                  }
                });
  std::sort(found.begin(), found.end());
}

ClosestPlace TinSurface::closest(const Xyz& local) const {
  const auto place_on_face = [&](std::size_t number) {
    const Face& f = tin_.faces[number];
    return closest_on({vertex(f[0]), vertex(f[1]), vertex(f[2])}, local);
  };
  const BoxTree::Nearest nearest =
      boxes().nearest(local, [&](std::size_t number) { return norm(place_on_face(number) - local); });
  return {nearest.item, place_on_face(nearest.item), nearest.distance};
}

std::size_t TinSurface::bytes() const {
  return tin_.vertices.size() * (sizeof(Xyz) + 2 * sizeof(float)) +
         tin_.faces.size() *
             (sizeof(Face) + (metric_ == Metric::kNormal ? sizeof(topology_.neighbours[0]) + 4 : 0)) +
         boxes_.bytes();
}

}  // namespace sightbound
