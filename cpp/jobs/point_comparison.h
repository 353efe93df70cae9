// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM's terrain beside check points.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "error_model/check_points.h"
#include "jobs/check_plan.h"
#include "terrain/dem.h"
#include "terrain/tin.h"

namespace sightbound {

class PointComparison {
 public:
  // All must outlive it.
  PointComparison(const DemSource&, const Georeference&, std::span<const Xyz> points, const Workers&,
                  Progress&);

  const CheckPlan& plan() const { return plan_; }
  // The DEM at the points moved by `shift` metres, less the points. Those outside or on holes are left out.
  std::vector<ShiftPlace> for_shift(Xy shift) const;
  std::vector<CheckedPlace> places(Xy shift, const ErrorModel& completed) const;

 private:
  struct Tile {
    const Window& window;  // its heights reach this far
    const Grid<float>& heights;
  };
  // Calls f(tile, index of the point, its column and row in the DEM), tile by tile.
  using Visit = std::function<void(const Tile&, std::size_t, Xy)>;
  using Begin = std::function<void(const Tile&)>;
  void for_each(Xy shift, const Begin& begin, const Visit& visit) const;

  const DemSource& source_;
  const Georeference& georeference_;
  std::span<const Xyz> points_;
  const Workers& workers_;
  Progress& progress_;
  CheckPlan plan_;
  std::vector<Xy> in_raster_;
};

}  // namespace sightbound
