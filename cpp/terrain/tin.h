// SPDX-License-Identifier: GPL-3.0-or-later
// A terrain as triangles, of any shape: height fields, overhangs, bridges, walls, closed bodies.
//
// Everything is metres. A vertex's place in the CRS is origin + vertex / metres_per_unit in plan (CRS units),
// origin + vertex in height (metres). The origin is whole numbers, so that coordinates of a CRS in metres
// come back to the last bit (those nearer to zero than to the origin: to the last bit of the origin). The CRS
// is projected or none (a plane in metres): cpp/io refuses degrees. A Tin that came out of clean()
// (tin_cleaning.h) or regular_tin() also has
//   - finite vertices, indices in range, every vertex used by a face, no two vertices at one place,
//   - faces with three different corners and an area, no two with the same corners,
//   - faces turned alike within each component (tin_topology.h), height fields with their normals up.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace sightbound {

struct Xyz {
  double x = 0, y = 0, z = 0;

  friend bool operator==(const Xyz&, const Xyz&) = default;
};

inline Xyz operator+(const Xyz& a, const Xyz& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Xyz operator-(const Xyz& a, const Xyz& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Xyz operator*(double s, const Xyz& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Xyz& a, const Xyz& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Xyz cross(const Xyz& a, const Xyz& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(const Xyz&);

// Indices of vertices, counterclockwise as seen from the side that the normal points to.
using Face = std::array<std::int32_t, 3>;

// A number for each vertex, or for each face; NaN where there is none.
struct TinAttribute {
  std::string name;
  std::vector<float> values;
};

struct Tin {
  Xyz origin;                  // CRS x and y, metres of height (0 in all Tins made here)
  double metres_per_unit = 1;  // of the CRS in plan
  std::vector<Xyz> vertices;   // from the origin, metres
  std::vector<Face> faces;
  std::vector<float> sigma_v;  // vertical error of each vertex, metres, NaN where unknown; or empty
  std::string crs_wkt;         // empty = a plane in metres
  std::vector<TinAttribute> vertex_attributes, face_attributes;
  std::vector<std::string> notes;  // what was assumed, converted or repaired on the way, for the report

  Xyz to_crs(const Xyz& local) const;
  Xyz from_crs(const Xyz& crs) const;
};

// Twice the face's area long, pointing to its outer (upper) side.
Xyz normal_of(const Tin&, const Face&);

struct Box3 {
  Xyz low, high;
};
// Of all vertices, from the origin. Throws InvalidInput when there are none.
Box3 bounds_of(const Tin&);

// Median length in space of the faces' edges (each face counts its three), metres; of every n-th face when
// there are more than a million. Throws InvalidInput when there are no faces.
double median_edge(const Tin&);

// Moves the origin to whole numbers near the middle of the vertices. To be called while coordinates are still
// those of the CRS (origin 0, metres_per_unit 1): `metres_per_unit` then scales the plan. Heights stay above
// 0.
void set_origin(Tin&, double metres_per_unit);

// Throws InvalidInput when there is no vertex or face, when there are more than 2^31 - 2, or when a list has
// the wrong length. `what` begins messages ("The TIN").
void check_sizes(const Tin&, const std::string& what);

}  // namespace sightbound
