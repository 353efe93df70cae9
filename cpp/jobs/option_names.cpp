// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/option_names.h"

#include <initializer_list>

#include "base/error.h"

namespace sightbound {

namespace {

template <class Option>
Option option_from(const std::string& field, const std::string& name, std::initializer_list<Option> allowed) {
  std::string names;
  for (const Option option : allowed) {
    if (name == name_of(option)) return option;
    if (!names.empty()) names += option == *(allowed.end() - 1) ? " and " : ", ";
    names += "'";
    names += name_of(option);
    names += "'";
  }
  throw InvalidInput(field + " is '" + name + "'; allowed are " + names + ".");
}

}  // namespace

std::string name_of(Stand stand) { return stand == Stand::kModel ? "model" : "ground"; }

std::string name_of(Combine combine) { return combine == Combine::kBest ? "best" : "worst"; }

std::string name_of(HeightReference reference) {
  return reference == HeightReference::kGround ? "ground" : "absolute";
}

std::string name_of(SeenFrom seen) { return seen == SeenFrom::kAny ? "any" : "all"; }

std::string name_of(HoldsFor holds) {
  return holds == HoldsFor::kPlace ? "place" : holds == HoldsFor::kVoxel ? "voxel" : "target";
}

std::string name_of(Terrains terrains) {
  return terrains == Terrains::kConditional ? "conditional" : "perturb";
}

Stand stand_from(const std::string& name) {
  return option_from("stand", name, {Stand::kModel, Stand::kGround});
}

Combine combine_from(const std::string& name) {
  return option_from("combine", name, {Combine::kBest, Combine::kWorst});
}

HeightReference height_reference_from(const std::string& name) {
  return option_from("height_reference", name, {HeightReference::kGround, HeightReference::kAbsolute});
}

SeenFrom seen_from(const std::string& name) {
  return option_from("seen_from", name, {SeenFrom::kAny, SeenFrom::kAll});
}

HoldsFor holds_for(const std::string& name) {
  return option_from("holds_for", name, {HoldsFor::kPlace, HoldsFor::kVoxel, HoldsFor::kTarget});
}

Terrains terrains_from(const std::string& name) {
  return option_from("method", name, {Terrains::kConditional, Terrains::kPerturb});
}

}  // namespace sightbound
