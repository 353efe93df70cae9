// SPDX-License-Identifier: GPL-3.0-or-later
// Elevation products by name, with the accuracy that has been published of them.
//
// What counts for sight is how much neighbouring samples err against each other. A product that is off as a
// whole, sideways (its circular error) or upwards, shows the same terrain elsewhere: such figures are told,
// and left out of sigma. Where no relative error of neighbours is published, sigma is that of the absolute
// one: cautious as a rule, since a part of it is shared by all samples.
#pragma once

#include <string>
#include <vector>

#include "error_model/error_model.h"

namespace sightbound {

enum class AccuracyKind {
  kRmse,         // of heights
  kLe90,         // of heights, 90 % linear error
  kRelativeLe90  // of the difference of two heights, 90 % linear error: sqrt2 times that of one
};

struct Product {
  std::string name;   // "srtm_eurasia"
  std::string title;  // for people
  double published_m;
  AccuracyKind kind;
  std::string shared;  // what is published of the product as a whole
  std::string source;

  double vertical_rmse() const;
};

const std::vector<Product>& products();
const Product& product_from(const std::string& name);  // throws InvalidInput, listing the names

// sigma_v as published; what lies between the samples is left to the DEM.
ErrorModel product_error(const std::string& name);

}  // namespace sightbound
