// SPDX-License-Identifier: GPL-3.0-or-later
// TINs to files, written beside the target and renamed when whole.
//
//   ending   format            CRS                    attributes                     coordinates
//   .ply     PLY               comment QGIS reads     vertex and face properties     double
//   .nc      UGRID NetCDF      variable QGIS reads    variables on nodes and faces   double
//   .gpkg    GeoPackage        layer                  of faces: fields               double
//   .2dm     SMS 2DM           none: set when loaded  none                           shortest text that reads
//   back the same .obj     Wavefront OBJ     comment of our own     none                           the same
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "terrain/tin.h"

namespace sightbound {

struct TinWriteOptions {
  // PLY as text. Binary otherwise: QGIS takes NaN of a text PLY for 0.
  bool ascii = false;
};

// Bytes that a TIN takes in a file: exact for binary PLY (but for 20 bytes), not less than it takes for the
// others. `like` has its CRS and the names of its attributes.
struct TinFileSize {
  double fixed = 0, of_vertex = 0, of_face = 0;
};
// `ending` as in "ply". Throws InvalidInput for one that is not written.
TinFileSize tin_file_size(const std::string& ending, const Tin& like);

// x and y are those of the CRS, z metres. Returns warnings: what the format cannot hold. A failure leaves
// nothing and keeps what stood there before. Advances `progress` by 1 per vertex and face. Throws
// InvalidInput (ending), IoError, Cancelled.
std::vector<std::string> write_tin(const std::string& path, const Tin&, const TinWriteOptions&, Progress&);

}  // namespace sightbound
