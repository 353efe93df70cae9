// SPDX-License-Identifier: GPL-3.0-or-later
// A face over one voxel column: what bounds k there (vertical metric). Internal to cpp/volume.
//
//   k(x, y, z) = (z - h(x, y)) / sigma(x, y),   sigma = max(sigma_s + a (1 - P(d, a)), 1 mm)
//
// h, sigma_s and a are linear on the face. On the part of the face over the column, a polygon, 1 - P lies
// between its values at the least d and a and at the largest, since it falls with neither: sigma lies between
// two linear functions. k is then between two ratios of linear functions, whose extremes over a polygon lie
// at its corners. So the corners' (h, sigma_low, sigma_high) say everything:
//
//   least k at height z:   min over corners of (z - h) / (sigma_high where z > h, sigma_low elsewhere)
//   largest:               max over corners of (z - h) / (sigma_low where z > h, sigma_high elsewhere)
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "volume/surface.h"

namespace sightbound {

// Heights are computed to better than this: coordinates below 1e6 m in doubles, faces no thinner than a
// millimetre. Bounds are widened by it, a thousandth of the smallest sigma.
inline constexpr double kHeightSlack = 1e-6;
// Distances likewise, relative and in metres.
inline constexpr double kDistanceSlack = 1e-9;

// Floor and ceiling of what fits an int; std::floor is a call on the plainest processors.
inline int floor_int(double value) {
  const int i = static_cast<int>(value);
  return i - (static_cast<double>(i) > value);
}
inline int ceil_int(double value) {
  const int i = static_cast<int>(value);
  return i + (static_cast<double>(i) < value);
}

struct OverlayCorner {
  double height = 0, sigma_low = 0, sigma_high = 0;  // metres
};

struct Overlay {
  static constexpr std::size_t kMost = 8;  // a triangle cut four times has at most 7 corners
  std::array<OverlayCorner, kMost> corners;
  std::size_t count = 0;
  double area = 0;  // in plan, m^2
};

// A face made ready for many columns.
class FaceInPlan {
 public:
  FaceInPlan(const SurfaceFace& face, const GrowthProfile& profile) : face_(face), profile_(profile) {
    const std::array<Xyz, 3>& p = face.corner;
    const double ax = p[1].x - p[0].x, ay = p[1].y - p[0].y, bx = p[2].x - p[0].x, by = p[2].y - p[0].y;
    const double area = ax * by - ay * bx;
    const double turn = area < 0 ? -1 : 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const Xyz &from = p[i], &to = p[(i + 1) % 3];
      edge_[i] = {turn * (from.y - to.y), turn * (to.x - from.x), 0};
      edge_[i].at_zero = -edge_[i].x * from.x - edge_[i].y * from.y;
    }
    const auto linear = [&](double v0, double v1, double v2) {
      Linear f;
      f.x = ((v1 - v0) * by - (v2 - v0) * ay) / area;
      f.y = ((v2 - v0) * ax - (v1 - v0) * bx) / area;
      f.low = std::min({v0, v1, v2});
      f.high = std::max({v0, v1, v2});
      f.at_corner = v0;
      return f;
    };
    height_ = linear(p[0].z, p[1].z, p[2].z);
    sampling_ = linear(face.sampling[0], face.sampling[1], face.sampling[2]);
    amplitude_ = linear(face.amplitude[0], face.amplitude[1], face.amplitude[2]);
    x0_ = std::min({p[0].x, p[1].x, p[2].x});
    x1_ = std::max({p[0].x, p[1].x, p[2].x});
    y0_ = std::min({p[0].y, p[1].y, p[2].y});
    y1_ = std::max({p[0].y, p[1].y, p[2].y});
    // The smaller singular value: no distance shrinks by more.
    const auto& g = face.to_ground;
    const double squares = g[0] * g[0] + g[1] * g[1] + g[2] * g[2] + g[3] * g[3];
    const double determinant = g[0] * g[3] - g[1] * g[2];
    const double difference = std::sqrt(std::max(squares * squares - 4 * determinant * determinant, 0.0));
    least_stretch_ = std::sqrt(std::max(squares - difference, 0.0) / 2);
  }

  double x0() const { return x0_; }
  double x1() const { return x1_; }
  double y0() const { return y0_; }
  double y1() const { return y1_; }
  double lowest() const { return height_.low; }
  double highest() const { return height_.high; }

  // For ColumnCorners.
  const Xyz& corner(std::size_t c) const { return face_.corner[c]; }
  double sampling(std::size_t c) const { return face_.sampling[c]; }
  // Is sigma linear: no error between the samples, all or nothing above the floor?
  bool is_plain() const {
    return amplitude_.high <= 0 && (sampling_.low >= kLeastSigma || sampling_.high <= kLeastSigma);
  }
  bool contains(double x, double y) const {
    for (const Edge& e : edge_) {
      if (e.at_zero + e.x * x + e.y * y < 0) return false;
    }
    return true;
  }
  OverlayCorner at(double x, double y) const {
    const double sigma = std::max(value(sampling_, x, y), kLeastSigma);
    return {value(height_, x, y), sigma, sigma};
  }
  // Area of the part over a rectangle.
  double area_over(double x0, double y0, double x1, double y1) const {
    Polygon polygon;
    return clip(x0, y0, x1, y1, polygon) ? polygon.area : 0;
  }

  // The part over the column [x0, x1] x [y0, y1], edges included; count = 0: none.
  void over(double x0, double y0, double x1, double y1, Overlay& overlay) const {
    Polygon polygon;
    if (!clip(x0, y0, x1, y1, polygon)) {
      overlay.count = 0;
      return;
    }
    overlay.count = polygon.count;
    overlay.area = polygon.area;
    double least_growth = 0, most_growth = 0;
    if (amplitude_.high > 0) growth(polygon, x0, y0, x1, y1, least_growth, most_growth);
    double least = kLargestError, largest = 0;
    bool floor = false;
    for (std::size_t i = 0; i < polygon.count; ++i) {
      OverlayCorner& corner = overlay.corners[i];
      corner.height = value(height_, polygon.x[i], polygon.y[i]);
      const double sampling = value(sampling_, polygon.x[i], polygon.y[i]);
      corner.sigma_low = corner.sigma_high = sampling;
      if (most_growth > 0) {
        const double amplitude = value(amplitude_, polygon.x[i], polygon.y[i]);
        corner.sigma_low += amplitude * least_growth;
        corner.sigma_high += amplitude * most_growth;
      }
      least = std::min(least, corner.sigma_low);
      largest = std::max(largest, corner.sigma_high);
      floor = floor || corner.sigma_high < kLeastSigma;
    }
    // The floor bends sigma: constants bound it where it counts.
    if (least < kLeastSigma) {
      for (std::size_t i = 0; i < polygon.count; ++i) {
        overlay.corners[i].sigma_low = kLeastSigma;
        if (floor) overlay.corners[i].sigma_high = std::max(largest, kLeastSigma);
      }
    }
  }

 private:
  struct Edge {
    double x = 0, y = 0, at_zero = 0;  // >= 0 inside
  };
  struct Linear {
    double x = 0, y = 0, at_corner = 0, low = 0, high = 0;
  };
  struct Polygon {
    std::array<double, Overlay::kMost> x, y;
    std::size_t count = 0;
    double area = 0;
  };

  double value(const Linear& f, double x, double y) const {
    const Xyz& p = face_.corner[0];
    return std::clamp(f.at_corner + f.x * (x - p.x) + f.y * (y - p.y), f.low, f.high);
  }

  bool clip(double x0, double y0, double x1, double y1, Polygon& polygon) const {
    if (x0_ > x1 || x1_ < x0 || y0_ > y1 || y1_ < y0) return false;
    bool within = true;
    for (const Edge& e : edge_) {
      const double from_x0 = e.x * x0, from_x1 = e.x * x1, from_y0 = e.y * y0, from_y1 = e.y * y1;
      if (e.at_zero + std::max(from_x0, from_x1) + std::max(from_y0, from_y1) < 0) return false;
      within = within && e.at_zero + std::min(from_x0, from_x1) + std::min(from_y0, from_y1) >= 0;
    }
    if (within) {
      polygon.x = {x0, x1, x1, x0};
      polygon.y = {y0, y0, y1, y1};
      polygon.count = 4;
      polygon.area = (x1 - x0) * (y1 - y0);
      return true;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      polygon.x[i] = face_.corner[i].x;
      polygon.y[i] = face_.corner[i].y;
    }
    polygon.count = 3;
    cut<true>(polygon, x0, 1);
    cut<true>(polygon, x1, -1);
    cut<false>(polygon, y0, 1);
    cut<false>(polygon, y1, -1);
    double area = 0;
    for (std::size_t i = 2; i < polygon.count; ++i) {
      area += (polygon.x[i - 1] - polygon.x[0]) * (polygon.y[i] - polygon.y[0]) -
              (polygon.x[i] - polygon.x[0]) * (polygon.y[i - 1] - polygon.y[0]);
    }
    polygon.area = std::abs(area) / 2;
    return polygon.count > 0;
  }

  // Keeps the side of the line where sign (coordinate - limit) >= 0.
  template <bool kX>
  static void cut(Polygon& polygon, double limit, double sign) {
    const Polygon from = polygon;
    std::size_t count = 0;
    const auto keep = [&](double x, double y) {
      polygon.x[count] = x;
      polygon.y[count] = y;
      ++count;
    };
    for (std::size_t i = 0; i < from.count; ++i) {
      const std::size_t j = i + 1 < from.count ? i + 1 : 0;
      const double a = sign * ((kX ? from.x[i] : from.y[i]) - limit),
                   b = sign * ((kX ? from.x[j] : from.y[j]) - limit);
      if (a >= 0) keep(from.x[i], from.y[i]);
      if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
        const double t = a / (a - b);
        const double along =
            kX ? from.y[i] + t * (from.y[j] - from.y[i]) : from.x[i] + t * (from.x[j] - from.x[i]);
        kX ? keep(limit, along) : keep(along, limit);
      }
    }
    polygon.count = count;
  }

  // Bounds of 1 - P over the polygon.
  void growth(const Polygon& polygon, double x0, double y0, double x1, double y1, double& least,
              double& most) const {
    const auto& g = face_.to_ground;
    double nearest = kLargestError * kLargestError, farthest = nearest;
    for (const Xyz& p : face_.corner) {
      const double outside_x = std::max({x0 - p.x, p.x - x1, 0.0}),
                   outside_y = std::max({y0 - p.y, p.y - y1, 0.0});
      nearest = std::min(nearest, outside_x * outside_x + outside_y * outside_y);
      double far = 0;
      for (std::size_t i = 0; i < polygon.count; ++i) {
        const double dx = polygon.x[i] - p.x, dy = polygon.y[i] - p.y;
        const double u = g[0] * dx + g[1] * dy, v = g[2] * dx + g[3] * dy;
        far = std::max(far, u * u + v * v);
      }
      farthest = std::min(farthest, far);
    }
    double amplitude_low = amplitude_.high, amplitude_high = amplitude_.low;
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const double amplitude = value(amplitude_, polygon.x[i], polygon.y[i]);
      amplitude_low = std::min(amplitude_low, amplitude);
      amplitude_high = std::max(amplitude_high, amplitude);
    }
    const double d_low = std::sqrt(nearest) * least_stretch_ * (1 - kDistanceSlack) - kDistanceSlack;
    least = d_low > 0 ? std::max(profile_(d_low, amplitude_low) * (1 - kDistanceSlack), 0.0) : 0;
    most = profile_(std::sqrt(farthest) * (1 + kDistanceSlack) + kDistanceSlack, amplitude_high) *
           (1 + kDistanceSlack);
  }

  SurfaceFace face_;
  GrowthProfile profile_;
  std::array<Edge, 3> edge_;
  Linear height_, sampling_, amplitude_;
  double x0_, x1_, y0_, y1_, least_stretch_;
};

}  // namespace sightbound
