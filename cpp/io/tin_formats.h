// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh formats, from bytes in memory. Internal to cpp/io (and to the fuzz targets).
//
// Whatever the bytes are, these return or throw InvalidInput / IoError (truncated); they never allocate more
// than a small multiple of the bytes. `what` begins messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/progress.h"
#include "io/tin_source.h"

namespace sightbound {

// Stanford PLY: ascii, binary of both byte orders. Scalar properties of vertices and faces become attributes,
// the vertex property sigma_v the error. "comment crs: EPSG:32633".
TinSource parse_ply(std::string_view bytes, const std::string& what, Progress&);

// Wavefront OBJ: v and f, z up. "# crs: EPSG:32633".
TinSource parse_obj(std::string_view bytes, const std::string& what, Progress&);

// SMS 2DM: ND, E3T, E4Q; quadratic elements by their corners. Materials become the face attribute "material".
TinSource parse_2dm(std::string_view bytes, const std::string& what, Progress&);

// LandXML: the TIN surface of that name, or the only one.
TinSource parse_landxml(std::string_view bytes, const std::vector<std::string>& surfaces,
                        const std::string& what, Progress&);
std::vector<std::string> landxml_surfaces(std::string_view bytes, const std::string& what, Progress&);

// A vector source that GDAL opens: polygons, TINs and polyhedral surfaces; or points and lines (breaklines)
// to triangulate.
TinSource read_vector_tin(const std::string& path, const TinReadOptions&, const std::string& what, Progress&);
std::vector<std::string> vector_layers(const std::string& path);

}  // namespace sightbound
