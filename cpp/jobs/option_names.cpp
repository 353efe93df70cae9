// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/option_names.h"

#include "base/error.h"

namespace sightbound {

namespace {

template <class Option>
Option option_from(const std::string& field, const std::string& name, Option first, Option second) {
  if (name == name_of(first)) return first;
  if (name == name_of(second)) return second;
  throw InvalidInput(field + " is '" + name + "'; allowed are '" + name_of(first) + "' and '" +
                     name_of(second) + "'.");
}

}  // namespace

std::string name_of(Stand stand) { return stand == Stand::kModel ? "model" : "ground"; }

std::string name_of(Combine combine) { return combine == Combine::kBest ? "best" : "worst"; }

std::string name_of(HeightReference reference) {
  return reference == HeightReference::kGround ? "ground" : "absolute";
}

std::string name_of(SeenFrom seen) { return seen == SeenFrom::kAny ? "any" : "all"; }

Stand stand_from(const std::string& name) {
  return option_from("stand", name, Stand::kModel, Stand::kGround);
}

Combine combine_from(const std::string& name) {
  return option_from("combine", name, Combine::kBest, Combine::kWorst);
}

HeightReference height_reference_from(const std::string& name) {
  return option_from("height_reference", name, HeightReference::kGround, HeightReference::kAbsolute);
}

SeenFrom seen_from(const std::string& name) {
  return option_from("seen_from", name, SeenFrom::kAny, SeenFrom::kAll);
}

}  // namespace sightbound
