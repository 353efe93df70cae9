// SPDX-License-Identifier: GPL-3.0-or-later
// Terrains that could lie behind a DEM: what each node of their surfaces is drawn from, and the heights that
// no draw leaves.
//
// Known heights are drawn from what the measurements leave open (posterior.h). Half-way between samples
// terrain rises or falls by the between-sample error of the error model: a column line has nodes at every
// half cell, and so there are twice as many column lines. Between nodes terrain is linear.
//
// Where that error was learnt from the DEM, terrain is drawn as a self-affine surface (fractal_surface.h):
// first the centres of squares about their four samples, then the middles of cell sides about their two
// samples and with their share of the two centres beside (Fournier, Fussell and Carpenter 1982). Otherwise a
// node departs from the two samples beside it, at centres those of the NW-SE diagonal, by the error that the
// model gives for that distance, each by itself.
#pragma once

#include <cstdint>
#include <vector>

#include "error_model/error_field.h"
#include "error_model/posterior.h"
#include "sight/draws.h"
#include "terrain/grid.h"

namespace sightbound {

// All draws are normal ones.
bool is_normal(const ErrorField&);
// No draw is farther from 0, in standard deviations.
inline float largest_draw(const ErrorField& error) {
  return is_normal(error) ? kLargestDraw : kLargestOfHeavyTails;
}

// What realisations are drawn from; all on one grid.
struct OpenTerrain {
  const Grid<float>& mean;        // metres, NaN = nodata
  const SampleField& spread;      // of the heights at the samples, metres (standard deviation)
  const ErrorField& error;        // between them
  std::int64_t row = 0, col = 0;  // of the grid's first sample in the whole raster
  std::uint64_t seed = 0;
  const MiddleRises* rises = nullptr;   // with error.surface: of that
  const SampleField* shared = nullptr;  // spread of errors that are correlated by error.noise
  float largest_draw = kLargestDraw;    // in standard deviations; a larger one only costs time
};

// Of a learnt error between up to four samples, those of a cell side or a square: its amplitude, and the
// factor for how they step, which the amplitude has in it.
float amplitude_between(const OpenTerrain&, int row, int col, int row1, int col1);
double factor_between(const OpenTerrain&, int row, int col, int row1, int col1);
// What departs there has these tails.
DrawnTails tails_between(const OpenTerrain&, int row, int col, int row1, int col1);
// Terrain is drawn as a surface learnt from the DEM.
inline bool is_learnt(const OpenTerrain& terrain) { return terrain.error.surface && terrain.rises; }

// Of all realisations, metres; NaN where terrain is not known.
struct HeightRange {
  float low, high;
};

// A number about `rise`.
struct Departure {
  DrawKey key, scale;
  float spread;
  DrawnTails tails;
  float rise = 0;
};

// A number about 0 that other samples near share in part; `terrain` null: none.
struct SharedDraw {
  const OpenTerrain* terrain = nullptr;
  int row = 0, col = 0;
  float spread = 0;
};

// A number about another: the height at a sample.
struct SampleDraw {
  Departure own;
  float mean;
  SharedDraw shared{};
};

// The height at a node that is no sample, given the samples a, b (c, d) around it and what was drawn of the
// centres e, f of squares.
struct NodeDraw {
  enum class Kind : std::uint8_t {
    kBetween,  // (a + b) / 2 + own
    kSide,     // (a + b) / 2 + rise + share (e + f) + own
    kCentre    // (a + b + c + d) / 4 + rise + e
  } kind;
  Departure own;
  float rise, share;
};

// A node and what it is drawn from, in the order of NodeDraw: heights, or where they are kept.
template <class Height>
struct NodeOf {
  bool is_sample = false;  // a
  NodeDraw draw{};
  Height a{}, b{}, c{}, d{}, e{}, f{};
};

// Lines of nodes are numbered by half cells: 2 n is at sample n. With `transposed` they are rows.
class RealisedColumns {
 public:
  RealisedColumns(const OpenTerrain&, bool transposed);

  SampleDraw sample(int major, int minor) const;  // numbered by samples
  // What is drawn of the centre of a square; beyond the rim too, so that sides there have two beside them.
  SampleDraw centre(int major, int minor) const;
  NodeDraw node(int major, int minor) const;
  // With its parents: sample(major, minor) by samples, centre(major, minor) by half cells; only those needed.
  template <class Sample, class Centre>
  auto node_of(int major, int minor, const Sample& sample, const Centre& centre) const;
  // Of one node or sample, in sixteen realisations.
  Lanes heights(int major, int minor, std::uint32_t first_realisation) const;
  // Of the line `major`, nodes `from` to `to` (both included).
  void ranges(int major, int from, int to, std::vector<HeightRange>&) const;

  int majors() const { return 2 * samples_major_ - 1; }
  int minors() const { return 2 * samples_minor_ - 1; }

 private:
  // A sample or node: its place on the terrain's grid, in half cells.
  struct Place {
    int row, col;
  };
  Place place(int major, int minor) const { return transposed_ ? Place{major, minor} : Place{minor, major}; }
  DrawKey key(const Place& at) const;
  DrawKey scale(const Place& at) const;
  float spread_of_model(const Place&) const;
  float spread_of_surface(const Place&) const;
  float rise(const Place&) const;
  DrawnTails tails(const Place&) const;
  HeightRange range(int major, int minor) const;
  // Of the square whose first sample that is, the two off the NW-SE diagonal are known.
  bool is_whole(int major, int minor) const;
  float most(int major, int minor) const;

  const OpenTerrain& terrain_;
  const bool transposed_;
  int samples_major_, samples_minor_;
  std::vector<double> growth_;  // of each row: along it, down from it, along the diagonal; empty where it
                                // depends on the amplitude
  double row_edge_ = 0, col_edge_ = 0, centre_ = 0;  // spreads of a learnt surface over amplitude
};

template <class Sample, class Centre>
auto RealisedColumns::node_of(int major, int minor, const Sample& sample, const Centre& centre) const {
  const int m = major / 2, n = minor / 2, m1 = (major + 1) / 2, n1 = (minor + 1) / 2;
  NodeOf<decltype(sample(m, n))> of;
  of.a = sample(m, n);
  of.is_sample = m == m1 && n == n1;
  if (of.is_sample) return of;
  of.draw = node(major, minor);
  if (of.draw.kind == NodeDraw::Kind::kCentre) {
    of.b = sample(m, n1);
    of.c = sample(m1, n);
    of.d = sample(m1, n1);
    of.e = centre(major, minor);
  } else {
    of.b = sample(m1, n1);
    if (of.draw.kind == NodeDraw::Kind::kBetween) return of;
    const int i = m == m1 ? 1 : 0, j = 1 - i;  // to the centres on either side
    of.e = centre(major - i, minor - j);
    of.f = centre(major + i, minor + j);
  }
  return of;
}

// `middle`(l) + what is drawn for each lane.
SIGHTBOUND_INLINE void draw_about(const Departure& own, std::uint32_t first, const auto& middle, Lanes& out) {
  if (own.spread == 0) {
    for (int l = 0; l < kLanes; ++l) out.v[l] = middle(l) + own.rise;
    return;
  }
  Lanes x;
  fill_normal(own.key, first, x);
  if (!own.tails.are_normal()) scale_tails(own.tails, own.scale, first, x);
  for (int l = 0; l < kLanes; ++l) out.v[l] = middle(l) + own.rise + own.spread * x.v[l];
}

// Adds what is drawn.
void add_shared(const SharedDraw&, std::uint32_t first, Lanes&);

SIGHTBOUND_INLINE void draw(const SampleDraw& sample, std::uint32_t first, Lanes& out) {
  draw_about(
      sample.own, first, [&](int) { return sample.mean; }, out);
  if (sample.shared.terrain) add_shared(sample.shared, first, out);
}

// A share `part` of the way from one drawn height to another: little departs from the line between them where
// they are level.
SIGHTBOUND_INLINE void draw_on_way(const Departure& own, const StepLaw& steps, std::uint32_t first,
                                   const Lanes& a, const Lanes& b, float part, Lanes& out) {
  const auto middle = [&](int l) { return a.v[l] + part * (b.v[l] - a.v[l]); };
  if (steps.is_even() || own.spread == 0) return draw_about(own, first, middle, out);
  const float s2 = own.spread * own.spread, room = part * (1 - part);
  Lanes x, step;
  for (int l = 0; l < kLanes; ++l) {
    const float rise = b.v[l] - a.v[l], g2 = room * rise * rise, share = g2 / (s2 + g2);
    step.v[l] = share >= 0 ? share : 1;  // unknown ground stays unknown
  }
  fill_normal(own.key, first, x);
  if (!steps.has_one_tail()) {
    const auto level = static_cast<float>(steps.level.tail),
               more = static_cast<float>(steps.step.tail) - level;
    Lanes log_e;
    fill_log_exponential(own.scale, first, log_e);
    for (int l = 0; l < kLanes; ++l)
      x.v[l] = within_largest(x.v[l] * power_scale(log_e.v[l], level + more * step.v[l]));
  } else if (!own.tails.are_normal()) {
    scale_tails(own.tails, own.scale, first, x);
  }
  const auto level = static_cast<float>(steps.level.variance),
             more = static_cast<float>(steps.step.variance) - level;
  for (int l = 0; l < kLanes; ++l)
    out.v[l] = middle(l) + own.rise + own.spread * std::sqrt(level + more * step.v[l]) * x.v[l];
}

SIGHTBOUND_INLINE void draw_between(const Departure& own, std::uint32_t first, const Lanes& a, const Lanes& b,
                                    Lanes& out) {
  draw_about(
      own, first, [&](int l) { return 0.5f * (a.v[l] + b.v[l]); }, out);
}

// The node itself; parents that its kind does not need are not looked at.
struct NodeParents {
  const Lanes &a, &b, &c, &d, &e, &f;
};
SIGHTBOUND_INLINE void draw(const NodeDraw& node, std::uint32_t first, const NodeParents& of, Lanes& out) {
  if (node.kind == NodeDraw::Kind::kBetween) {
    draw_between(node.own, first, of.a, of.b, out);
  } else if (node.kind == NodeDraw::Kind::kSide) {
    const auto middle = [&](int l) {
      return 0.5f * (of.a.v[l] + of.b.v[l]) + node.rise + node.share * (of.e.v[l] + of.f.v[l]);
    };
    draw_about(node.own, first, middle, out);
  } else {
    for (int l = 0; l < kLanes; ++l)
      out.v[l] = 0.25f * ((of.a.v[l] + of.b.v[l]) + (of.c.v[l] + of.d.v[l])) + node.rise + of.e.v[l];
  }
}

}  // namespace sightbound
