// SPDX-License-Identifier: GPL-3.0-or-later
// The terrain at a place of a sight line, from the samples around it. Private to the sight lines.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "error_model/error_field.h"

namespace sightbound {

// The floor of values that fit an int; std::floor is a call on the plainest processors.
inline int whole(double value) {
  const int i = static_cast<int>(value);
  return i - (static_cast<double>(i) > value);
}

// Samples of this weight or less make no hole: a line through a sample passes it by rounding.
inline constexpr double kSliver = 1e-4;

// The terrain at a place: up to three samples with weights. Those of weight 0 do not count, NaN or not: in
// their stead a sample that does is named.
struct Stencil {
  std::array<std::ptrdiff_t, 3> sample{};
  std::array<double, 3> weight{};

  // A share f of the way from a to b.
  static Stencil edge(std::ptrdiff_t a, std::ptrdiff_t b, double f) {
    if (f == 0) b = a;
    if (f == 1) a = b;
    return {{a, b, b}, {1 - f, f, 0}};
  }
  static Stencil triangle(const std::array<std::ptrdiff_t, 3>& samples,
                          const std::array<double, 3>& weights) {
    Stencil stencil{samples, weights};
    const std::size_t counts = weights[0] != 0 ? 0 : weights[1] != 0 ? 1 : 2;
    for (std::size_t i = 0; i < 3; ++i) {
      if (weights[i] == 0) stencil.sample[i] = samples[counts];
    }
    return stencil;
  }

  // With slivers that are NaN in `values` given to the sample that weighs most. False: a NaN weighs more than
  // that.
  bool give_up_slivers(const float* values) {
    std::size_t most = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (weight[i] > weight[most]) most = i;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (!std::isnan(values[sample[i]])) continue;
      if (weight[i] > kSliver) return false;
      sample[i] = sample[most];
    }
    return true;
  }

  double of(const float* values) const {
    return weight[0] * static_cast<double>(values[sample[0]]) +
           weight[1] * static_cast<double>(values[sample[1]]) +
           weight[2] * static_cast<double>(values[sample[2]]);
  }
  double of(const SampleField& field) const {
    return field.is_constant() ? static_cast<double>(field.constant()) : of(field.values().data());
  }
};

}  // namespace sightbound
