// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of measurements are not independent: a survey strip, an orbit, a filter moves neighbouring samples
// alike. Errors d apart correlate by exp(-d / length).
//
// They are drawn as a sum of lattices of independent numbers, each three times as fine as the one before and
// linear between its nodes: any sample's error can be drawn by itself, whatever is drawn of the others.
// Shares were fitted by least squares once (any length is the same in units of itself): on the
// average of all places the correlation is met within 0.03 (0.08 for lengths of one cell), for a given pair,
// by where it lies between the nodes, within 0.16.
#pragma once

#include <vector>

#include "earth/georeference.h"

namespace sightbound {

struct CorrelatedNoise {
  // One share of the variance, the same for all samples around a node.
  struct Lattice {
    double rows, cols;  // between its nodes, samples
    double weight;      // root of its share
  };
  // `length` in metres; 0: independent.
  CorrelatedNoise() = default;
  CorrelatedNoise(double length, const CellSize&);

  bool is_independent() const { return lattices.empty(); }
  // Of errors that many samples apart.
  double correlation(double rows, double cols) const;

  std::vector<Lattice> lattices;  // from coarse to fine
  double own = 1;                 // root of what each sample has for itself

 private:
  double row_m_per_length_ = 0, col_m_per_length_ = 0;
};

}  // namespace sightbound
