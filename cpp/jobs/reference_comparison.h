// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM's samples beside a better DEM.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/parallel.h"
#include "base/progress.h"
#include "error_model/check_points.h"
#include "error_model/variogram.h"
#include "io/crs_crossing.h"
#include "jobs/check_plan.h"
#include "terrain/dem.h"

namespace sightbound {

class ReferenceComparison {
 public:
  // All must outlive it. Throws InvalidInput when the two do not overlap.
  ReferenceComparison(const DemSource&, const Georeference&, const DemSource& reference, CellContent,
                      const Workers&, Progress&);

  const CheckPlan& plan() const { return plan_; }
  // The DEM's samples less the reference, which is looked up where they lie when moved back by `shift`
  // metres. Every so manyth sample of some tiles.
  std::vector<ShiftPlace> for_shift(Xy shift) const;

  struct Found {
    std::vector<CheckedPlace> places;
    GridVariogram near;       // of neighbours within the tiles
    double near_reach = 0;    // up to this distance, metres
    std::size_t samples = 0;  // compared, of which `places` are a part
    std::size_t missing = 0;  // of the tiles, without a height in one of the two
    std::size_t equal_level = 0;
    bool is_part = false;  // some tiles of many
  };
  Found compare(Xy shift) const;

 private:
  struct Tile {
    Window window;
    Grid<float> heights, truth;  // both with a margin of one sample inside the DEM
    Window padded;
  };
  void for_each(const std::vector<Window>& tiles, Xy shift, const std::function<void(const Tile&)>& f) const;
  Grid<float> truth_at(const Window&, Xy shift) const;
  Window overlap() const;

  const DemSource& source_;
  const DemSource& reference_;
  CrsCrossing crossing_;
  const Workers& workers_;
  Progress& progress_;
  CheckPlan plan_;
  Window overlap_;
  int side_ = 0;     // of tiles
  int divided_ = 1;  // the mean over a cell is taken of so many by so many places
  bool is_part_ = false;
  std::vector<Window> tiles_;
};

}  // namespace sightbound
