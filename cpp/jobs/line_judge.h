// SPDX-License-Identifier: GPL-3.0-or-later
// Judges lines of sight over loaded terrain: what the jobs of single lines and of networks have in common.
// Internal to jobs.
#pragma once

#include <string>

#include "error_model/posterior.h"
#include "jobs/line_of_sight_job.h"
#include "jobs/loaded_terrain.h"
#include "jobs/observer_place.h"
#include "sight/probable_line.h"
#include "sight/sight_line.h"

namespace sightbound {

// What must be in memory for lines that cross `lines`.
Window window_for(const Window& lines, const LineExtras&, const DemSource&);

struct LineEnd {
  GridPlace place;
  double height = 0;  // metres, above ground or absolute
};

class LineJudge {
 public:
  LineJudge(const DemSource&, const LoadedTerrain&, const ViewshedOptions&, const LineExtras&, const Workers&,
            Progress&);
  LineJudge(const LineJudge&) = delete;
  LineJudge& operator=(const LineJudge&) = delete;

  // Is there a height for terrain and ground in that place?
  bool has_ground(const GridPlace&) const;
  // A line between places that have one. The eye's frame is the observer's. Without `described` profile,
  // required heights and the places of the whole line stay empty. May run on any thread.
  LineOfSight judge(const LineEnd& observer, const LineEnd& target, const ObserverFrame&,
                    const ObserverFrames*, bool described) const;

  // Bytes beyond the terrain's.
  static std::size_t memory(const Window&, const LineExtras&);

 private:
  double at(const Grid<float>&, const GridPlace&) const;
  double sampling(const GridPlace&) const;
  WholeLine whole_line(const Eye&, const Target&, const LineOfSight&, const GridPlace& base,
                       bool described) const;

  const DemSource& source_;
  const LoadedTerrain& terrain_;
  const ViewshedOptions& options_;
  const LineExtras& extras_;
  Posterior posterior_;
  OpenTerrain open_;
  const RealisedColumns columns_, rows_;
};

}  // namespace sightbound
