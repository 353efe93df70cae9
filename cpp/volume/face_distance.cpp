// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/face_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volume/column_overlay.h"

namespace sightbound {

namespace {

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

double largest_of(const std::array<double, 3>& v) { return std::max({v[0], v[1], v[2]}); }
double least_of(const std::array<double, 3>& v) { return std::min({v[0], v[1], v[2]}); }

// Half size of a box along a direction of any length.
double support(const Xyz& half, const Xyz& direction) {
  return half.x * std::abs(direction.x) + half.y * std::abs(direction.y) + half.z * std::abs(direction.z);
}

double angle_between(const Xyz& a, const Xyz& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

}  // namespace

void RatioBounds::enlarge(const RatioBounds& other) {
  low = std::min(low, other.low);
  high = std::max(high, other.high);
  ambiguous = ambiguous || other.ambiguous;
}

FaceDistances::FaceDistances(const TinSurface& surface)
    : faces_(surface.face_count()), profile_(surface.profile()) {
  const Tin& tin = surface.tin();
  const TinTopology& topology = surface.topology();
  std::vector<Xyz> at_vertex(tin.vertices.size());
  std::vector<bool> border(tin.vertices.size(), false);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    Ready& ready = faces_[f];
    const SurfaceFace face = *surface.face(f);
    ready.corner = face.corner;
    ready.sampling = face.sampling;
    ready.amplitude = face.amplitude;
    const Xyz normal = cross(face.corner[1] - face.corner[0], face.corner[2] - face.corner[0]);
    ready.normal = (1 / length(normal)) * normal;
    ready.middle = (1.0 / 3) * (face.corner[0] + face.corner[1] + face.corner[2]);
    for (const Xyz& corner : face.corner)
      ready.radius = std::max(ready.radius, norm(corner - ready.middle) + kHeightSlack);
    for (std::size_t i = 0; i < 3; ++i) {
      const Xyz edge = face.corner[(i + 1) % 3] - face.corner[i];
      ready.length[i] = length(edge);
      ready.along[i] = (1 / ready.length[i]) * edge;
      ready.outward[i] = cross(ready.along[i], ready.normal);
      at_vertex[index(tin.faces[f][i])] =
          at_vertex[index(tin.faces[f][i])] +
          angle_between(edge, face.corner[(i + 2) % 3] - face.corner[i]) * ready.normal;
    }
    // The gradient of a linear function on the face: each corner counts against the edge opposite to it.
    const auto rate = [&](const std::array<double, 3>& at) {
      Xyz gradient;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t opposite = (i + 1) % 3;
        const double height = std::abs(dot(face.corner[i] - face.corner[opposite], ready.outward[opposite]));
        gradient = gradient - (at[i] / height) * ready.outward[opposite];
      }
      return length(gradient);
    };
    ready.sampling_rate = rate(face.sampling);
    ready.amplitude_rate = rate(face.amplitude);
    ready.amplitude_low = least_of(face.amplitude);
    ready.amplitude_high = largest_of(face.amplitude);
    const double between =
        ready.amplitude_high > 0
            ? ready.amplitude_high * profile_(largest_of(ready.length), ready.amplitude_high)
            : 0;
    ready.largest_sigma = std::max(largest_of(face.sampling) + between, kLeastSigma);
  }
  const auto has_sides = [&](std::size_t f) {
    return topology.components[index(topology.component[f])].orientable;
  };
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t beyond = topology.neighbours[f][i];
      if (beyond >= 0 && has_sides(f)) {
        faces_[f].edge_normal[i] = faces_[f].normal + faces_[index(beyond)].normal;
      } else {
        border[index(tin.faces[f][i])] = border[index(tin.faces[f][(i + 1) % 3])] = true;
      }
    }
  }
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t v = index(tin.faces[f][i]);
      if (!border[v]) faces_[f].corner_normal[i] = at_vertex[v];
    }
  }
}

FaceDistances::Projected FaceDistances::project(const Ready& face, const BoxOf& box) const {
  Projected p;
  p.height = dot(box.centre - face.corner[0], face.normal);
  p.reach = support(box.half, face.normal);
  // The half diagonals (+-hx, +-hy, +-hz) less their part along the normal: the shortest part along it leaves
  // the longest rest.
  const Xyz part{box.half.x * face.normal.x, box.half.y * face.normal.y, box.half.z * face.normal.z};
  const double least = std::min({std::abs(part.x + part.y + part.z), std::abs(part.x + part.y - part.z),
                                 std::abs(part.x - part.y + part.z), std::abs(part.x - part.y - part.z)});
  p.radius = std::sqrt(std::max(dot(box.half, box.half) - least * least, 0.0));
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Xyz from = box.centre - face.corner[i];
    p.out[i] = dot(from, face.outward[i]);
    p.along[i] = dot(from, face.along[i]);
    inside = inside && p.out[i] <= 0;
  }
  p.closest = inside ? box.centre - p.height * face.normal : closest_on(face.corner, box.centre);
  p.aside = inside ? 0 : norm(p.closest - (box.centre - p.height * face.normal));
  return p;
}

FaceDistances::Distance FaceDistances::distance(std::size_t number, const BoxOf& box) const {
  const Ready& face = faces_[number];
  const Projected p = project(face, box);
  const double off = std::abs(p.height);
  const double whole = std::sqrt(off * off + p.aside * p.aside), half = box.radius;
  const double above = std::max(off - p.reach, 0.0), beside = std::max(p.aside - p.radius, 0.0);
  Distance d;
  d.nearest = std::max({whole - half, std::sqrt(above * above + beside * beside), 0.0});
  const bool covered = largest_of(p.out) <= -p.radius;
  const double aside = covered ? 0 : p.aside + p.radius;
  d.furthest = std::min(whole + half, std::sqrt((off + p.reach) * (off + p.reach) + aside * aside));
  return d;
}

RatioBounds FaceDistances::bounds(std::size_t number, const BoxOf& box, double furthest) const {
  const Ready& face = faces_[number];
  const Projected p = project(face, box);
  const double slack = kHeightSlack;

  // sigma near the nearest place.
  const std::array<double, 3> weight = [&] {
    std::array<double, 3> w;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t opposite = (i + 1) % 3;
      w[i] = dot(p.closest - face.corner[opposite], face.outward[opposite]) /
             dot(face.corner[i] - face.corner[opposite], face.outward[opposite]);
    }
    return w;
  }();
  const auto at_closest = [&](const std::array<double, 3>& v) {
    return weight[0] * v[0] + weight[1] * v[1] + weight[2] * v[2];
  };
  const double sampling = at_closest(face.sampling), spread = face.sampling_rate * p.radius;
  double sigma_low = std::max(sampling - spread, least_of(face.sampling));
  double sigma_high = std::min(sampling + spread, largest_of(face.sampling));
  if (face.amplitude_high > 0) {
    double d = std::numeric_limits<double>::infinity();
    for (const Xyz& corner : face.corner) d = std::min(d, norm(p.closest - corner));
    const double amplitude = at_closest(face.amplitude), change = face.amplitude_rate * p.radius;
    const double amplitude_low = std::max(amplitude - change, face.amplitude_low);
    const double amplitude_high = std::min(amplitude + change, face.amplitude_high);
    const double d_low = std::max(d - p.radius, 0.0) * (1 - kDistanceSlack) - kDistanceSlack;
    if (d_low > 0) sigma_low += amplitude_low * profile_(d_low, amplitude_low) * (1 - kDistanceSlack);
    sigma_high += amplitude_high *
                  profile_((d + p.radius) * (1 + kDistanceSlack) + kDistanceSlack, amplitude_high) *
                  (1 + kDistanceSlack);
  }
  sigma_low = std::max(sigma_low * (1 - kDistanceSlack), kLeastSigma);
  sigma_high = std::max(sigma_high * (1 + kDistanceSlack), kLeastSigma);

  // Which parts may be nearest, and on which side of them the box's places lie.
  bool above = false, below = false, ambiguous = false;
  double top = 0, bottom = 0;  // largest distances above and below, >= 0
  const auto part = [&](const Xyz& normal, const Xyz& place, bool is_plane) {
    if (normal == Xyz{}) {
      above = below = ambiguous = true;
      top = bottom = furthest;
      return;
    }
    const double middle = dot(normal, box.centre - place),
                 reach = support(box.half, normal) + slack * norm(normal);
    if (middle + reach >= 0) {
      above = true;
      top = std::max(top, is_plane ? std::min(middle + reach, furthest) : furthest);
    }
    if (middle - reach <= 0) {
      below = true;
      bottom = std::max(bottom, is_plane ? std::min(reach - middle, furthest) : furthest);
    }
  };
  const double rho = p.radius + slack;
  if (p.aside <= rho) part(face.normal, face.corner[0], true);
  for (std::size_t i = 0; i < 3; ++i) {
    if (p.out[i] >= -rho && p.along[i] >= -rho && p.along[i] <= face.length[i] + rho)
      part(face.edge_normal[i], face.corner[i], false);
    const std::size_t before = (i + 2) % 3;
    if (p.along[i] <= rho && p.along[before] >= face.length[before] - rho)
      part(face.corner_normal[i], face.corner[i], false);
  }

  const double off = std::abs(p.height), whole = std::sqrt(off * off + p.aside * p.aside);
  const double beside = std::max(p.aside - p.radius, 0.0), clear = std::max(off - p.reach, 0.0);
  const double nearest =
      std::max({whole - box.radius, std::sqrt(clear * clear + beside * beside), 0.0}) - slack;
  const double near = std::max(nearest, 0.0);
  RatioBounds k{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), ambiguous};
  if (above) k.enlarge({near / sigma_high, std::max(top + slack, near) / sigma_low, false});
  if (below) k.enlarge({-std::max(bottom + slack, near) / sigma_low, -near / sigma_high, false});
  return k;
}

int FaceDistances::side(std::size_t number, const Xyz& place) const {
  const Ready& face = faces_[number];
  const Projected p = project(face, {place, {}, 0});
  Xyz normal = face.normal;
  Xyz foot = face.corner[0];
  constexpr double kSame = 1e-9;  // metres
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(dot(p.closest - face.corner[i], face.outward[i])) <= kSame) {
      normal = face.edge_normal[i];
      foot = face.corner[i];
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (length(p.closest - face.corner[i]) <= kSame) {
      normal = face.corner_normal[i];
      foot = face.corner[i];
    }
  }
  const double height = dot(normal, place - foot);
  return height > 0 ? 1 : height < 0 ? -1 : 0;
}

}  // namespace sightbound
