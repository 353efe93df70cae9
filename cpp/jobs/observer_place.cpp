// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/observer_place.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number_text.h"

namespace sightbound {

namespace {

constexpr double kTallest_m = 1e8;   // beyond the Moon's distance nobody stands
constexpr double kFarthest_m = 2e7;  // half way round the Earth

void require(bool right, const std::string& name, const char* field, double value, const char* allowed) {
  if (!right)
    throw InvalidInput(name + ": " + field + " is " + number_text(value) + "; it must be " + allowed + ".");
}

// In coordinates from the base sample.
Georeference from_base(const Georeference& georeference, const GridPlace& place) {
  return georeference.of_window({place.base_col, place.base_row, 1, 1});
}
Window from_base(const Window& w, const GridPlace& place) {
  return {w.col - place.base_col, w.row - place.base_row, w.cols, w.rows};
}

}  // namespace

std::string name_of(const Observer& observer, std::size_t index) {
  if (!observer.name.empty()) return "Observer '" + observer.name + "'";
  return "Observer " + std::to_string(observer.number != 0 ? observer.number : index + 1);
}

void validate(const Observer& o, const std::string& name) {
  require(std::isfinite(o.x), name, "x", o.x, "a finite number");
  require(std::isfinite(o.y), name, "y", o.y, "a finite number");
  require(std::abs(o.height) <= kTallest_m, name, "observer_height", o.height,
          "a number of metres of at most 1e8 in size");
  require(std::abs(o.target_height) <= kTallest_m, name, "target_height", o.target_height,
          "a number of metres of at most 1e8 in size");
  require(o.min_distance >= 0 && std::isfinite(o.min_distance), name, "min_distance", o.min_distance,
          "0 metres or more");
  require(o.max_distance > 0, name, "max_distance", o.max_distance, "more than 0 metres");
  require(o.min_distance <= o.max_distance, name, "min_distance", o.min_distance,
          "no larger than max_distance");
  require(std::isfinite(o.azimuth_from) && std::abs(o.azimuth_from) <= 720, name, "azimuth from",
          o.azimuth_from, "between -720 and 720 degrees");
  require(std::isfinite(o.azimuth_to) && std::abs(o.azimuth_to) <= 720, name, "azimuth to", o.azimuth_to,
          "between -720 and 720 degrees");
  require(o.angle_from >= -90 && o.angle_from <= 90, name, "vertical angle from", o.angle_from,
          "between -90 and 90 degrees");
  require(o.angle_to >= -90 && o.angle_to <= 90, name, "vertical angle to", o.angle_to,
          "between -90 and 90 degrees");
  require(o.angle_from <= o.angle_to, name, "vertical angle from", o.angle_from,
          "no larger than vertical angle to");
}

void validate(const ViewshedOptions& options) {
  two_sided_quantile(options.confidence);  // throws outside (0, 1)
  if (!(options.refraction >= -1 && options.refraction <= 1)) {
    throw InvalidInput("refraction is " + number_text(options.refraction) +
                       "; it must be between -1 and 1 (light: 0.13, radio: 0.25, none: 0).");
  }
}

GridPlace place_on(const DemSource& source, double x, double y, const std::string& name) {
  if (const std::optional<GridPlace> place = find_on(source, x, y)) return *place;
  throw InvalidInput(name + " at (" + number_text(x) + ", " + number_text(y) +
                     ") lies outside the DEM. Give its position in the DEM's coordinate system, or use a "
                     "DEM that covers it.");
}

std::optional<GridPlace> find_on(const DemSource& source, double x, double y) {
  const Xy at = source.geotransform().to_raster(x, y);
  if (!(at.x >= -0.5 && at.y >= -0.5 && at.x <= source.cols() - 0.5 && at.y <= source.rows() - 0.5))
    return {};
  // Coordinates written with a dozen digits should hit the sample they mean.
  constexpr double kSampleSnap = 1e-7;  // cells
  const auto snapped = [](double value, int count) {
    value = std::clamp(value, 0.0, count - 1.0);
    return std::abs(value - std::round(value)) < kSampleSnap ? std::round(value) : value;
  };
  const double col = snapped(at.x, source.cols()), row = snapped(at.y, source.rows());
  GridPlace place;
  place.base_col = static_cast<int>(std::floor(col));
  place.base_row = static_cast<int>(std::floor(row));
  place.col = col - place.base_col;
  place.row = row - place.base_row;
  return place;
}

Window reach_of(const DemSource& source, const Georeference& georeference, const GridPlace& place,
                double distance_m) {
  const Window all = source.window();
  if (!(distance_m < kFarthest_m)) return all;
  // Grown until the cells' own sizes put its rim beyond the distance; cells shrink towards poles and in
  // Mercator.
  const double margin = 1.1;
  const auto half = [&](double cell) {
    return static_cast<int>(std::min(std::ceil(margin * distance_m / cell) + 2, 2e9 / 4));
  };
  const auto smallest = [&](const Window& rows, bool along_row) {
    double least = 1e300;
    for (const int row : {rows.row, rows.row + rows.rows / 2, rows.row_end() - 1}) {
      // With its neighbours: a row on a pole has no size of its own.
      const Window around = intersection({0, row - 1, all.cols, 3}, all);
      const CellSize size =
          ground_cell_sizes(georeference, around)[static_cast<std::size_t>(row - around.row)];
      least = std::min(least, along_row ? size.col_m : size.row_m);
    }
    return least;
  };
  Window rows{0, place.base_row, 1, 1};
  for (int pass = 0; pass < 3; ++pass) {
    const int up = half(smallest(rows, false));
    rows = intersection({0, place.base_row - up, 1, 2 * up + 2}, {0, 0, 1, all.rows});
  }
  const int across = half(smallest(rows, true));
  return intersection({place.base_col - across, rows.row, 2 * across + 2, rows.rows}, all);
}

Window samples_within(const ObserverFrame& frame, const GridPlace& place, const Window& reach,
                      double distance_m) {
  Window w = reach;
  // Along a row (column) the distance falls to one least value and rises again: found by narrowing in on it.
  const auto least = [](int first, int last, const auto& distance) {
    while (last - first > 2) {
      const int a = first + (last - first) / 3, b = last - (last - first) / 3;
      (distance(a) < distance(b) ? last : first) = distance(a) < distance(b) ? b : a;
    }
    double nearest = distance(first);
    for (int i = first + 1; i <= last; ++i) nearest = std::min(nearest, distance(i));
    return nearest;
  };
  const auto distance = [&](int col, int row) {
    return frame.at(col - place.base_col, row - place.base_row).distance();
  };
  const auto row_is_near = [&](int row) {
    return least(w.col, w.col_end() - 1, [&](int col) { return distance(col, row); }) <= distance_m;
  };
  const auto col_is_near = [&](int col) {
    return least(w.row, w.row_end() - 1, [&](int row) { return distance(col, row); }) <= distance_m;
  };
  while (w.rows > 1 && !row_is_near(w.row)) ++w.row, --w.rows;
  while (w.rows > 1 && !row_is_near(w.row_end() - 1)) --w.rows;
  while (w.cols > 1 && !col_is_near(w.col)) ++w.col, --w.cols;
  while (w.cols > 1 && !col_is_near(w.col_end() - 1)) --w.cols;
  return w;
}

ObserverFrame frame_of(const Georeference& georeference, const GridPlace& place, const Window& reach) {
  return ObserverFrame(from_base(georeference, place), place.col, place.row, from_base(reach, place));
}

ObserverFrames frames_of(const DemSource& source, const Georeference& georeference, const GridPlace& place,
                         const Window& reach) {
  return ObserverFrames(from_base(georeference, place), place.col, place.row,
                        from_base(source.window(), place), from_base(reach, place));
}

Window lines_window(const DemSource& source, const ObserverFrame& frame, const GridPlace& place,
                    const Window& targets) {
  const Window straight = bounding(targets, {place.base_col, place.base_row, 2, 2});
  // How far lines to the rim of the targets bow, with as much again to be sure.
  double bow = 0;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) {
      if (i % 8 != 0 && j % 8 != 0) continue;
      const double col = targets.col - place.base_col + i / 8.0 * (targets.cols - 1);
      const double row = targets.row - place.base_row + j / 8.0 * (targets.rows - 1);
      const bool transposed = std::abs(row - frame.row()) > std::abs(col - frame.col());
      if (std::max(std::abs(row - frame.row()), std::abs(col - frame.col())) < 1) continue;
      const GeodesicPath path = frame.path_to(col, row, transposed);
      for (const double xi : {0.25, 0.5, 0.75}) {
        const double line = path.minor(0) + xi * (path.minor(1) - path.minor(0));
        bow = std::max(bow, std::abs(path.minor(xi) - line));
      }
    }
  }
  const int margin = 2 + static_cast<int>(std::ceil(2 * bow));
  return intersection(
      {straight.col - margin, straight.row - margin, straight.cols + 2 * margin, straight.rows + 2 * margin},
      source.window());
}

}  // namespace sightbound
