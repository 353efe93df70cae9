// SPDX-License-Identifier: GPL-3.0-or-later
// What the faces over 8 x 8 voxel columns, those of one column of leaves, say of them. Internal to
// cpp/volume.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "volume/column_corners.h"
#include "volume/column_faces.h"
#include "volume/column_overlay.h"
#include "volume/dem_corners.h"
#include "volume/surface.h"

namespace sightbound {

inline constexpr std::size_t kColumns = 64;  // of a leaf: number 8 (i & 7) + (j & 7), as in OpenVDB's leaves
// A column is known when faces cover all but this share of it (rounding, and gaps that TINs have by theirs).
inline constexpr double kUncovered = 1e-6;

// The faces over 8 x 8 columns, and what they say of them.
class LeafColumns {
 public:
  LeafColumns(const Surface& surface, const ColumnFaces& faces, const ColumnFaces::Block& block)
      : surface_(surface), faces_(faces), block_(block) {}

  // For the corners of all overlays of faces with the columns [8 i8, 8 i8 + 8) x [8 j8, 8 j8 + 8): calls
  // f(column, corner), and f(lattice) for those on lattice points where these come together.
  template <class F>
  void visit(int i8, int j8, F& f) {
    if (faces_.dem() != nullptr && !surface_.has_between()) {
      f.clear();
      if (dem_corners(*faces_.dem(), faces_.voxel_m(), 8 * i8, 8 * j8, lattice_, f)) {
        f(lattice_);
        area_.fill(faces_.voxel_m() * faces_.voxel_m());
        return;
      }
    }
    block_.near(i8, j8, numbers_);
    ready_.clear();
    bool plain = true;
    for (const std::uint32_t number : numbers_) {
      const std::optional<SurfaceFace> face = surface_.face(number);
      if (!face) continue;
      ready_.emplace_back(*face, surface_.profile());
      plain = plain && ready_.back().is_plain();
    }
    f.clear();
    if (plain && covered(i8, j8)) {
      lattice_.clear();
      const ColumnCorners corners(faces_.voxel_m(), 8 * i8, 8 * j8, lattice_);
      for (const FaceInPlan& face : ready_) corners.visit(face, f);
      if (lattice_.complete()) {
        f(lattice_);
        area_.fill(faces_.voxel_m() * faces_.voxel_m());
        return;
      }
      f.clear();
    }
    area_.fill(0);
    for (const FaceInPlan& face : ready_) cut(face, i8, j8, f);
  }

  // Of the last visit: is the column covered by faces?
  bool is_known(std::size_t column) const {
    return area_[column] >= (1 - kUncovered) * faces_.voxel_m() * faces_.voxel_m();
  }
  std::uint64_t unknown() const {
    std::uint64_t bits = 0;
    for (std::size_t c = 0; c < kColumns; ++c) bits |= std::uint64_t{!is_known(c)} << c;
    return bits;
  }

 private:
  bool covered(int i8, int j8) const {
    const double side = 8 * faces_.voxel_m();
    double area = 0;
    for (const FaceInPlan& face : ready_)
      area += face.area_over(i8 * side, j8 * side, (i8 + 1) * side, (j8 + 1) * side);
    return area >= side * side * (1 - kUncovered / kColumns);
  }

  template <class F>
  void cut(const FaceInPlan& face, int i8, int j8, F& f) {
    const double voxel = faces_.voxel_m();
    const auto first = [&](double place, int from) {  // touching columns count
      return std::clamp(static_cast<int>(std::floor(place / voxel - kDistanceSlack)) - from, 0, 8);
    };
    const auto last = [&](double place, int from) {
      return std::clamp(static_cast<int>(std::floor(place / voxel + kDistanceSlack)) - from, -1, 7);
    };
    const int i0 = first(face.x0(), 8 * i8), i1 = last(face.x1(), 8 * i8);
    const int j0 = first(face.y0(), 8 * j8), j1 = last(face.y1(), 8 * j8);
    Overlay overlay;
    for (int i = i0; i <= i1; ++i) {
      for (int j = j0; j <= j1; ++j) {
        face.over((8 * i8 + i) * voxel, (8 * j8 + j) * voxel, (8 * i8 + i + 1) * voxel,
                  (8 * j8 + j + 1) * voxel, overlay);
        const auto column = static_cast<std::size_t>(8 * i + j);
        if (overlay.count > 0) area_[column] += overlay.area;
        for (std::size_t c = 0; c < overlay.count; ++c) f(column, overlay.corners[c]);
      }
    }
  }

  const Surface& surface_;
  const ColumnFaces& faces_;
  const ColumnFaces::Block& block_;
  std::vector<std::uint32_t> numbers_;
  std::vector<FaceInPlan> ready_;
  LatticePoints lattice_;
  std::array<double, kColumns> area_{};
};

}  // namespace sightbound
