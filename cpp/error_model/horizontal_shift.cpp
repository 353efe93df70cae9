// SPDX-License-Identifier: GPL-3.0-or-later
// Notation: row of the design a = (-dz/dx, -dz/dy, 1), unknown s = (x, y, z), residual r = error - a s,
// weight w = min(1, 1.345 scale / |r|). N = sum w a a'. Variance of s: N^-1 (sum over blocks of g g') N^-1
// with g = sum w r a of the block (clustered sandwich; Cameron & Miller 2015).
#include "error_model/horizontal_shift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "error_model/residual_statistics.h"

namespace sightbound {

namespace {

constexpr std::size_t kFewestPlaces = 10;
constexpr int kMostRounds = 20, kWeightRounds = 6;
constexpr double kHuber = 1.345;
constexpr double kLeastContrast = 1e-10;  // determinant of N over the product of its diagonal

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;

Vector design(const ShiftPlace& place) { return {-place.per_x, -place.per_y, 1}; }

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector times(const Matrix& m, const Vector& v) { return {dot(m[0], v), dot(m[1], v), dot(m[2], v)}; }

// Empty when singular: nothing slopes, or all slopes look one way.
std::optional<Matrix> inverse(const Matrix& m) {
  const auto minor = [&](std::size_t i, std::size_t j) {
    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return m[a][c] * m[b][d] - m[a][d] * m[b][c];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  if (!(determinant > kLeastContrast * m[0][0] * m[1][1] * m[2][2])) return {};
  Matrix out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) out[i][j] = minor(j, i) / determinant;
  }
  return out;
}

double middle_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double nmad_of(const std::vector<ShiftPlace>& places, const Vector& s) {
  std::vector<double> residuals;
  residuals.reserve(places.size());
  for (const ShiftPlace& place : places) residuals.push_back(place.error - dot(design(place), s));
  const double median = middle_of(residuals);
  for (double& residual : residuals) residual = std::abs(residual - median);
  return kNormalOfMad * middle_of(residuals);
}

struct Solution {
  Vector s{};
  Matrix inverse_normal{};
  double scale = 0;
};

double weight(double residual, double scale) {
  const double size = std::abs(residual), limit = kHuber * scale;
  return size <= limit ? 1 : limit / size;
}

std::optional<Solution> solve(const std::vector<ShiftPlace>& places) {
  Solution out;
  out.scale = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kWeightRounds; ++round) {
    Matrix normal{};
    Vector right{};
    for (const ShiftPlace& place : places) {
      const Vector a = design(place);
      const double w = weight(place.error - dot(a, out.s), out.scale);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) normal[i][j] += w * a[i] * a[j];
        right[i] += w * a[i] * place.error;
      }
    }
    const std::optional<Matrix> solved = inverse(normal);
    if (!solved) return {};
    out.inverse_normal = *solved;
    out.s = times(*solved, right);
    out.scale = nmad_of(places, out.s);
    if (out.scale <= 0) break;
  }
  return out;
}

Vector standard_errors(const std::vector<ShiftPlace>& places, const Solution& solution) {
  std::map<int, Vector> blocks;
  for (const ShiftPlace& place : places) {
    const Vector a = design(place);
    const double r = place.error - dot(a, solution.s), wr = weight(r, solution.scale) * r;
    Vector& g = blocks[place.block];
    for (std::size_t i = 0; i < 3; ++i) g[i] += wr * a[i];
  }
  const auto count = static_cast<double>(blocks.size());
  const double few = count > 1 ? count / (count - 1) : 1;
  Vector variance{};
  for (const auto& [block, g] : blocks) {
    const Vector moved = times(solution.inverse_normal, g);
    for (std::size_t i = 0; i < 3; ++i) variance[i] += few * moved[i] * moved[i];
  }
  return {std::sqrt(variance[0]), std::sqrt(variance[1]), std::sqrt(variance[2])};
}

}  // namespace

bool HorizontalShift::is_significant() const {
  constexpr double kErrors = 3, kGain = 0.98;
  const bool beyond_chance = std::abs(x) > kErrors * se_x || std::abs(y) > kErrors * se_y;
  return beyond_chance && nmad_after < kGain * nmad_before;
}

std::optional<HorizontalShift> find_shift(const std::function<std::vector<ShiftPlace>(Xy)>& at, double cell,
                                          double farthest) {
  constexpr double kPrecision = 1e-4;  // cells
  HorizontalShift shift;
  while (shift.rounds < kMostRounds) {
    const std::vector<ShiftPlace> places = at({shift.x, shift.y});
    if (places.size() < kFewestPlaces) return {};
    const std::optional<Solution> found = solve(places);
    if (!found) return {};
    if (shift.rounds++ == 0) shift.nmad_before = nmad_of(places, {});
    const Vector& s = found->s;
    shift.z = s[2];
    shift.nmad_after = found->scale;
    const double moved = std::hypot(s[0], s[1]);
    if (moved < kPrecision * cell || shift.rounds == kMostRounds) {
      const Vector errors = standard_errors(places, *found);
      shift.se_x = errors[0], shift.se_y = errors[1], shift.se_z = errors[2];
      return shift;
    }
    shift.x += s[0];
    shift.y += s[1];
    if (!(std::hypot(shift.x, shift.y) <= farthest)) return {};
  }
  return {};
}

}  // namespace sightbound
