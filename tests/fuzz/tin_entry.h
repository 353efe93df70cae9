// SPDX-License-Identifier: GPL-3.0-or-later
// What is asked of the mesh readers for any bytes at all: a clear error, or a Tin that keeps its promises.
// Shared by the libFuzzer target and the short run in tests/cpp/io/test_tin_fuzz.cpp.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/error.h"
#include "io/tin_formats.h"
#include "terrain/tin_cleaning.h"
#include "terrain/tin_height_field.h"
#include "terrain/tin_topology.h"

namespace sightbound::fuzz {

enum class Format { kPly, kObj, k2dm, kLandXml };

inline void require(bool kept, const char* promise) {
  if (!kept) throw std::logic_error(promise);
}

inline TinSource parse(Format format, std::string_view bytes, Progress& progress) {
  switch (format) {
    case Format::kPly:
      return parse_ply(bytes, "The TIN", progress);
    case Format::kObj:
      return parse_obj(bytes, "The TIN", progress);
    case Format::k2dm:
      return parse_2dm(bytes, "The TIN", progress);
    case Format::kLandXml:
      break;
  }
  return parse_landxml(bytes, {}, "The TIN", progress);
}

// True when the bytes made a Tin. Anything but our own refusals comes out.
inline bool try_tin(Format format, std::string_view bytes) {
  Progress progress;
  try {
    const Tin tin = make_tin(parse(format, bytes, progress), {}, "The TIN", progress);
    check_sizes(tin, "The TIN");
    for (const Xyz& v : tin.vertices) {
      require(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), "vertices are finite");
    }
    Tin again = tin;
    again.notes = {};
    again = clean(std::move(again), "The TIN");
    require(again.vertices.size() == tin.vertices.size(), "every vertex is used, none is there twice");
    TinTopology topology = topology_of(tin);
    require(again.faces.size() == tin.faces.size(), "no face is flat or repeated");
    require(topology.neighbours.size() == tin.faces.size(), "every face has neighbours");
    (void)height_field_test(tin);
    return true;
  } catch (const InvalidInput&) {
  } catch (const IoError&) {
  } catch (const OverBudget&) {
  }
  return false;
}

}  // namespace sightbound::fuzz
