// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/result_files.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

#include "base/error.h"
#include "base/version.h"
#include "io/raster_writer.h"
#include "jobs/option_names.h"

namespace sightbound {

namespace {

using Items = std::map<std::string, std::string>;

// Shortest text that reads back as the same number; the same in every locale.
std::string text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

std::string text(bool value) { return value ? "yes" : "no"; }

std::string lines(const std::vector<std::string>& texts) {
  std::string joined;
  for (const std::string& one : texts) joined += (joined.empty() ? "" : "\n") + one;
  return joined;
}

// The value that all observers share.
std::string common(const std::vector<Observer>& observers, double Observer::*field) {
  const double first = observers.front().*field;
  const bool same = std::ranges::all_of(observers, [&](const Observer& one) { return one.*field == first; });
  return same ? text(first) : "varies";
}

Items with_warnings(Items items, const std::vector<std::string>& warnings) {
  if (!warnings.empty()) items["SIGHTBOUND_WARNINGS"] = lines(warnings);
  return items;
}

Items items_of(const ViewshedResult& result, const std::vector<Observer>& observers,
               const ViewshedOptions& options) {
  Items items = {
      {"SIGHTBOUND_VERSION", version()},
      {"SIGHTBOUND_CONFIDENCE", text(options.confidence)},
      {"SIGHTBOUND_ERROR_MODEL", result.report.error_model},
      {"SIGHTBOUND_OBSERVERS", std::to_string(observers.size())},
      {"SIGHTBOUND_OBSERVER_HEIGHT", common(observers, &Observer::height)},
      {"SIGHTBOUND_TARGET_HEIGHT", common(observers, &Observer::target_height)},
      {"SIGHTBOUND_HEIGHT_REFERENCE", name_of(options.height_reference)},
      {"SIGHTBOUND_MAX_DISTANCE", common(observers, &Observer::max_distance)},
      {"SIGHTBOUND_CURVATURE", text(options.curvature)},
      {"SIGHTBOUND_REFRACTION", text(options.refraction)},
      {"SIGHTBOUND_STAND", name_of(options.stand)},
      {"SIGHTBOUND_COMBINE", name_of(options.combine)},
      {"SIGHTBOUND_SEE_ACROSS_NODATA", text(options.see_across_nodata)},
  };
  return with_warnings(std::move(items), result.report.warnings);
}

// The rasters of one call: those without a path are left out.
class Outputs {
 public:
  Outputs(Items items, const std::vector<std::string>& creation_options)
      : items_(std::move(items)), creation_options_(creation_options) {}

  // `quantity` says what the values mean; it is the band's description too.
  template <class T>
  void add(const std::string& path, const Grid<T>& grid, const std::string& quantity,
           const std::string& unit = "") {
    if (path.empty()) return;
    RasterMetadata metadata{quantity, unit, items_, creation_options_};
    metadata.items["SIGHTBOUND_QUANTITY"] = quantity;
    outputs_.push_back({path, &grid, std::move(metadata)});
  }

  void add(const std::string& path, const std::vector<Grid<float>>& grids, const std::string& quantity,
           std::vector<std::string> bands) {
    if (path.empty()) return;
    RasterMetadata metadata{quantity, "", items_, creation_options_, std::move(bands)};
    metadata.items["SIGHTBOUND_QUANTITY"] = quantity;
    outputs_.push_back({path, &grids, std::move(metadata)});
  }

  void write(const Geotransform& geotransform, const std::string& crs_wkt, int threads,
             Progress& progress) const {
    if (outputs_.empty()) throw InvalidInput("There is nothing to write: name at least one output file.");
    write_rasters(outputs_, geotransform, crs_wkt, threads, progress);
    progress.finish();
  }

 private:
  Items items_;
  std::vector<std::string> creation_options_;
  std::vector<RasterOutput> outputs_;
};

void require_heights(const std::string& path, const Grid<float>& heights) {
  if (path.empty() || !heights.empty()) return;
  throw InvalidInput("'" + path +
                     "' cannot be written: lowest visible heights were not computed; run with heights=True.");
}

}  // namespace

void write_viewshed(const ViewshedResult& result, const std::vector<Observer>& observers,
                    const ViewshedOptions& options, const ViewshedFiles& files, Progress& progress) {
  require_heights(files.lowest_visible_height, result.lowest_visible_height);
  require_heights(files.likely_visible_height, result.likely_visible_height);
  const bool derive = !files.count.empty() && result.count.empty();
  const Grid<std::uint32_t> derived = derive ? count_of(result.verdict) : Grid<std::uint32_t>();

  Outputs outputs(items_of(result, observers, options), files.creation_options);
  outputs.add(files.confidence, result.confidence,
              "pointwise confidence of visibility (0 hidden to 1 visible)");
  outputs.add(files.verdict, result.verdict, "verdict: 0 hidden, 1 uncertain, 2 visible");
  outputs.add(files.count, derive ? derived : result.count, "number of observers that claim visible");
  outputs.add(files.lowest_visible_height, result.lowest_visible_height,
              "lowest height above ground that is certainly visible", "m");
  outputs.add(files.likely_visible_height, result.likely_visible_height,
              "lowest height above ground that is likely visible", "m");
  outputs.write(result.geotransform, result.crs_wkt, options.threads, progress);
}

void write_probable(const ProbableViewshed& result, const std::vector<Observer>& observers,
                    const ProbableOptions& options, const ProbableFiles& files, Progress& progress) {
  Outputs outputs(with_warnings({{"SIGHTBOUND_VERSION", version()},
                                 {"SIGHTBOUND_CONFIDENCE", text(options.confidence)},
                                 {"SIGHTBOUND_ERROR_MODEL", result.report.error_model},
                                 {"SIGHTBOUND_OBSERVERS", std::to_string(observers.size())},
                                 {"SIGHTBOUND_OBSERVER_HEIGHT", common(observers, &Observer::height)},
                                 {"SIGHTBOUND_TARGET_HEIGHT", common(observers, &Observer::target_height)},
                                 {"SIGHTBOUND_MAX_DISTANCE", common(observers, &Observer::max_distance)},
                                 {"SIGHTBOUND_CURVATURE", text(options.curvature)},
                                 {"SIGHTBOUND_REFRACTION", text(options.refraction)},
                                 {"SIGHTBOUND_REALISATIONS", std::to_string(options.realisations)},
                                 {"SIGHTBOUND_PRECISION", text(options.precision)},
                                 {"SIGHTBOUND_METHOD", name_of(options.method)},
                                 {"SIGHTBOUND_REFINEMENT", std::to_string(options.refinement)},
                                 {"SIGHTBOUND_SEED", std::to_string(options.seed)}},
                                result.report.warnings),
                  files.creation_options);
  outputs.add(
      files.probability, result.probability,
      "probability that an observer sees the cell, whole line (" +
          std::string(options.method == Terrains::kConditional ? "conditional simulation" : "perturbed DEM") +
          ")");
  outputs.add(files.standard_error, result.standard_error, "standard error of the probability");
  outputs.add(files.verdict, result.verdict, "verdict: 0 hidden, 1 uncertain, 2 visible");
  if (!files.at_heights.empty() && result.at_heights.empty())
    throw InvalidInput("'" + files.at_heights + "' cannot be written: no heights were given.");
  std::vector<std::string> bands;
  for (const double height : result.report.heights)
    bands.push_back("probability that a target " + text(height) + " m above ground is seen");
  outputs.add(files.at_heights, result.at_heights, "probability that a target of a height is seen",
              std::move(bands));
  outputs.write(result.geotransform, result.crs_wkt, options.threads, progress);
}

void write_error_surfaces(const ErrorSurfaces& surfaces, const ErrorSurfacesOptions& options,
                          const ErrorSurfaceFiles& files, Progress& progress) {
  Outputs outputs(with_warnings({{"SIGHTBOUND_VERSION", version()},
                                 {"SIGHTBOUND_CONFIDENCE", text(options.confidence)},
                                 {"SIGHTBOUND_ERROR_MODEL", surfaces.error_model}},
                                surfaces.warnings),
                  files.creation_options);
  outputs.add(files.sigma, surfaces.sigma,
              "largest standard deviation of the terrain's error within the cell", "m");
  outputs.add(files.lower, surfaces.lower, "lower surface of the error volume", "m");
  outputs.add(files.upper, surfaces.upper, "upper surface of the error volume", "m");
  outputs.write(surfaces.geotransform, surfaces.crs_wkt, options.threads, progress);
}

Grid<std::uint32_t> count_of(const Grid<std::uint8_t>& verdict) {
  Grid<std::uint32_t> count(verdict.rows(), verdict.cols());
  std::ranges::transform(verdict.values(), count.data(), [](std::uint8_t v) -> std::uint32_t {
    return v == kNoVerdict ? kNoCount : v == kVisible;
  });
  return count;
}

}  // namespace sightbound
