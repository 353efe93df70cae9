// SPDX-License-Identifier: GPL-3.0-or-later
// Where simplifying stops before nothing more can be removed: at so many faces, or at a file of some size.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "simplify/simplify.h"
#include "terrain/tin.h"

namespace sightbound {

struct TinTarget {
  std::int64_t faces = 0;      // 0 = no such target
  double bytes = 0;            // of the file; 0 = no such target
  std::string ending = "ply";  // of that file (tin_writer.h)
};

// What is left for vertices and faces; `like` has the CRS and the names of the attributes of what will be
// written. Nothing without such a target. Throws InvalidInput.
SimplifyOptions::Bytes bytes_for(const TinTarget&, const Tin& like);

// That the tolerance did not let the target be reached, if it did not.
void say_what_is_missed(const TinTarget&, const SimplifyOptions::Bytes&, const Tin& made,
                        std::vector<std::string>& warnings);

}  // namespace sightbound
