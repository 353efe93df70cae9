// SPDX-License-Identifier: GPL-3.0-or-later
// Column by column: where the hidden layer ends, how thick it is, and the mesh over its top.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/error.h"
#include "volume/hidden_places.h"

namespace sightbound {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

struct ColumnSummary {
  int asked = 0, not_visible = 0, core = 0;  // layers
  int top = 0;                               // highest layer that is not visible; with not_visible > 0
  int lowest_visible = 0;                    // above all that is not visible; with sees
  bool sees = false;
  float least_p = 1;
};

ColumnSummary summary_of(const TargetColumn& column, const std::vector<TargetAnswer>& answers) {
  ColumnSummary out;
  for (int k = column.first; k <= column.last; ++k) {
    const TargetAnswer& answer = answers[static_cast<std::size_t>(k - column.first)];
    if (answer.verdict == kNoVerdict) continue;
    ++out.asked;
    out.least_p = std::min(out.least_p, answer.p);
    if (answer.verdict == kVisible) {
      if (!out.sees) out.lowest_visible = k;
      out.sees = true;
      continue;
    }
    ++out.not_visible;
    out.core += answer.verdict == kHidden;
    out.top = k;
    out.sees = false;
  }
  return out;
}

template <class F>
void for_each_summary(const HiddenVolume& volume, F f) {
  const TargetLattice& lattice = volume.lattice();
  std::vector<TargetAnswer> answers;
  for (int j = 0; j < lattice.ny; ++j) {
    for (int i = 0; i < lattice.nx; ++i) {
      const TargetColumn& column = lattice.column(i, j);
      answers.resize(static_cast<std::size_t>(column.size()));
      if (!answers.empty()) volume.column(i, j, answers);
      f(i, j, column, summary_of(column, answers));
    }
  }
}

// What the columns that meet at a corner of the lattice add up to.
struct Corner {
  double height = 0, p = 0, thickness = 0;
  int columns = 0;
  std::int32_t vertex = -1;
};

}  // namespace

Geotransform geotransform_of(const TargetLattice& lattice) {
  const double step = lattice.spacing_m / lattice.frame.metres_per_unit;
  const Xyz corner = lattice.frame.to_crs(
      {lattice.corner.x, lattice.corner.y + lattice.ny * lattice.spacing_m, lattice.corner.z});
  return Geotransform({corner.x, step, 0, corner.y, 0, -step});
}

HiddenRasters rasters_of(const HiddenVolume& volume) {
  const TargetLattice& lattice = volume.lattice();
  HiddenRasters out{Grid<float>(lattice.ny, lattice.nx, kNone), Grid<float>(lattice.ny, lattice.nx, kNone),
                    Grid<float>(lattice.ny, lattice.nx, kNone)};
  const double h = lattice.height_spacing_m;
  for_each_summary(volume, [&](int i, int j, const TargetColumn& column, const ColumnSummary& summary) {
    if (summary.asked == 0) return;
    const int row = lattice.ny - 1 - j;
    out.thickness.at(row, i) = static_cast<float>(summary.not_visible * h);
    out.core_thickness.at(row, i) = static_cast<float>(summary.core * h);
    if (summary.sees) {
      const double above = lattice.height_of(summary.lowest_visible) - static_cast<double>(column.ground);
      out.lowest_visible_height.at(row, i) = static_cast<float>(std::max(above, 0.0));
    }
  });
  return out;
}

Tin top_of(const HiddenVolume& volume) {
  const TargetLattice& lattice = volume.lattice();
  const auto across = static_cast<std::size_t>(lattice.nx) + 1;
  std::vector<Corner> corners(across * (static_cast<std::size_t>(lattice.ny) + 1));
  const auto corner_of = [&](int i, int j) {
    return static_cast<std::size_t>(j) * across + static_cast<std::size_t>(i);
  };
  std::vector<std::array<int, 2>> hidden;
  for_each_summary(volume, [&](int i, int j, const TargetColumn&, const ColumnSummary& summary) {
    if (summary.not_visible == 0) return;
    hidden.push_back({i, j});
    for (const auto& [di, dj] : {std::array{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      Corner& corner = corners[corner_of(i + di, j + dj)];
      corner.height += lattice.height_of(summary.top) + 0.5 * lattice.height_spacing_m;
      corner.p += static_cast<double>(summary.least_p);
      corner.thickness += summary.not_visible * lattice.height_spacing_m;
      ++corner.columns;
    }
  });
  if (hidden.empty())
    throw InvalidInput("Nothing is hidden: every target is visible, so the hidden volume has no top.");

  Tin tin;
  tin.crs_wkt = lattice.frame.crs_wkt;
  tin.vertex_attributes = {{"p", {}}, {"thickness", {}}};
  tin.faces.reserve(2 * hidden.size());
  const auto vertex = [&](int i, int j) {
    Corner& corner = corners[corner_of(i, j)];
    if (corner.vertex >= 0) return corner.vertex;
    corner.vertex = static_cast<std::int32_t>(tin.vertices.size());
    const Xyz place =
        lattice.frame.to_crs({lattice.corner.x + i * lattice.spacing_m,
                              lattice.corner.y + j * lattice.spacing_m, corner.height / corner.columns});
    tin.vertices.push_back(place);
    tin.vertex_attributes[0].values.push_back(static_cast<float>(corner.p / corner.columns));
    tin.vertex_attributes[1].values.push_back(static_cast<float>(corner.thickness / corner.columns));
    return corner.vertex;
  };
  for (const auto& [i, j] : hidden) {
    const std::int32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
    tin.faces.push_back({a, b, d});  // NW-SE, as DEMs are split
    tin.faces.push_back({b, c, d});
  }
  set_origin(tin, lattice.frame.metres_per_unit);
  check_sizes(tin, "The top of the hidden volume");
  return tin;
}

}  // namespace sightbound
