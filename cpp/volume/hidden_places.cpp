// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/hidden_places.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/number_text.h"

namespace sightbound {

namespace {

// What a column does for a thing of some height.
struct ColumnState {
  bool asked = false, hides = false, surely = false;
};

void require_height(const TargetLattice& lattice, double height_m) {
  if (height_m > 0 && height_m <= lattice.ceiling_m) return;  // false for a NaN
  throw InvalidInput("height is " + number_text(height_m, 6) + " m; allowed are more than 0 and at most " +
                     number_text(lattice.ceiling_m, 6) +
                     " m, the ceiling that the hidden volume was made with.");
}

// Looks at all columns; `f` gets (number, column, answers).
template <class F>
void for_each_column(const HiddenVolume& volume, F f) {
  const TargetLattice& lattice = volume.lattice();
  std::vector<TargetAnswer> answers;
  for (int j = 0; j < lattice.ny; ++j) {
    for (int i = 0; i < lattice.nx; ++i) {
      const TargetColumn& column = lattice.column(i, j);
      if (column.size() == 0) continue;
      answers.resize(static_cast<std::size_t>(column.size()));
      volume.column(i, j, answers);
      f(lattice.number(i, j), column, answers);
    }
  }
}

ColumnState state_of(const TargetLattice& lattice, const TargetColumn& column,
                     const std::vector<TargetAnswer>& answers, double height_m) {
  ColumnState state{false, true, true};
  const int top = lattice.top_layer(column, height_m);
  for (int k = column.first; k <= column.last && (k <= top || !state.asked); ++k) {
    const std::uint8_t verdict = answers[static_cast<std::size_t>(k - column.first)].verdict;
    if (verdict == kNoVerdict) continue;
    state.asked = true;
    state.hides = state.hides && verdict != kVisible;
    state.surely = state.surely && verdict == kHidden;
  }
  state.hides = state.hides && state.asked;
  state.surely = state.surely && state.asked;
  return state;
}

// Layers that count for a place's volume and depth.
int thickness_of(const std::vector<TargetAnswer>& answers, Hiding hiding) {
  return static_cast<int>(std::ranges::count_if(answers, [&](const TargetAnswer& answer) {
    return hiding == Hiding::kSurelyHidden ? answer.verdict == kHidden : answer.verdict < kVisible;
  }));
}

// Sums of one place while its columns are found.
struct Gathered {
  std::size_t columns = 0, layers = 0, first = 0, deepest = 0;
  int depth = -1;
  double sum_i = 0, sum_j = 0;
};

// Floods from `start` over columns with a thickness (those that hide), sets them to -1.
Gathered flood(const TargetLattice& lattice, std::size_t start, std::vector<int>& thickness,
               std::vector<std::size_t>& stack) {
  const auto nx = static_cast<std::size_t>(lattice.nx);
  Gathered place;
  place.first = start;
  const auto take = [&](std::size_t n) {
    if (thickness[n] < 0) return;
    ++place.columns;
    place.layers += static_cast<std::size_t>(thickness[n]);
    place.sum_i += static_cast<double>(n % nx) + 0.5;
    place.sum_j += static_cast<double>(n / nx) + 0.5;
    if (thickness[n] > place.depth || (thickness[n] == place.depth && n < place.deepest)) {
      place.depth = thickness[n];
      place.deepest = n;
    }
    thickness[n] = -1;
    stack.push_back(n);
  };
  take(start);
  while (!stack.empty()) {
    const std::size_t n = stack.back();
    stack.pop_back();
    if (n % nx > 0) take(n - 1);
    if (n % nx + 1 < nx) take(n + 1);
    if (n >= nx) take(n - nx);
    if (n + nx < thickness.size()) take(n + nx);
  }
  return place;
}

HiddenPlace described(const Gathered& place, const TargetLattice& lattice) {
  const auto in_crs = [&](double i, double j) {
    return lattice.frame.to_crs(
        {lattice.corner.x + i * lattice.spacing_m, lattice.corner.y + j * lattice.spacing_m, 0});
  };
  const auto columns = static_cast<double>(place.columns);
  const auto nx = static_cast<std::size_t>(lattice.nx);
  const Xyz centroid = in_crs(place.sum_i / columns, place.sum_j / columns);
  const Xyz deepest =
      in_crs(static_cast<double>(place.deepest % nx) + 0.5, static_cast<double>(place.deepest / nx) + 0.5);
  HiddenPlace out;
  out.area_m2 = columns * lattice.column_m2();
  out.volume_m3 = static_cast<double>(place.layers) * lattice.target_m3();
  out.centroid_x = centroid.x;
  out.centroid_y = centroid.y;
  out.deepest_x = deepest.x;
  out.deepest_y = deepest.y;
  out.depth_m = place.depth * lattice.height_spacing_m;
  return out;
}

}  // namespace

HiddenArea hidden_area(const HiddenVolume& volume, double height_m) {
  const TargetLattice& lattice = volume.lattice();
  require_height(lattice, height_m);
  std::size_t asked = 0, hides = 0, surely = 0;
  for_each_column(volume, [&](std::size_t, const TargetColumn& column, const auto& answers) {
    const ColumnState state = state_of(lattice, column, answers, height_m);
    asked += state.asked;
    hides += state.hides;
    surely += state.surely;
  });
  const auto m2 = [&](std::size_t n) { return static_cast<double>(n) * lattice.column_m2(); };
  return {m2(asked), m2(hides), m2(surely)};
}

std::vector<HiddenPlace> hidden_places(const HiddenVolume& volume, double height_m, Hiding hiding,
                                       std::size_t most) {
  const TargetLattice& lattice = volume.lattice();
  require_height(lattice, height_m);
  std::vector<int> thickness(lattice.columns.size(), -1);  // layers, of the columns that hide
  for_each_column(volume, [&](std::size_t n, const TargetColumn& column, const auto& answers) {
    const ColumnState state = state_of(lattice, column, answers, height_m);
    if (hiding == Hiding::kSurelyHidden ? state.surely : state.hides)
      thickness[n] = thickness_of(answers, hiding);
  });
  std::vector<Gathered> found;
  std::vector<std::size_t> stack;
  for (std::size_t n = 0; n < thickness.size(); ++n) {
    if (thickness[n] >= 0) found.push_back(flood(lattice, n, thickness, stack));
  }
  std::ranges::stable_sort(found, [](const Gathered& a, const Gathered& b) { return a.columns > b.columns; });
  std::vector<HiddenPlace> places;
  for (std::size_t n = 0; n < std::min(most, found.size()); ++n)
    places.push_back(described(found[n], lattice));
  return places;
}

}  // namespace sightbound
