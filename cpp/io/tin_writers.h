// SPDX-License-Identifier: GPL-3.0-or-later
// One function a format. Internal to cpp/io.
#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "terrain/tin.h"

namespace sightbound {

// All write `path` as it is named; the caller renames. Throw IoError, Cancelled.
void write_ply(const std::string& path, const Tin&, bool ascii, Progress&);
// Up to the first vertex.
std::string ply_header(const Tin&, std::size_t vertices, std::size_t faces, bool ascii);
void write_obj(const std::string& path, const Tin&, Progress&);
void write_2dm(const std::string& path, const Tin&, Progress&);
void write_ugrid(const std::string& path, const Tin&, Progress&);
void write_gpkg(const std::string& path, const std::string& layer, const Tin&, Progress&);

// Vertex attributes with sigma_v first, as every format writes them. Names of letters, digits and _; none
// twice, none of `taken`.
struct NamedValues {
  std::string name;
  const std::vector<float>* values;
};
std::vector<NamedValues> vertex_values(const Tin&, const std::vector<std::string>& taken);
std::vector<NamedValues> face_values(const Tin&, const std::vector<std::string>& taken);

}  // namespace sightbound
