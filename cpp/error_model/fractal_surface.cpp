// SPDX-License-Identifier: GPL-3.0-or-later
// Method. Combinations of heights whose weights sum to 0 and that no plane changes have, on such a surface,
// the covariance (Matheron 1973, generalised covariances; up to a factor that cancels)
//
//   cov(a, b) = s sum_ij a_i b_j |p_i - q_j|^2H       s = -1 for H < 1, +1 for 1 < H < 2
//
// The gain of a guess is cov(error, guide) / var(guide), and the error left is error - gain * guide.
#include "error_model/fractal_surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sightbound {

namespace {

constexpr int kPartsOfCell = 4;         // a mean over a cell: of 4 x 4 places
constexpr double kAwayFromOne = 0.005;  // at H = 1 the covariance is of another form; it is continuous there
constexpr double kLeastExponent = 0.1, kLargestExponent = 1.9;

struct Weighted {
  double x, y, weight;
};

// A combination of heights.
class Heights {
 public:
  Heights(CellContent content, double aspect) : content_(content), aspect_(aspect) {}

  // The terrain in one place.
  void point(double x, double y, double weight) { places_.push_back({x, aspect_ * y, weight}); }
  // The value of the cell around a sample.
  void cell(double x, double y, double weight) {
    if (content_ == CellContent::kSamples) return point(x, y, weight);
    constexpr int n = kPartsOfCell;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) point(x + (i + 0.5) / n - 0.5, y + (j + 0.5) / n - 0.5, weight / (n * n));
    }
  }
  void add(const Heights& other, double factor) {
    for (const Weighted& p : other.places_) places_.push_back({p.x, p.y, factor * p.weight});
  }
  const std::vector<Weighted>& places() const { return places_; }

 private:
  CellContent content_;
  double aspect_;
  std::vector<Weighted> places_;
};

class Covariance {
 public:
  explicit Covariance(double exponent) : h_(exponent) {
    if (std::abs(h_ - 1) < kAwayFromOne) h_ = 1 + kAwayFromOne;
  }
  double operator()(const Heights& a, const Heights& b) const {
    double sum = 0;
    for (const Weighted& p : a.places()) {
      for (const Weighted& q : b.places()) {
        const double d2 = (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
        if (d2 > 0) sum += p.weight * q.weight * std::pow(d2, h_);
      }
    }
    return h_ < 1 ? -sum : sum;
  }
  double spread(const Heights& a) const { return std::sqrt(std::max((*this)(a, a), 0.0)); }
  double gain(const Heights& error, const Heights& guide) const {
    return (*this)(error, guide) / (*this)(guide, guide);
  }

 private:
  double h_;
};

// One way through the cells: along rows or along columns.
struct Axis {
  double dx, dy;
};
constexpr Axis kRow{1, 0}, kCol{0, 1};

// cell - (cell before + cell after) / 2, `step` cells away.
Heights own_residual(const Heights& empty, const Axis& axis, int step) {
  Heights e = empty;
  e.cell(0, 0, 1);
  for (const int side : {-1, 1}) e.cell(side * step * axis.dx, side * step * axis.dy, -0.5);
  return e;
}

double own_rms(const Covariance& cov, const Heights& empty, int step) {
  const double row = cov.spread(own_residual(empty, kRow, step)),
               col = cov.spread(own_residual(empty, kCol, step));
  return std::sqrt((row * row + col * col) / 2);
}

// The edge from (0, 0) along the axis: its middle about the mean of both cells.
Heights edge_error(const Heights& empty, const Axis& axis) {
  Heights e = empty;
  e.point(axis.dx / 2, axis.dy / 2, 1);
  for (const int i : {0, 1}) e.cell(i * axis.dx, i * axis.dy, -0.5);
  return e;
}

Heights edge_guide(const Heights& empty, const Axis& axis) {
  Heights g = empty;
  for (const int i : {0, 1}) g.cell(i * axis.dx, i * axis.dy, 0.5);
  for (const int i : {-1, 2}) g.cell(i * axis.dx, i * axis.dy, -0.5);
  return g;
}

// The square whose first corner is (x, y): its middle about the mean of the four, and what that mean stands
// above the eight around.
Heights centre_error(const Heights& empty, double x, double y) {
  Heights e = empty;
  e.point(x + 0.5, y + 0.5, 1);
  for (const int i : {0, 1}) {
    for (const int j : {0, 1}) e.cell(x + i, y + j, -0.25);
  }
  return e;
}

Heights centre_guide(const Heights& empty, double x, double y) {
  Heights g = empty;
  for (const int i : {0, 1}) {
    for (const int j : {0, 1}) g.cell(x + i, y + j, 0.25);
    for (const int j : {-1, 2}) {
      g.cell(x + i, y + j, -0.125);
      g.cell(x + j, y + i, -0.125);
    }
  }
  return g;
}

Heights left(Heights error, const Heights& guide, double gain) {
  error.add(guide, -gain);
  return error;
}

double plain_spread(const Covariance& cov, const Heights& empty) {
  const double row = cov.spread(edge_error(empty, kRow)), col = cov.spread(edge_error(empty, kCol));
  return std::sqrt((row * row + col * col) / 2);
}

// Middles between points.
void set_middles(const Covariance& cov, const Heights& points, FractalSurface& out) {
  const double unit = plain_spread(cov, points);
  const auto centre_left = [&](double x, double y) {
    return left(centre_error(points, x, y), centre_guide(points, x, y), out.centre.gain);
  };
  out.centre.gain = cov.gain(centre_error(points, 0, 0), centre_guide(points, 0, 0));
  out.centre.spread = cov.spread(centre_left(0, 0)) / unit;
  double share = 0;
  const auto set_edge = [&](const Axis& axis, FractalSurface::Middle& edge) {
    edge.gain = cov.gain(edge_error(points, axis), edge_guide(points, axis));
    const Heights error = left(edge_error(points, axis), edge_guide(points, axis), edge.gain);
    Heights centres = points;  // mean error of the two beside
    centres.add(centre_left(0, 0), 0.5);
    centres.add(centre_left(-axis.dy, -axis.dx), 0.5);
    const double own = cov.gain(error, centres);
    edge.spread = cov.spread(left(error, centres, own)) / unit;
    share += own / 2;
  };
  set_edge(kRow, out.row_edge);
  set_edge(kCol, out.col_edge);
  out.from_centres = share;
}

}  // namespace

FractalSurface fractal_surface(double exponent, CellContent content, double aspect) {
  const Covariance cov(std::clamp(exponent, kLeastExponent, kLargestExponent));
  const Heights points(CellContent::kSamples, aspect), cells(content, aspect);
  FractalSurface out;
  set_middles(cov, points, out);
  const double plain = plain_spread(cov, cells);
  if (content == CellContent::kSamples) {
    out.per_residual = std::exp2(-exponent);
    return out;
  }
  out.per_residual = plain / own_rms(cov, cells, 1);

  out.points = plain_spread(cov, points) / plain;
  Heights error = cells, guide = cells;
  error.point(0, 0, 1);
  error.cell(0, 0, -1);
  guide.cell(0, 0, 1);
  for (const auto& [x, y] : {Axis{1, 0}, Axis{-1, 0}, Axis{0, 1}, Axis{0, -1}}) guide.cell(x, y, -0.25);
  out.node = cov.spread(error) / plain;
  out.sample.gain = cov.gain(error, guide);
  out.sample.spread = cov.spread(left(error, guide, out.sample.gain)) / plain;
  return out;
}

double apparent_exponent(double exponent, CellContent content, int octave) {
  if (content == CellContent::kSamples) return exponent;
  const Covariance cov(std::clamp(exponent, kLeastExponent, kLargestExponent));
  const Heights cells(content, 1);
  const int step = 1 << octave;
  return std::log2(own_rms(cov, cells, 2 * step) / own_rms(cov, cells, step));
}

double twist_over_residual(double exponent, CellContent content, int octave) {
  const Covariance cov(std::clamp(exponent, kLeastExponent, kLargestExponent));
  const Heights cells(content, 1);
  const int step = 1 << octave;
  Heights twist = cells;
  for (const int i : {0, 1}) {
    for (const int j : {0, 1}) twist.cell(i * step, j * step, i == j ? 1 : -1);
  }
  return std::log2(cov.spread(twist) / own_rms(cov, cells, step));
}

double exponent_from_apparent(double apparent, CellContent content) {
  double low = kLeastExponent, high = kLargestExponent;
  if (content == CellContent::kSamples) return std::clamp(apparent, low, high);
  constexpr int kSteps = 20;  // the ratio grows with H
  for (int i = 0; i < kSteps; ++i) {
    const double middle = (low + high) / 2;
    (apparent_exponent(middle, content) < apparent ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace sightbound
