// SPDX-License-Identifier: GPL-3.0-or-later
// The corners of a face's overlays with 8 x 8 columns all at once, where sigma_g is nothing: then a corner's
// height and sigma are all that counts, and corners are shared between columns. Internal to cpp/volume.
//
// Corners of overlays are the lattice points in the face, the crossings of its edges with the lattice's
// lines, and its own corners. Lattice points, four to a column and shared by four columns, are kept apart;
// the others are handed to the columns around them. A fifth of the time of cutting the face once for each
// column.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "volume/column_overlay.h"

namespace sightbound {

// Heights and sigmas at the 9 x 9 lattice points of 8 x 8 columns: at [9 i + j]. NaN = no face there.
struct LatticePoints {
  std::array<double, 81> height, sigma;

  void clear() { height.fill(std::numeric_limits<double>::quiet_NaN()); }
  bool complete() const {
    return std::none_of(height.begin(), height.end(), [](double h) { return std::isnan(h); });
  }
};

class ColumnCorners {
 public:
  // The columns [i0, i0 + 8) x [j0, j0 + 8).
  ColumnCorners(double voxel_m, int i0, int j0, LatticePoints& lattice)
      : voxel_(voxel_m), per_voxel_(1 / voxel_m), i0_(i0), j0_(j0), lattice_(lattice) {}

  // Enters the face's lattice points and calls f(column, corner), column = 8 i + j, for its other corners;
  // also for lattice points where another face has another height (TINs with a step).
  template <class F>
  void visit(const FaceInPlan& face, F& f) const {
    lattice_points(face, f);
    std::array<Corner, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const Xyz& p = face.corner(c);
      corners[c] = {p.x * per_voxel_ - i0_, p.y * per_voxel_ - j0_, p.z, face.sampling(c)};
      vertex(corners[c], f);
    }
    for (std::size_t c = 0; c < 3; ++c) edge(corners[c], corners[(c + 1) % 3], f);
  }

  // A corner of faces: x and y in voxels from the first column.
  struct Corner {
    double x, y, height, sampling;
  };
  template <class F>
  void vertex(const Corner& c, F& f) const {
    enter(c.x, c.y, between(c, c, 0), f);
  }
  // Where an edge crosses lines of the lattice.
  template <class F>
  void edge(const Corner& a, const Corner& b, F& f) const {
    crossings(a.x, a.y, b.x, b.y,
              [&](int line, double along, double t) { enter(line, along, between(a, b, t), f); });
    crossings(a.y, a.x, b.y, b.x,
              [&](int line, double along, double t) { enter(along, line, between(a, b, t), f); });
  }

 private:
  static constexpr double kTouch = 1e-9;  // voxels

  static OverlayCorner between(const Corner& a, const Corner& b, double t) {
    const double sigma = std::max(a.sampling + t * (b.sampling - a.sampling), kLeastSigma);
    return {a.height + t * (b.height - a.height), sigma, sigma};
  }
  template <class F>
  static void hand_out(int i_first, int i_last, int j_first, int j_last, const OverlayCorner& corner, F& f) {
    for (int i = std::max(i_first, 0); i <= std::min(i_last, 7); ++i) {
      for (int j = std::max(j_first, 0); j <= std::min(j_last, 7); ++j)
        f(static_cast<std::size_t>(8 * i + j), corner);
    }
  }
  template <class F>
  void at_lattice(int i, int j, const OverlayCorner& corner, F& f) const {
    const auto n = static_cast<std::size_t>(9 * i + j);
    double& height = lattice_.height[n];
    if (std::isnan(height)) {
      height = corner.height;
      lattice_.sigma[n] = corner.sigma_low;
    } else if (std::abs(height - corner.height) > kSameHeight ||
               std::abs(lattice_.sigma[n] - corner.sigma_low) > kSameHeight * corner.sigma_low) {
      hand_out(i - 1, i, j - 1, j, corner, f);
    }
  }
  // A corner at a place, in voxels from the first column.
  template <class F>
  void enter(double x, double y, const OverlayCorner& corner, F& f) const {
    if (!(x >= -kTouch && x <= 8 + kTouch && y >= -kTouch && y <= 8 + kTouch)) return;
    const int i = static_cast<int>(x + 0.5), j = static_cast<int>(y + 0.5);  // nearest lines
    const bool on_i = std::abs(x - i) < kTouch, on_j = std::abs(y - j) < kTouch;
    if (on_i && on_j) {
      at_lattice(i, j, corner, f);
      return;
    }
    const int column_i = x < i ? i - 1 : i, column_j = y < j ? j - 1 : j;
    hand_out(on_i ? i - 1 : column_i, on_i ? i : column_i, on_j ? j - 1 : column_j, on_j ? j : column_j,
             corner, f);
  }
  // Calls f(line, where across, share of the way from a to b) for the lines 0 to 8 that the edge crosses.
  template <class F>
  static void crossings(double a, double across_a, double b, double across_b, const F& f) {
    if (a == b) return;
    const double low = std::max(std::min(a, b), 0.0), high = std::min(std::max(a, b), 8.0);
    if (low > high || std::max(across_a, across_b) < -kTouch || std::min(across_a, across_b) > 8 + kTouch)
      return;
    for (int line = ceil_int(low); line <= high; ++line) {
      const double t = (line - a) / (b - a);
      f(line, across_a + t * (across_b - across_a), t);
    }
  }

  template <class F>
  void lattice_points(const FaceInPlan& face, F& f) const {
    const auto first = [](double place) { return ceil_int(std::clamp(place - kTouch, 0.0, 9.0)); };
    const auto last = [](double place) { return floor_int(std::clamp(place + kTouch, -1.0, 8.0)); };
    const int i_first = first(face.x0() * per_voxel_ - i0_), i_last = last(face.x1() * per_voxel_ - i0_);
    const int j_first = first(face.y0() * per_voxel_ - j0_), j_last = last(face.y1() * per_voxel_ - j0_);
    for (int i = i_first; i <= i_last; ++i) {
      const double x = (i0_ + i) * voxel_;
      for (int j = j_first; j <= j_last; ++j) {
        const double y = (j0_ + j) * voxel_;
        if (!face.contains(x, y)) continue;
        at_lattice(i, j, face.at(x, y), f);
      }
    }
  }

  // Two computations of one height agree to this; half of what bounds are widened by.
  static constexpr double kSameHeight = kHeightSlack / 2;

  double voxel_, per_voxel_;
  int i0_, j0_;
  LatticePoints& lattice_;
};

}  // namespace sightbound
