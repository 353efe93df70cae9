// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vertical_unit.h"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "base/number_text.h"

namespace sightbound {

namespace {

constexpr double kFoot = 0.3048;
constexpr double kUsSurveyFoot = 1200.0 / 3937.0;

struct NamedUnit {
  std::string_view name;
  double metres;
};
// Spellings met in files, compared in lower case with everything but letters removed.
constexpr std::array<NamedUnit, 36> kUnits{{{"m", 1},
                                            {"metre", 1},
                                            {"metres", 1},
                                            {"meter", 1},
                                            {"meters", 1},
                                            {"mt", 1},
                                            {"mtr", 1},
                                            {"ft", kFoot},
                                            {"foot", kFoot},
                                            {"feet", kFoot},
                                            {"intft", kFoot},
                                            {"ftint", kFoot},
                                            {"internationalfoot", kFoot},
                                            {"internationalfeet", kFoot},
                                            {"footinternational", kFoot},
                                            {"usft", kUsSurveyFoot},
                                            {"ftus", kUsSurveyFoot},
                                            {"sft", kUsSurveyFoot},
                                            {"usfoot", kUsSurveyFoot},
                                            {"usfeet", kUsSurveyFoot},
                                            {"footus", kUsSurveyFoot},
                                            {"surveyfoot", kUsSurveyFoot},
                                            {"surveyfeet", kUsSurveyFoot},
                                            {"ussurveyfoot", kUsSurveyFoot},
                                            {"ussurveyfeet", kUsSurveyFoot},
                                            {"dm", 0.1},
                                            {"cm", 0.01},
                                            {"centimetre", 0.01},
                                            {"centimetres", 0.01},
                                            {"centimeter", 0.01},
                                            {"centimeters", 0.01},
                                            {"mm", 0.001},
                                            {"millimetre", 0.001},
                                            {"millimeter", 0.001},
                                            {"millimeters", 0.001},
                                            {"km", 1000}}};

std::optional<double> unit_from_band(const std::string& text) {
  std::string letters;
  for (const char c : text) {
    if (c >= 'A' && c <= 'Z') letters += static_cast<char>(c - 'A' + 'a');
    if (c >= 'a' && c <= 'z') letters += c;
  }
  for (const NamedUnit& unit : kUnits) {
    if (unit.name == letters) return unit.metres;
  }
  return {};
}

bool same(double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(a); }

bool is_foot(double metres) { return metres > 0.3 && metres < 0.31; }
bool is_packing(double metres) { return metres < 0.3 || metres > 1.1; }

}  // namespace

VerticalUnit vertical_unit_from(const std::string& name) {
  if (name == "auto") return VerticalUnit::kAuto;
  if (name == "metre") return VerticalUnit::kMetre;
  if (name == "foot") return VerticalUnit::kFoot;
  if (name == "us-foot") return VerticalUnit::kUsSurveyFoot;
  throw InvalidInput("vertical_unit is '" + name + "'; give 'auto', 'metre', 'foot' or 'us-foot'.");
}

double metres_per(VerticalUnit unit) {
  switch (unit) {
    case VerticalUnit::kFoot:
      return kFoot;
    case VerticalUnit::kUsSurveyFoot:
      return kUsSurveyFoot;
    case VerticalUnit::kAuto:
    case VerticalUnit::kMetre:
      break;
  }
  return 1;
}

VerticalScale choose_vertical_unit(VerticalUnit asked, const CrsUnits& crs, const std::string& band_unit) {
  VerticalScale scale;
  const std::optional<double> band = unit_from_band(band_unit);
  const auto say = [&](const std::string& note) { scale.notes.push_back(note); };

  if (asked != VerticalUnit::kAuto) {
    scale.metres_per_unit = metres_per(asked);
    if (crs.vertical_m && !same(*crs.vertical_m, scale.metres_per_unit)) {
      say("Vertical unit set by the user (" + number_text(scale.metres_per_unit) +
          " m) against the vertical CRS (" + crs.vertical_name + ").");
    } else if (!same(scale.metres_per_unit, 1)) {
      say("Heights converted to metres (1 unit = " + number_text(scale.metres_per_unit) +
          " m, set by the user).");
    }
    return scale;
  }
  if (crs.vertical_m && !(band && is_packing(*band))) {
    scale.metres_per_unit = *crs.vertical_m;
    if (!same(scale.metres_per_unit, 1)) {
      say("Heights converted to metres (1 unit = " + number_text(scale.metres_per_unit) +
          " m: the vertical CRS is in " + crs.vertical_name + ").");
    }
    if (band && !same(*band, scale.metres_per_unit)) {
      say("The band says its unit is '" + band_unit + "', the vertical CRS " + crs.vertical_name +
          ": the CRS was followed. Set the vertical unit if the band is right.");
    }
    return scale;
  }
  if (band) {
    scale.metres_per_unit = *band;
    if (!same(*band, 1)) {
      say("Heights converted to metres (1 unit = " + number_text(*band) + " m: the band's unit is '" +
          band_unit + "').");
    }
    return scale;
  }
  if (!band_unit.empty()) {
    say("The band's unit '" + band_unit +
        "' is unknown: heights are taken as metres. Set the vertical unit if they are not.");
  } else if (crs.horizontal_m && is_foot(*crs.horizontal_m)) {
    say("Nothing says the unit of the heights, and the CRS measures in feet (" + crs.horizontal_name +
        "): heights are taken as metres. Set the vertical unit to foot or us-foot if they are feet.");
  }
  return scale;
}

}  // namespace sightbound
