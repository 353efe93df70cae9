// SPDX-License-Identifier: GPL-3.0-or-later
// The terrain that a simplified TIN is compared with: a TIN, or a DEM whose triangles are read off its grid.
// Places are in the simplified TIN's frame, local metres: off by 16 u of the largest of them at most (u =
// 2^-53), however far from 0 the CRS's coordinates are.
#pragma once

#include <array>
#include <cstddef>

#include "terrain/geotransform.h"
#include "terrain/grid.h"
#include "terrain/tin.h"

namespace sightbound {

class OriginalSurface {
 public:
  using Corners = std::array<std::size_t, 3>;  // numbers of vertices

  virtual ~OriginalSurface() = default;

  virtual std::size_t vertices() const = 0;
  virtual std::size_t faces() const = 0;
  virtual Xyz place(std::size_t vertex) const = 0;  // not finite where a DEM has no sample
  // False where the number is that of a hole.
  virtual bool face(std::size_t number, Corners& corners) const = 0;
};

// Keeps a reference to the Tin.
class OriginalTin final : public OriginalSurface {
 public:
  // Throws InvalidInput when the two have different units of plan.
  OriginalTin(const Tin& tin, const Tin& frame);

  std::size_t vertices() const override { return tin_.vertices.size(); }
  std::size_t faces() const override { return tin_.faces.size(); }
  Xyz place(std::size_t vertex) const override { return tin_.vertices[vertex] + shift_; }
  bool face(std::size_t number, Corners& corners) const override;

 private:
  const Tin& tin_;
  Xyz shift_;
};

// The regular TIN of dem.h. Vertex row * cols + col; squares have two numbers each, triangles with a nodata
// corner are holes.
class OriginalDem final : public OriginalSurface {
 public:
  // Heights in the core's row order, with its geotransform.
  OriginalDem(Grid<float> heights, const Geotransform& geotransform, const Tin& frame);

  std::size_t vertices() const override { return heights_.size(); }
  std::size_t faces() const override;
  Xyz place(std::size_t vertex) const override;
  bool face(std::size_t number, Corners& corners) const override;

 private:
  Grid<float> heights_;
  Geotransform to_frame_;
  double lowest_;
};

}  // namespace sightbound
