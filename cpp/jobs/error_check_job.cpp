// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/error_check_job.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "io/crs.h"
#include "io/raster_writer.h"
#include "jobs/point_comparison.h"
#include "jobs/reference_comparison.h"

namespace sightbound {

namespace {

constexpr double kFarthestCells = 20;  // a shift beyond is no shift but another place
constexpr double kUsualRounds = 6;

template <class Comparison>
std::optional<HorizontalShift> shift_of(const Comparison& comparison, Progress& progress) {
  const CellSize& cell = comparison.plan().middle_cell();
  const double side = std::min(cell.col_m, cell.row_m);
  const auto compared = [&](Xy at) {
    progress.advance(1);
    return comparison.for_shift(at);
  };
  return find_shift(compared, side, kFarthestCells * side);
}

template <class Comparison>
void look_for_shift(const Comparison& comparison, const ErrorCheckOptions& options, ErrorCheck& out,
                    Progress& progress) {
  progress.begin(0.5, kUsualRounds);
  out.shift = shift_of(comparison, progress);
  progress.begin(0.5, 1);
  out.corrected = options.correct_shift;
  if (out.shift) out.correction = {out.shift->x, out.shift->y, out.shift->z};
  if (options.correction) out.correction = *options.correction;
  if (!out.shift) {
    out.warnings.push_back(
        "Whether the DEM lies sideways of the truth cannot be told: the ground is too flat or too little of "
        "it was compared.");
  } else if (!out.corrected && out.shift->is_significant()) {
    out.warnings.push_back(
        "The DEM lies " + number_text(std::hypot(out.shift->x, out.shift->y), 3) +
        " m sideways of the truth, which makes heights wrong on slopes; correct_shift takes "
        "it off.");
  }
}

// Of the correction what has to be known before heights are compared.
Xy sideways(const ErrorCheck& check) {
  return check.corrected ? Xy{check.correction.x, check.correction.y} : Xy{};
}

double bias_of(const std::vector<CheckedPlace>& places) {
  std::vector<double> errors;
  for (const CheckedPlace& place : places) errors.push_back(place.error);
  return errors.size() < kFewestChecks ? 0 : statistics_of(errors).median;
}

// Where no shift was told the correction is the bias alone.
void take_height_off(const ErrorCheckOptions& options, std::vector<CheckedPlace>& places, ErrorCheck& out) {
  if (!out.shift && !options.correction) out.correction.z = bias_of(places);
  if (!out.corrected) return;
  for (CheckedPlace& place : places) place.error -= out.correction.z;
}

std::vector<PlacedError> placed(const std::vector<CheckedPlace>& places) {
  std::vector<PlacedError> out;
  out.reserve(places.size());
  for (const CheckedPlace& place : places) out.push_back({place.x, place.y, place.error});
  return out;
}

void tell_of_rest(ErrorCheck& out) {
  const double higher = out.statistics.median + (out.corrected ? out.correction.z : 0);
  const double bias = std::abs(higher);
  constexpr double kLargeBias = 3;  // metres, and NMADs
  if (bias > kLargeBias && bias > kLargeBias * out.statistics.nmad) {
    out.warnings.push_back("The DEM is " + number_text(bias, 3) + (higher > 0 ? " m higher" : " m lower") +
                           " than the truth nearly everywhere: have both the same vertical datum and unit?");
  }
  if (out.variogram.length_is_largest) {
    out.warnings.push_back(
        "The errors are alike over as far as could be looked at: there is a trend in them, such as a tilt, "
        "and "
        "the correlation length is a least one.");
  }
}

}  // namespace

ErrorCheck check_with_points(const DemSource& source, const ErrorModel& completed,
                             std::span<const Xyz> points, const ErrorCheckOptions& options,
                             Progress& progress) {
  const Workers workers(options.threads);
  const Georeference georeference = georeference_of(source);
  const PointComparison comparison(source, georeference, points, workers, progress);
  ErrorCheck out;
  look_for_shift(comparison, options, out, progress);
  std::vector<CheckedPlace> places = comparison.places(sideways(out), completed);
  out.left_out = points.size() - places.size();
  take_height_off(options, places, out);
  judge(places, out);
  out.variogram = fit_variogram(variogram_of_places(placed(places), 0), places.size());
  tell_of_rest(out);
  progress.finish();
  return out;
}

ErrorCheck check_with_reference(const DemSource& source, const DemSource& reference,
                                const ErrorCheckOptions& options, Progress& progress) {
  const Workers workers(options.threads);
  const Georeference georeference = georeference_of(source);
  const ReferenceComparison comparison(source, georeference, reference, options.content, workers, progress);
  ErrorCheck out;
  look_for_shift(comparison, options, out, progress);
  ReferenceComparison::Found found = comparison.compare(sideways(out));
  out.left_out = found.missing;
  out.equal_level = found.equal_level;
  if (found.equal_level > 0) {
    out.warnings.push_back(
        std::to_string(found.equal_level) +
        " samples are level and exactly equal in both DEMs (water, filling) and were left out.");
  }
  if (found.is_part) {
    out.warnings.push_back("The overlap is large: " + std::to_string(kMostCheckTiles) +
                           " tiles spread over it were compared.");
  }
  take_height_off(options, found.places, out);
  judge(found.places, out);
  std::vector<LagBin> bins = found.near.bins();
  for (const LagBin& bin : variogram_of_places(placed(found.places), found.near_reach)) bins.push_back(bin);
  std::sort(bins.begin(), bins.end(),
            [](const LagBin& a, const LagBin& b) { return a.distance < b.distance; });
  out.variogram = fit_variogram(std::move(bins), found.samples);
  tell_of_rest(out);
  progress.finish();
  return out;
}

std::optional<CellContent> content_seen(const DemSource& source, const DemSource& reference,
                                        Progress& progress) {
  constexpr double kClear = 0.9;
  const Workers workers(0);
  const Georeference georeference = georeference_of(source);
  // Empty where no shift could be fitted: nothing is known of how well the two agree then.
  const auto disagreement = [&](CellContent content) -> std::optional<double> {
    const ReferenceComparison comparison(source, georeference, reference, content, workers, progress);
    progress.begin(0.5, kUsualRounds);
    const std::optional<HorizontalShift> shift = shift_of(comparison, progress);
    return shift ? std::optional(shift->nmad_after) : std::nullopt;
  };
  const std::optional<double> samples = disagreement(CellContent::kSamples),
                              means = disagreement(CellContent::kMeans);
  progress.finish();
  if (!samples || !means) return {};
  if (*means < kClear * *samples) return CellContent::kMeans;
  if (*samples < kClear * *means) return CellContent::kSamples;
  return {};
}

namespace {

// Unit vectors on the map: along the rows, and against them.
struct Axes {
  Xy x, y;

  explicit Axes(const DemSource& source) {
    const auto& g = source.geotransform().coefficients();
    const double across = std::hypot(g[1], g[4]), up = -std::hypot(g[2], g[5]);
    x = {g[1] / across, g[4] / across}, y = {g[2] / up, g[5] / up};
  }
};

}  // namespace

MapShift on_map(const Correction& correction, const DemSource& source) {
  const Axes axes(source);
  MapShift out;
  out.east = correction.x * axes.x.x + correction.y * axes.y.x;
  out.north = correction.x * axes.x.y + correction.y * axes.y.y;
  out.up = correction.z;
  return out;
}

MapShift on_map(const HorizontalShift& shift, const DemSource& source) {
  const Axes axes(source);
  MapShift out = on_map(Correction{shift.x, shift.y, shift.z}, source);
  out.se_east = std::hypot(shift.se_x * axes.x.x, shift.se_y * axes.y.x);
  out.se_north = std::hypot(shift.se_x * axes.x.y, shift.se_y * axes.y.y);
  out.se_up = shift.se_z;
  return out;
}

void write_corrected_dem(const std::string& path, const DemSource& source, const MapShift& shift,
                         const std::vector<std::string>& creation_options, int threads, Progress& progress) {
  const Workers workers(threads);
  const CheckPlan plan(source, georeference_of(source));
  const auto& g = source.geotransform().coefficients();
  const double across = std::hypot(g[1], g[4]), down = std::hypot(g[2], g[5]);
  // Metres along the raster's axes, then cells.
  const double x = (shift.east * g[1] + shift.north * g[4]) / across;
  const double y = -(shift.east * g[2] + shift.north * g[5]) / down;
  const Xy cells = plan.cells({x, y}, 0.5 * source.rows());
  std::array<double, 6> moved =
      (source.flipped() ? source.geotransform().of_flipped(source.rows()) : source.geotransform())
          .coefficients();
  moved[0] -= cells.x * g[1] + cells.y * g[2];
  moved[3] -= cells.x * g[4] + cells.y * g[5];

  const auto all = static_cast<double>(source.window().cells());
  progress.begin(0.5, all);
  Grid<float> heights = source.read(source.window(), progress);
  for (float& height : heights.values()) height = static_cast<float>(height - shift.up);
  if (source.flipped()) heights.flip_rows();
  RasterMetadata metadata;
  metadata.description = "Elevation, shift taken off";
  metadata.unit = std::string("m");
  metadata.items["SIGHTBOUND_SHIFT_TAKEN_OFF"] = number_text(shift.east) + " m east, " +
                                                 number_text(shift.north) + " m north, " +
                                                 number_text(shift.up) + " m up";
  metadata.creation_options = creation_options;
  progress.begin(0.5, all);
  write_raster(path, heights, Geotransform(moved), source.crs_wkt(), metadata, threads, progress);
  progress.finish();
}

}  // namespace sightbound
