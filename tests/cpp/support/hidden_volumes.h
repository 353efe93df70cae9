// SPDX-License-Identifier: GPL-3.0-or-later
// Hidden volumes by seed, with plain maps of the same answers.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "support/says.h"
#include "volume/hidden_volume.h"

namespace sightbound::testing {

using Key = std::array<int, 3>;
using Answers = std::map<Key, TargetAnswer>;  // of targets with a verdict

// p that halves hold.
inline float exact_p(std::mt19937& random) {
  return static_cast<float>(std::uniform_int_distribution<int>(0, 512)(random)) / 512;
}

inline std::shared_ptr<TargetLattice> random_lattice(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  auto lattice = std::make_shared<TargetLattice>();
  lattice->frame = {500000.25, 5e6, seed % 2 ? 0.3048 : 1.0, ""};
  lattice->corner = {20, -40, -8};
  lattice->spacing_m = 10;
  lattice->height_spacing_m = 4;
  lattice->ceiling_m = 30;
  lattice->nx = seed == 0 ? 141 : 1 + static_cast<int>(unit(random) * 20);
  lattice->ny = seed == 1 ? 131 : 1 + static_cast<int>(unit(random) * 20);
  for (int n = 0; n < lattice->nx * lattice->ny; ++n) {
    TargetColumn column;
    if (unit(random) < 0.1) {
      column.ground = std::numeric_limits<float>::quiet_NaN();
    } else {
      column.ground = static_cast<float>(200 * unit(random) - 100);
      column.first = static_cast<int>(std::ceil((static_cast<double>(column.ground) + 8) / 4 - 0.5));
      column.last = column.first + static_cast<int>(9 * unit(random)) - 1;
    }
    lattice->columns.push_back(column);
  }
  return lattice;
}

// Answers with uniform parts, holes and runs; `seed` differs from the lattice's.
inline Answers random_answers(const TargetLattice& lattice, unsigned seed) {
  std::mt19937 random(seed + 1000);
  std::uniform_real_distribution<double> unit(0, 1);
  Answers answers;
  for (int j = 0; j < lattice.ny; ++j) {
    for (int i = 0; i < lattice.nx; ++i) {
      const TargetColumn& column = lattice.column(i, j);
      const bool plain = unit(random) < 0.6;
      for (int k = column.first; k <= column.last; ++k) {
        if (unit(random) < 0.05) continue;
        const auto verdict =
            static_cast<std::uint8_t>(plain ? (k > column.first + 2 ? kVisible : kHidden)
                                            : std::uniform_int_distribution<int>(0, 2)(random));
        answers[{i, j, k}] = {plain ? verdict / 2.0f : exact_p(random), verdict};
      }
    }
  }
  return answers;
}

inline HiddenVolume volume_of(const std::shared_ptr<const TargetLattice>& lattice, const Answers& answers,
                              int threads = 1) {
  HiddenVolumeBuilder builder(lattice);
  const Workers workers(threads);
  workers.for_each(lattice->columns.size(), [&](std::size_t n) {
    const int i = static_cast<int>(n) % lattice->nx, j = static_cast<int>(n) / lattice->nx;
    const TargetColumn& column = lattice->column(i, j);
    std::vector<TargetAnswer> given(static_cast<std::size_t>(column.size()));
    for (int k = column.first; k <= column.last; ++k) {
      const auto found = answers.find({i, j, k});
      if (found != answers.end()) given[static_cast<std::size_t>(k - column.first)] = found->second;
    }
    builder.set_column(i, j, given);
  });
  HiddenVolumeInfo info;
  info.observers = {R"({"point": [1, 2, 3]})"};
  info.error_model = R"({"vertical_rmse": 1})";
  return builder.finish(info, workers);
}

}  // namespace sightbound::testing
