// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/tin_writer.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>

#include "base/error.h"
#include "io/tin_writers.h"
#include "io/whole_file.h"

namespace sightbound {

namespace {

std::string name_of(const std::string& path) {
  const std::size_t slash = path.find_last_of("/\\");
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

// In lower case, without the dot.
std::string ending_of(const std::string& path) {
  const std::string name = name_of(path);
  const std::size_t dot = name.find_last_of('.');
  std::string ending = dot == std::string::npos ? "" : name.substr(dot + 1);
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending;
}

std::vector<NamedValues> named(const std::vector<NamedValues>& given, std::vector<std::string> taken) {
  std::vector<NamedValues> out;
  for (NamedValues one : given) {
    std::string name;
    for (const char c : one.name) {
      const bool plain =
          (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
      name += plain ? c : '_';
    }
    if (name.empty()) name = "value";
    while (std::find(taken.begin(), taken.end(), name) != taken.end()) name += '_';
    taken.push_back(name);
    one.name = name;
    out.push_back(one);
  }
  return out;
}

}  // namespace

std::vector<NamedValues> vertex_values(const Tin& tin, const std::vector<std::string>& taken) {
  std::vector<NamedValues> values;
  if (!tin.sigma_v.empty()) values.push_back({"sigma_v", &tin.sigma_v});
  for (const TinAttribute& one : tin.vertex_attributes) values.push_back({one.name, &one.values});
  return named(values, taken);
}

std::vector<NamedValues> face_values(const Tin& tin, const std::vector<std::string>& taken) {
  std::vector<NamedValues> values;
  for (const TinAttribute& one : tin.face_attributes) values.push_back({one.name, &one.values});
  return named(values, taken);
}

TinFileSize tin_file_size(const std::string& ending, const Tin& like) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();  // of vertices, of faces
  constexpr double kNumber = 25, kIndex = 11;                              // characters, with a blank
  constexpr double kValue = sizeof(float);
  const auto of_vertex = static_cast<double>(like.vertex_attributes.size()),
             of_face = static_cast<double>(like.face_attributes.size());
  if (ending == "ply") {
    return {static_cast<double>(ply_header(like, kMost, kMost, false).size()), 24 + kValue * of_vertex,
            13 + kValue * of_face};
  }
  if (ending == "nc") return {20000, 24 + kValue * of_vertex, 12 + kValue * of_face};
  if (ending == "gpkg") return {150000, 0, 290 + 10 * of_face};  // with its index: 270 measured with one
  if (ending == "2dm") return {10, 4 + kIndex + 3 * kNumber, 7 + 4 * kIndex};
  if (ending == "obj") return {1000, 3 + 3 * kNumber, 3 + 3 * kIndex};
  throw InvalidInput("target_bytes is for a file that ends in '" + ending +
                     "'; a TIN is written as ply, nc (UGRID), gpkg, 2dm or obj.");
}

std::vector<std::string> write_tin(const std::string& path, const Tin& tin, const TinWriteOptions& options,
                                   Progress& progress) {
  check_sizes(tin, "The TIN");
  const std::string ending = ending_of(path);
  std::vector<std::string> warnings;
  const auto warn = [&](bool lost, const std::string& text) {
    if (lost) warnings.push_back(text);
  };
  const bool vertex_numbers = !tin.sigma_v.empty() || !tin.vertex_attributes.empty();
  const bool any_numbers = vertex_numbers || !tin.face_attributes.empty();

  WholeFile file(path);
  if (ending == "ply") {
    write_ply(file.temporary(), tin, options.ascii, progress);
  } else if (ending == "nc") {
    write_ugrid(file.temporary(), tin, progress);
  } else if (ending == "gpkg") {
    warn(vertex_numbers,
         "A GeoPackage of faces cannot hold sigma_v and attributes of vertices; write PLY to keep them.");
    write_gpkg(file.temporary(), name_of(path).substr(0, name_of(path).size() - 5), tin, progress);
  } else if (ending == "2dm") {
    warn(any_numbers, "2DM cannot hold sigma_v and attributes; write PLY to keep them.");
    warn(!tin.crs_wkt.empty(), "2DM cannot hold a CRS: set it when the layer is loaded.");
    write_2dm(file.temporary(), tin, progress);
  } else if (ending == "obj") {
    warn(any_numbers, "OBJ cannot hold sigma_v and attributes; write PLY to keep them.");
    warn(!tin.crs_wkt.empty(), "OBJ has no CRS that others read; it is in a comment of our own.");
    write_obj(file.temporary(), tin, progress);
  } else {
    throw InvalidInput("'" + path + "' ends in '" + ending +
                       "'; a TIN is written as .ply, .nc (UGRID), .gpkg, .2dm or .obj.");
  }
  progress.check();
  file.keep();
  return warnings;
}

}  // namespace sightbound
