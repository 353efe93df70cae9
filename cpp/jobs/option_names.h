// SPDX-License-Identifier: GPL-3.0-or-later
// The options' values as words: the same in Python, in QGIS and in the metadata of outputs.
#pragma once

#include <string>

#include "jobs/probable_viewshed_job.h"
#include "jobs/viewshed_job.h"
#include "sight/volume_viewshed.h"

namespace sightbound {

std::string name_of(Stand);            // "model", "ground"
std::string name_of(Combine);          // "best", "worst"
std::string name_of(HeightReference);  // "ground", "absolute"
std::string name_of(SeenFrom);         // "any", "all"
std::string name_of(HoldsFor);         // "place", "voxel", "target"
std::string name_of(Terrains);         // "conditional", "perturb"

// Throw InvalidInput that names the option, the word and those allowed.
Stand stand_from(const std::string& name);
Combine combine_from(const std::string& name);
HeightReference height_reference_from(const std::string& name);
SeenFrom seen_from(const std::string& name);
HoldsFor holds_for(const std::string& name);
Terrains terrains_from(const std::string& name);

}  // namespace sightbound
