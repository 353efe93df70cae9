// SPDX-License-Identifier: GPL-3.0-or-later
// The error model as JSON. One quantity is one of
//   1.5                                                  metres
//   {"raster": "sigma.tif", "band": 1}                   a raster file
//   {"from_dem": {}}, also null                          to be learnt from the DEM
//   {"from_dem": {"exponent": 0.93, "typical_m": 1.2, "scale": 1}}   learnt: local map with this growth
//   (geologic_variation only)
// What was added later is written only where it says something: a model that does not use it reads the same
// as before.
#include <initializer_list>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "error_model/error_model.h"

namespace sightbound {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "sightbound_error_model";
constexpr int kFormatVersion = 1;

[[noreturn]] void refuse(const std::string& what) { throw InvalidInput("Error model (JSON): " + what); }

void require_known(const Json& object, const std::string& where, std::initializer_list<const char*> names) {
  if (!object.is_object()) refuse(where + " is " + object.dump() + "; an object {...} is needed.");
  std::string known;
  for (const char* name : names) known += (known.empty() ? "" : ", ") + std::string(name);
  for (const auto& item : object.items()) {
    bool found = false;
    for (const char* name : names) found = found || item.key() == name;
    if (!found) refuse(where + " has an unknown name '" + item.key() + "'; known are: " + known + ".");
  }
}

double number(const Json& value, const std::string& field) {
  if (!value.is_number()) refuse(field + " is " + value.dump() + "; a number is needed.");
  return value.get<double>();
}

std::string string(const Json& value, const std::string& field) {
  if (!value.is_string()) refuse(field + " is " + value.dump() + "; a text is needed.");
  return value.get<std::string>();
}

std::optional<double> optional_number(const Json& object, const char* name) {
  if (!object.contains(name) || object[name].is_null()) return std::nullopt;
  return number(object[name], name);
}

struct QuantityToJson {
  std::string field;
  bool arrays_allowed;

  Json operator()(FromDem) const { return {{"from_dem", Json::object()}}; }
  Json operator()(double metres) const { return metres; }
  Json operator()(const RasterFile& raster) const { return {{"raster", raster.path}, {"band", raster.band}}; }
  Json operator()(const SharedGrid& array) const {
    if (arrays_allowed) return {{"array", {array->rows(), array->cols()}}};
    throw InvalidInput(
        field + " is an array, which cannot be written as JSON; save it as a raster and give its path.");
  }
};

Quantity quantity_from(const Json& value, const std::string& field) {
  if (value.is_null()) return FromDem{};
  if (value.is_number()) return value.get<double>();
  if (!value.is_object()) {
    refuse(field + " is " + value.dump() +
           R"(; give metres, {"raster": path, "band": 1} or {"from_dem": {}}.)");
  }
  if (value.contains("from_dem")) {
    require_known(value, field, {"from_dem"});
    return FromDem{};
  }
  if (value.contains("array")) {
    refuse(field +
           " was an array, which is not part of this text; give it again, as an array or as a raster.");
  }
  require_known(value, field, {"raster", "band"});
  RasterFile raster;
  if (!value.contains("raster")) refuse(field + " has no 'raster'; name the file.");
  raster.path = string(value["raster"], field + ".raster");
  if (value.contains("band")) {
    if (!value["band"].is_number_integer())
      refuse(field + ".band is " + value["band"].dump() + "; an integer is needed.");
    raster.band = value["band"].get<int>();
  }
  return raster;
}

// The recipe inside a geologic_variation that is FromDem.
void read_recipe(const Json& value, ErrorModel& model) {
  if (!value.is_object() || !value.contains("from_dem")) return;
  const Json& recipe = value["from_dem"];
  require_known(recipe, "geologic_variation.from_dem", {"exponent", "typical_m", "scale"});
  model.growth_exponent = optional_number(recipe, "exponent");
  model.typical_m = optional_number(recipe, "typical_m");
  model.local_scale = optional_number(recipe, "scale");
}

Json to_json(const TerrainTypes& types) {
  Json out = {
      {"path", types.path}, {"layer", types.layer}, {"field", types.field}, {"table", Json::object()}};
  for (const auto& [name, metres] : types.table) out["table"][name] = metres;
  return out;
}

TerrainTypes types_from(const Json& value) {
  require_known(value, "terrain_types", {"path", "layer", "field", "table"});
  TerrainTypes types;
  if (value.contains("path")) types.path = string(value["path"], "terrain_types.path");
  if (value.contains("layer")) types.layer = string(value["layer"], "terrain_types.layer");
  if (value.contains("field")) types.field = string(value["field"], "terrain_types.field");
  if (value.contains("table")) {
    if (!value["table"].is_object())
      refuse("terrain_types.table is " + value["table"].dump() + "; an object {...} is needed.");
    for (const auto& item : value["table"].items()) {
      types.table[item.key()] = number(item.value(), "terrain_types.table." + item.key());
    }
  }
  return types;
}

// What the errors of different places have in common, and what a cell holds.
void read_nature(const Json& json, ErrorModel& model) {
  const auto said = [&](const char* name) { return json.contains(name) && !json[name].is_null(); };
  if (said("tails")) model.tails = tails_from(string(json["tails"], "tails"));
  if (said("correlation_length")) {
    model.correlation_length = number(json["correlation_length"], "correlation_length");
  }
  if (said("shared_bias")) model.shared_bias = number(json["shared_bias"], "shared_bias");
  if (said("samples_or_means")) {
    model.samples_or_means = cell_content_from(string(json["samples_or_means"], "samples_or_means"));
  }
  model.ridge_gain = optional_number(json, "ridge_gain");
  model.level_variance = optional_number(json, "level_variance");
  model.step_variance = optional_number(json, "step_variance");
  model.level_tail = optional_number(json, "level_tail");
  model.step_tail = optional_number(json, "step_tail");
}

void write_nature(const ErrorModel& model, Json& json) {
  if (model.tails) json["tails"] = name_of(*model.tails);
  if (model.correlation_length != 0) json["correlation_length"] = model.correlation_length;
  if (model.shared_bias != 0) json["shared_bias"] = model.shared_bias;
  if (model.samples_or_means) json["samples_or_means"] = name_of(*model.samples_or_means);
  if (model.ridge_gain) json["ridge_gain"] = *model.ridge_gain;
  if (model.level_variance) json["level_variance"] = *model.level_variance;
  if (model.step_variance) json["step_variance"] = *model.step_variance;
  if (model.level_tail) json["level_tail"] = *model.level_tail;
  if (model.step_tail) json["step_tail"] = *model.step_tail;
}

ErrorModel model_from(const Json& json) {
  require_known(
      json, "The model",
      {kFormat, "vertical_rmse", "horizontal_rmse", "geologic_variation", "geologic_model", "geologic_range",
       "growth_exponent", "terrain_types", "tails", "correlation_length", "shared_bias", "samples_or_means",
       "ridge_gain", "level_variance", "step_variance", "level_tail", "step_tail"});
  if (json.contains(kFormat) && json[kFormat] != kFormatVersion) {
    refuse(std::string(kFormat) + " is " + json[kFormat].dump() + "; this version of Sightbound reads " +
           std::to_string(kFormatVersion) + ".");
  }
  ErrorModel model;
  if (json.contains("vertical_rmse"))
    model.vertical_rmse = quantity_from(json["vertical_rmse"], "vertical_rmse");
  if (const auto metres = optional_number(json, "horizontal_rmse")) model.horizontal_rmse = *metres;
  if (json.contains("geologic_model")) {
    model.geologic_shape = geologic_shape_from(string(json["geologic_model"], "geologic_model"));
  }
  model.geologic_range = optional_number(json, "geologic_range");
  if (json.contains("geologic_variation")) {
    model.geologic_variation = quantity_from(json["geologic_variation"], "geologic_variation");
    read_recipe(json["geologic_variation"], model);
  }
  if (const auto exponent = optional_number(json, "growth_exponent")) model.growth_exponent = exponent;
  if (json.contains("terrain_types") && !json["terrain_types"].is_null()) {
    model.terrain_types = types_from(json["terrain_types"]);
  }
  read_nature(json, model);
  return model;
}

std::string written(const ErrorModel& model, bool arrays_allowed) {
  Json json = {{kFormat, kFormatVersion}};
  json["vertical_rmse"] = std::visit(QuantityToJson{"vertical_rmse", arrays_allowed}, model.vertical_rmse);
  json["horizontal_rmse"] = model.horizontal_rmse;
  json["geologic_variation"] =
      std::visit(QuantityToJson{"geologic_variation", arrays_allowed}, model.geologic_variation);
  json["geologic_model"] = name_of(model.geologic_shape);
  if (model.geologic_range) json["geologic_range"] = *model.geologic_range;
  if (std::holds_alternative<FromDem>(model.geologic_variation)) {
    Json& recipe = json["geologic_variation"]["from_dem"];
    if (model.growth_exponent) recipe["exponent"] = *model.growth_exponent;
    if (model.typical_m) recipe["typical_m"] = *model.typical_m;
    if (model.local_scale) recipe["scale"] = *model.local_scale;
  } else if (model.growth_exponent) {
    json["growth_exponent"] = *model.growth_exponent;
  }
  if (model.terrain_types) json["terrain_types"] = to_json(*model.terrain_types);
  write_nature(model, json);
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string ErrorModel::to_json() const { return written(*this, false); }

std::string ErrorModel::describe() const { return written(*this, true); }

ErrorModel ErrorModel::from_json(const std::string& text) {
  try {
    return model_from(Json::parse(text));
  } catch (const Json::exception& error) {
    refuse(std::string("not readable: ") + error.what() + ".");
  }
}

}  // namespace sightbound
