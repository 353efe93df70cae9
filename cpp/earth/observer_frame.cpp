// SPDX-License-Identifier: GPL-3.0-or-later
// Method. At Chebyshev points of the reach the exact azimuthal equidistant position of the raster place is
// taken from GeographicLib (distance, azimuth) together with D^2 / 2R at the geodesic's midpoint; polynomials
// in the offset from the observer are fitted by least squares (Eigen), their degree raised until independent
// check points agree. Notation: x, y = offsets in columns and rows over scale_; xi in (0, 1) along a path; E,
// N = east, north.
#include "earth/observer_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <Eigen/Dense>
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/GeodesicLine.hpp>

#include "base/error.h"

namespace sightbound {

namespace {

constexpr double kMeanRadius_m = 6371008.8;  // IUGG mean radius, for planes without a CRS
constexpr double kRadian = std::numbers::pi / 180;
constexpr std::array kDegrees{2, 3, 4, 5, 6, 7, 8, 10, 12};
constexpr std::array kTerms{0, 2, 3, 4, 6, 8};
constexpr double kWantedCells =
    1e-6;  // error aimed at; k moves by less than 1e-5 for it on any terrain that is not a wall
constexpr double kWantedBulge_m = 1e-6;
constexpr double kLargestBulgeError_m = 1e-3;

struct Sample {
  double x, y;  // raster offset from the observer
  FramePlace place;
};

std::vector<double> chebyshev(double low, double high, int count) {
  std::vector<double> points;
  for (int i = 0; i < count; ++i) {
    const double c = -std::cos(std::numbers::pi * i / (count - 1));  // both ends belong to them
    points.push_back((low + high) / 2 + (high - low) / 2 * c);
  }
  return points;
}

FramePlace on_plane(const Georeference& georeference, double col, double row, double x, double y) {
  const Xy from = georeference.geotransform().of_sample(col, row);
  const Xy to = georeference.geotransform().of_sample(col + x, row + y);
  const double east = to.x - from.x, north = to.y - from.y;
  return {east, north, (east * east + north * north) / (2 * kMeanRadius_m)};
}

class Ground {
 public:
  Ground(const Georeference& georeference, double col, double row)
      : georeference_(georeference),
        col_(col),
        row_(row),
        geodesic_(georeference.ellipsoid().semi_major_m, georeference.ellipsoid().flattening) {
    if (!georeference.is_plane()) observer_ = georeference.lon_lat(col, row);
  }

  std::vector<Sample> at(const std::vector<double>& xs, const std::vector<double>& ys) const {
    std::vector<Sample> samples;
    std::vector<double> lons, lats;
    for (const double y : ys) {
      for (const double x : xs) {
        samples.push_back({x, y, {}});
        lons.push_back(col_ + x);
        lats.push_back(row_ + y);
      }
    }
    if (!georeference_.is_plane()) georeference_.lon_lat(lons, lats);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].place = georeference_.is_plane()
                             ? on_plane(georeference_, col_, row_, samples[i].x, samples[i].y)
                             : from_observer({lons[i], lats[i]});
    }
    std::erase_if(samples, [](const Sample& s) {
      return !std::isfinite(s.place.east + s.place.north + s.place.bulge);
    });
    return samples;
  }

 private:
  FramePlace from_observer(const LonLat& to) const {
    const auto& e = georeference_.ellipsoid();
    const auto line = geodesic_.InverseLine(observer_.lat, observer_.lon, to.lat, to.lon);
    const double distance = line.Distance(), azimuth = line.Azimuth() * kRadian;
    double lat, lon, azimuth_mid;
    line.Position(distance / 2, lat, lon, azimuth_mid);
    // Euler: the curvature of the normal section at the midpoint in the line's direction.
    const double e2 = e.flattening * (2 - e.flattening);
    const double s = std::sin(lat * kRadian), w = 1 - e2 * s * s;
    const double n = e.semi_major_m / std::sqrt(w), m = n * (1 - e2) / w;
    const double c = std::cos(azimuth_mid * kRadian), curvature = c * c / m + (1 - c * c) / n;
    return {distance * std::sin(azimuth), distance * std::cos(azimuth), distance * distance * curvature / 2};
  }

  const Georeference& georeference_;
  double col_, row_;
  GeographicLib::Geodesic geodesic_;
  LonLat observer_;
};

std::string too_large(const std::string& why) {
  return "The reach of the observer is too large for this DEM's coordinate system (" + why +
         "). Set a smaller maximum distance, or reproject the DEM to a projected CRS that suits the area.";
}

}  // namespace

double FramePlace::distance() const { return std::sqrt(east * east + north * north); }

double FramePlace::azimuth_deg() const {
  const double a = std::atan2(east, north) / kRadian;
  return a < 0 ? a + 360 : a;
}

double GeodesicPath::minor_slope(double xi) const {
  double value = 0, slope = 0;
  for (int i = bow_.terms - 1; i >= 0; --i) {
    slope = slope * xi + value;
    value = value * xi + bow_.c[static_cast<std::size_t>(i)];
  }
  return minor_span_ + (1 - 2 * xi) * value + xi * (1 - xi) * slope;
}

double GeodesicPath::bow_bound() const {
  // d2/dxi2 of xi^(i+1) - xi^(i+2) is at most (i + 1) i + (i + 2)(i + 1) in size on [0, 1].
  double bound = 0;
  for (int i = 0; i < bow_.terms; ++i)
    bound += std::abs(bow_.c[static_cast<std::size_t>(i)]) * 2 * (i + 1) * (i + 1);
  return bound;
}

ObserverFrame::ObserverFrame(const Georeference& georeference, double col, double row, const Window& reach)
    : col_(col), row_(row) {
  fit(georeference, reach);
  choose_terms(reach);
}

void ObserverFrame::fit(const Georeference& georeference, const Window& reach) {
  const Ground ground(georeference, col_, row_);
  const double left = reach.col - col_, right = reach.col_end() - 1 - col_;
  const double top = reach.row - row_, bottom = reach.row_end() - 1 - row_;
  scale_ = std::max({std::abs(left), std::abs(right), std::abs(top), std::abs(bottom), 1.0});

  // Check points: between the fitted ones, on the reach itself, its corners included.
  const std::vector<Sample> checks = ground.at(chebyshev(left, right, 11), chebyshev(top, bottom, 11));
  if (checks.size() < 121) throw InvalidInput(too_large("parts of it are not on the Earth"));
  const auto near = ground.at({-0.5, 0.5}, {-0.5, 0.5});
  if (near.size() < 4) throw InvalidInput(too_large("the observer's surroundings are not on the Earth"));
  double cell = 1e300;
  for (std::size_t i : {0u, 3u}) {
    for (std::size_t j : {1u, 2u}) {
      cell = std::min(cell, std::hypot(near[i].place.east - near[j].place.east,
                                       near[i].place.north - near[j].place.north));
    }
  }
  if (!(cell > 0)) throw InvalidInput(too_large("its cells have no size on the ground"));

  // Rays at the rim of the fan leave the reach a little, so the fit does too.
  const double margin = scale_ / 16 + 2;
  double best = 1e300;
  for (const int degree : kDegrees) {
    const std::vector<Sample> samples = ground.at(chebyshev(left - margin, right + margin, degree + 4),
                                                  chebyshev(top - margin, bottom + margin, degree + 4));
    const auto width = static_cast<std::size_t>(degree + 1);
    std::vector<std::pair<int, int>> powers;
    for (int i = 0; i <= degree; ++i) {
      for (int j = i == 0 ? 1 : 0; i + j <= degree; ++j) powers.emplace_back(i, j);
    }
    if (samples.size() < powers.size()) throw InvalidInput(too_large("parts of it are not on the Earth"));
    Eigen::MatrixXd a(samples.size(), powers.size()), b(samples.size(), 3);
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const auto at = static_cast<Eigen::Index>(s);
      for (std::size_t p = 0; p < powers.size(); ++p) {
        a(at, static_cast<Eigen::Index>(p)) = std::pow(samples[s].x / scale_, powers[p].first) *
                                              std::pow(samples[s].y / scale_, powers[p].second);
      }
      b.row(at) << samples[s].place.east, samples[s].place.north, samples[s].place.bulge;
    }
    const Eigen::MatrixXd c = a.householderQr().solve(b);

    const ObserverFrame before = *this;
    degree_ = degree;
    east_.assign(width * width, 0);
    north_.assign(width * width, 0);
    bulge_.assign(width * width, 0);
    for (std::size_t p = 0; p < powers.size(); ++p) {
      const auto at =
          static_cast<std::size_t>(powers[p].first) * width + static_cast<std::size_t>(powers[p].second);
      east_[at] = c(static_cast<Eigen::Index>(p), 0);
      north_[at] = c(static_cast<Eigen::Index>(p), 1);
      bulge_[at] = c(static_cast<Eigen::Index>(p), 2);
    }
    double cells = 0, bulge = 0;
    for (const Sample& s : checks) {
      const FramePlace fitted = at(col_ + s.x, row_ + s.y);
      cells = std::max(cells, std::hypot(fitted.east - s.place.east, fitted.north - s.place.north) / cell);
      bulge = std::max(bulge, std::abs(fitted.bulge - s.place.bulge));
    }
    const double error = std::max(cells / kFrameTolerance, bulge / kLargestBulgeError_m);
    if (error < best) {
      best = error;
      error_cells_ = cells;
    } else {
      *this = before;
    }
    if (cells <= kWantedCells && bulge <= kWantedBulge_m) break;
  }
  if (!(best <= 1)) throw InvalidInput(too_large("distances over it vary too much"));
}

FramePlace ObserverFrame::at(double col, double row) const {
  const double x = (col - col_) / scale_, y = (row - row_) / scale_;
  const auto width = static_cast<std::size_t>(degree_ + 1);
  FramePlace place;
  for (int i = degree_; i >= 0; --i) {
    const std::size_t at = static_cast<std::size_t>(i) * width;
    double e = 0, n = 0, b = 0;
    for (int j = degree_ - i; j >= 0; --j) {
      const std::size_t k = at + static_cast<std::size_t>(j);
      e = e * y + east_[k];
      n = n * y + north_[k];
      b = b * y + bulge_[k];
    }
    place.east = place.east * x + e;
    place.north = place.north * x + n;
    place.bulge = place.bulge * x + b;
  }
  return place;
}

ObserverFrame::Jet ObserverFrame::jet(double major, double minor, bool transposed) const {
  const double x = ((transposed ? minor : major) - col_) / scale_,
               y = ((transposed ? major : minor) - row_) / scale_;
  const auto width = static_cast<std::size_t>(degree_ + 1);
  double e = 0, n = 0, ex = 0, nx = 0, ey = 0, ny = 0;
  for (int i = degree_; i >= 0; --i) {
    const std::size_t at = static_cast<std::size_t>(i) * width;
    double re = 0, rn = 0, rey = 0, rny = 0;
    for (int j = degree_ - i; j >= 0; --j) {
      const std::size_t k = at + static_cast<std::size_t>(j);
      rey = rey * y + re;
      rny = rny * y + rn;
      re = re * y + east_[k];
      rn = rn * y + north_[k];
    }
    ex = ex * x + e;
    nx = nx * x + n;
    e = e * x + re;
    n = n * x + rn;
    ey = ey * x + rey;
    ny = ny * x + rny;
  }
  ex /= scale_, nx /= scale_, ey /= scale_, ny /= scale_;
  return transposed ? Jet{e, n, ex, nx, ey, ny} : Jet{e, n, ey, ny, ex, nx};
}

double ObserverFrame::minor_towards(double major, double guess, bool transposed, double east, double north,
                                    Jet* at) const {
  // Newton on E(minor) north - N(minor) east = 0: the place lies on the geodesic with that direction.
  constexpr double kCloseEnough =
      1e-3;  // cells; the next step would move by its square times the map's curvature (< 1e-4)
  constexpr int kMostSteps = 12;
  for (int step = 0; step < kMostSteps; ++step) {
    const Jet j = jet(major, guess, transposed);
    const double move = -(j.east * north - j.north * east) / (j.east_minor * north - j.north_minor * east);
    guess += move;
    if (std::abs(move) < kCloseEnough || !std::isfinite(move)) {
      *at = j;
      at->east += j.east_minor * move;
      at->north += j.north_minor * move;
      break;
    }
  }
  return guess;
}

GeodesicPath ObserverFrame::path_to(double col, double row, bool transposed) const {
  GeodesicPath path;
  const double major0 = transposed ? row_ : col_, major = transposed ? row : col;
  path.minor0_ = transposed ? col_ : row_;
  path.minor_span_ = (transposed ? col : row) - path.minor0_;
  if (terms_ == 0) return path;
  const FramePlace target = at(col, row);
  const double distance = target.distance(), east = target.east / distance, north = target.north / distance;
  std::array<double, kMaxPathTerms> bow{}, stretch{};
  double last = 0;  // bow / (xi (1 - xi)) hardly changes from node to node
  for (int i = 0; i < terms_; ++i) {
    const auto at_node = static_cast<std::size_t>(i);
    const double xi = nodes_[at_node], w = xi * (1 - xi);
    const double straight = path.minor0_ + xi * path.minor_span_;
    Jet j{};
    const double minor =
        minor_towards(major0 + xi * (major - major0), straight + w * last, transposed, east, north, &j);
    last = bow[at_node] = (minor - straight) / w;
    stretch[at_node] = ((j.east * east + j.north * north) / distance - xi) / w;
  }
  path.bow_ = through(bow);
  path.stretch_ = through(stretch);
  return path;
}

GeodesicRay ObserverFrame::ray(bool transposed, int sign, double slope, double reach) const {
  GeodesicRay ray;
  const double major0 = transposed ? row_ : col_;
  ray.minor0_ = transposed ? col_ : row_;
  ray.slope_ = slope;
  ray.reach_ = reach;
  const Jet origin = jet(major0, ray.minor0_, transposed);
  const double east = origin.east_major * sign + origin.east_minor * slope;
  const double north = origin.north_major * sign + origin.north_minor * slope;
  ray.metres_per_step_ = std::hypot(east, north);
  if (terms_ == 0) return ray;
  const double ue = east / ray.metres_per_step_, un = north / ray.metres_per_step_;
  std::array<double, kMaxPathTerms> bow{}, stretch{};
  double last = 0;
  for (int i = 0; i < terms_; ++i) {
    const auto at_node = static_cast<std::size_t>(i);
    const double step = nodes_[at_node] * reach, straight = ray.minor0_ + step * slope;
    Jet j{};
    const double minor =
        minor_towards(major0 + sign * step, straight + step * step * last, transposed, ue, un, &j);
    last = bow[at_node] = (minor - straight) / (step * step);
    stretch[at_node] = ((j.east * ue + j.north * un) / (ray.metres_per_step_ * step) - 1) / nodes_[at_node];
  }
  ray.bow_ = through(bow);
  ray.stretch_ = through(stretch);
  return ray;
}

void ObserverFrame::set_terms(int terms) {
  terms_ = terms;
  if (terms == 0) return;
  Eigen::MatrixXd v(terms, terms);
  for (int i = 0; i < terms; ++i) {
    const double xi = 0.5 - 0.5 * std::cos(std::numbers::pi * (2 * i + 1) / (2 * terms));
    nodes_[static_cast<std::size_t>(i)] = xi;
    for (int j = 0; j < terms; ++j) v(i, j) = std::pow(xi, j);
  }
  const Eigen::MatrixXd inverse = v.inverse();
  for (int i = 0; i < terms; ++i) {
    for (int j = 0; j < terms; ++j)
      inverse_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = inverse(i, j);
  }
}

NodePolynomial ObserverFrame::through(const std::array<double, kMaxPathTerms>& values) const {
  NodePolynomial polynomial{terms_, {}};
  const auto n = static_cast<std::size_t>(terms_);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) polynomial.c[i] += inverse_[i][j] * values[j];
  }
  return polynomial;
}

void ObserverFrame::choose_terms(const Window& reach) {
  double best = 1e300;
  int best_terms = 0;
  for (const int terms : kTerms) {
    set_terms(terms);
    const double error = interpolation_error(reach);
    if (error < best) {
      best = error;
      best_terms = terms;
    }
    if (best <= kWantedCells) break;
  }
  if (!(best <= kFrameTolerance)) throw InvalidInput(too_large("lines of sight bend too much on its grid"));
  set_terms(best_terms);
  error_cells_ = std::max(error_cells_, best);
}

double ObserverFrame::interpolation_error(const Window& reach) const {
  // Paths to the rim of the reach, held against places found directly.
  double error = 0;
  const auto cols = chebyshev(reach.col, reach.col_end() - 1, 5),
             rows = chebyshev(reach.row, reach.row_end() - 1, 5);
  for (std::size_t i = 0; i < cols.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) {
      if (i % 4 != 0 && j % 4 != 0) continue;
      const double col = cols[i], row = rows[j];
      if (std::max(std::abs(col - col_), std::abs(row - row_)) < 1) continue;
      const bool transposed = std::abs(row - row_) > std::abs(col - col_);
      const GeodesicPath path = path_to(col, row, transposed);
      const FramePlace target = at(col, row);
      const double distance = target.distance();
      const double major0 = transposed ? row_ : col_, span = (transposed ? row : col) - major0;
      for (const double xi : {0.03, 0.21, 0.5, 0.77, 0.96}) {
        Jet found{};
        const double minor = minor_towards(major0 + xi * span, path.minor(xi), transposed,
                                           target.east / distance, target.north / distance, &found);
        error = std::max(error, std::abs(minor - path.minor(xi)));
        const double share = (found.east * target.east + found.north * target.north) / (distance * distance);
        error = std::max(error, std::abs(share - path.share(xi)) * std::abs(span));
      }
    }
  }
  return error;
}

}  // namespace sightbound
