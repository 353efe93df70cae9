// SPDX-License-Identifier: GPL-3.0-or-later
// Which faces lie over which voxel columns, for height fields. Internal to cpp/volume.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "volume/column_overlay.h"
#include "volume/surface.h"

namespace sightbound {

class DemSurface;

class ColumnFaces {
 public:
  // DEMs are looked up by their grid; any other surface's faces are sorted into blocks of 128 x 128 columns:
  // 4 bytes a face and block.
  ColumnFaces(const Surface& surface, double voxel_m);

  // Columns [0, cols()) x [0, rows()) cover the surface.
  int cols() const { return cols_; }
  int rows() const { return rows_; }
  int blocks_across() const { return (cols_ + 127) / 128; }
  int blocks_down() const { return (rows_ + 127) / 128; }
  double voxel_m() const { return voxel_m_; }
  // The surface, when it is a DEM.
  const DemSurface* dem() const { return dem_; }

  // The faces of one block, sorted into its 16 x 16 squares of 8 x 8 columns.
  class Block {
   public:
    Block(const ColumnFaces& faces, int a, int b);
    // Numbers of the faces that may touch the 8 x 8 columns from (8 i8, 8 j8), within the block; ascending.
    void near(int i8, int j8, std::vector<std::uint32_t>& numbers) const;

   private:
    const ColumnFaces& faces_;
    int a_, b_;
    std::vector<std::uint32_t> start_, numbers_;
  };

 private:
  struct Range {
    int i0, i1, j0, j1;
  };
  // Squares of `side` columns that the face's bounding box touches.
  Range squares_of(const SurfaceFace& face, int side) const;

  const Surface& surface_;
  const DemSurface* dem_;
  double voxel_m_;
  int cols_, rows_;
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> numbers_;
};

}  // namespace sightbound
