// SPDX-License-Identifier: GPL-3.0-or-later
// One block of neighbouring wedges on its way outward, column by column. Internal to wedge_fan.cpp.
//
// Columns that share a node of the pyramid make a strip: when the lower horizon hides everything in it, all
// of the strip is leapt over. Leaping only saves time: what it tells of targets and terrain is bounds as
// well.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "sight/lower_horizon.h"
#include "sight/terrain_column.h"
#include "sight/upper_horizon.h"
#include "sight/wedge_fan.h"

namespace sightbound {

class WedgeMarch {
 public:
  WedgeMarch(const Scene&, const Eye&, const TargetTops&, const FanBlock&);

  void run(double reach_m, const WedgeFan::Visitor&);

 private:
  // Neighbouring columns within one node of the finest pyramid, nearest first.
  struct Strip {
    static constexpr int kMost = 1 << MaxPyramid::kFinest;
    int count = 0;
    std::array<ColumnPlace, kMost + 1> places;  // and the column after them

    std::span<const ColumnPlace> columns() const { return {places.data(), static_cast<std::size_t>(count)}; }
    const ColumnPlace& first() const { return places[0]; }
    const ColumnPlace& last() const { return places[static_cast<std::size_t>(count - 1)]; }
    const ColumnPlace& after() const { return places[static_cast<std::size_t>(count)]; }
  };
  // Of its terrain, neighbouring columns included: at most.
  struct StripBounds {
    float height, sigma;
  };

  bool take_strip(int major, Strip&) const;
  void step(const ColumnPlace& here, const ColumnPlace& next, const WedgeFan::Visitor&);
  bool leap(const Strip&, const WedgeFan::Visitor&);
  bool bound(const Strip&, StripBounds&) const;
  bool is_thin(const ColumnPlace&) const;
  void targets(const TerrainColumn&, const WedgeFan::Visitor&);
  FanColumn column_at(const ColumnPlace&, const RowRange&) const;
  void move_on();
  void split(double step);
  void raise(const TerrainColumn& near, const TerrainColumn& here);
  void raise_all(const TerrainColumn& near, const TerrainColumn& here);

  const Scene& scene_;
  const TargetTops& tops_;
  FanColumns columns_;
  float eye_above_, height_pad_;
  ColumnLoader loader_;
  LowerHorizon below_;
  UpperHorizon above_;
  TerrainColumn before_, near_, here_;  // the last two columns, the one being judged
  std::vector<float> cells_;            // scratch
  std::vector<std::int32_t> states_;
};

}  // namespace sightbound
