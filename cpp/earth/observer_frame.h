// SPDX-License-Identifier: GPL-3.0-or-later
// The ground as one observer has it: true distances and directions on the ellipsoid, in raster coordinates.
//
// A geodesic from the observer is a straight line in azimuthal equidistant coordinates (east, north) about
// him. The map from raster coordinates to (east, north) is smooth, so one polynomial, fitted once for the
// reach of a viewshed, serves degrees, Mercator, UTM and polar rasters alike. Its error at the places checked
// is below 1e-6 cell where a polynomial of degree 12 can reach that, and never above kFrameTolerance; a reach
// too large for it is refused. Cost: some hundred geodesics to make one, then about 50 ns a place.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "earth/georeference.h"
#include "terrain/grid.h"

namespace sightbound {

inline constexpr double kFrameTolerance =
    1e-2;  // cells; the straight line may stand in up to this (design, section 3)
inline constexpr int kMaxPathTerms = 8;

// A place relative to the observer, metres. `bulge` = D^2 / (2 R): how far the curved ground drops below the
// observer's horizontal there, R the ellipsoid's radius along the line at its midpoint (so it is the same
// from either end).
struct FramePlace {
  double east = 0, north = 0, bulge = 0;
  double distance() const;
  double azimuth_deg() const;  // clockwise from north, [0, 360)
};

// A polynomial through values at the frame's nodes in (0, 1).
struct NodePolynomial {
  int terms = 0;
  std::array<double, kMaxPathTerms> c{};

  // No larger value anywhere in [0, 1].
  double size() const {
    double sum = 0;
    for (int i = 0; i < terms; ++i) sum += std::abs(c[static_cast<std::size_t>(i)]);
    return sum;
  }
  double operator()(double x) const {
    double value = 0;
    for (int i = terms - 1; i >= 0; --i) value = value * x + c[static_cast<std::size_t>(i)];
    return value;
  }
};

// The geodesic from the observer (xi = 0) to a target (xi = 1) in raster coordinates. The major coordinate
// (column, or row when transposed) runs linearly with xi; the minor one bows; t is the share of the distance
// covered.
class GeodesicPath {
 public:
  double minor(double xi) const { return minor0_ + xi * minor_span_ + xi * (1 - xi) * bow_(xi); }
  double minor_slope(double xi) const;
  double share(double xi) const { return xi + xi * (1 - xi) * stretch_(xi); }
  // No larger second derivative of minor(xi) anywhere on the path.
  double bow_bound() const;
  // The minor coordinate on the straight line between the ends; the path is never farther from it than
  // largest_bow(), and share(xi) never farther from xi than largest_stretch().
  double chord(double xi) const { return minor0_ + xi * minor_span_; }
  double largest_bow() const { return bow_.size() / 4; }
  double largest_stretch() const { return stretch_.size() / 4; }
  const NodePolynomial& bow() const { return bow_; }

 private:
  friend class ObserverFrame;
  double minor0_ = 0, minor_span_ = 0;
  NodePolynomial bow_, stretch_;
};

// The geodesic that leaves the observer with a given slope (minor per major step), followed along the major
// axis.
class GeodesicRay {
 public:
  // Minor coordinate after `step` > 0 major steps.
  double minor(double step) const { return minor0_ + step * slope_ + step * step * bow_(step / reach_); }
  // Ground distance after `step` major steps, metres.
  double distance(double step) const {
    return metres_per_step_ * step * (1 + step / reach_ * stretch_(step / reach_));
  }
  double metres_per_step() const { return metres_per_step_; }  // at the observer

 private:
  friend class ObserverFrame;
  double minor0_ = 0, slope_ = 0, reach_ = 1, metres_per_step_ = 1;
  NodePolynomial bow_, stretch_;
};

class ObserverFrame {
 public:
  // `reach`: all places that will be asked for. Throws InvalidInput when it is too large for one frame, or
  // not on Earth.
  ObserverFrame(const Georeference&, double col, double row, const Window& reach);

  double col() const { return col_; }
  double row() const { return row_; }
  FramePlace at(double col, double row) const;
  bool is_straight() const { return terms_ == 0; }
  // Largest error of places and paths at the places checked, cells.
  double error_cells() const { return error_cells_; }

  // The geodesic to a place; `transposed`: rows are the major coordinate. The major span must not be 0.
  GeodesicPath path_to(double col, double row, bool transposed) const;
  // The geodesic leaving with `slope` in direction `sign` (+1, -1) of the major axis, good for `reach` major
  // steps.
  GeodesicRay ray(bool transposed, int sign, double slope, double reach) const;

 private:
  struct Jet {
    double east, north;              // value
    double east_minor, north_minor;  // derivatives by the minor coordinate
    double east_major, north_major;
  };
  void fit(const Georeference&, const Window& reach);
  void choose_terms(const Window& reach);
  double interpolation_error(const Window& reach) const;
  Jet jet(double major, double minor, bool transposed) const;
  double minor_towards(double major, double guess, bool transposed, double east, double north, Jet* at) const;
  void set_terms(int terms);
  NodePolynomial through(const std::array<double, kMaxPathTerms>& values) const;

  double col_, row_;
  double scale_ = 1;  // raster steps per unit of the polynomials' variables
  int degree_ = 1;
  std::vector<double> east_, north_, bulge_;  // coefficient of x^i y^j at i (degree + 1) + j
  int terms_ = 0;
  double error_cells_ = 0;
  std::array<double, kMaxPathTerms> nodes_{};
  std::array<std::array<double, kMaxPathTerms>, kMaxPathTerms> inverse_{};  // node values -> coefficients
};

}  // namespace sightbound
