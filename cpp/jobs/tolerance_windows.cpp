// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/tolerance_windows.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "base/error.h"
#include "io/crs.h"
#include "jobs/resolve_error.h"

namespace sightbound {

namespace {

bool is_grid(const Quantity& quantity) {
  return std::holds_alternative<RasterFile>(quantity) || std::holds_alternative<SharedGrid>(quantity);
}

// What is known of the ground between samples says nothing of them, but that rasters may lack values.
ErrorModel of_samples_alone(ErrorModel model) {
  if (!is_grid(model.geologic_variation)) model.geologic_variation = 0.0;
  model.terrain_types.reset();
  return model;
}

std::size_t count_heights(const Grid<float>& heights, int first_row) {
  std::size_t count = 0;
  for (int r = first_row; r < heights.rows(); ++r) {
    const float* row = heights.row(r);
    count += static_cast<std::size_t>(
        std::count_if(row, row + heights.cols(), [](float z) { return !std::isnan(z); }));
  }
  return count;
}

}  // namespace

ToleranceWindows::ToleranceWindows(const DemSource& source, const Window& window, const ErrorModel& model,
                                   double factor, const SharedGrid& keep, const Workers& workers)
    : source_(source),
      window_(window),
      model_(of_samples_alone(model)),
      georeference_(georeference_of(source)),
      factor_(factor),
      keep_(keep),
      workers_(workers) {
  if (keep && (keep->rows() != source.rows() || keep->cols() != source.cols())) {
    throw InvalidInput("keep has " + std::to_string(keep->rows()) + " x " + std::to_string(keep->cols()) +
                       " values, the DEM " + std::to_string(source.rows()) + " x " +
                       std::to_string(source.cols()) + "; give one for each cell.");
  }
  const double* metres = std::get_if<double>(&model_.vertical_rmse);
  if (metres != nullptr && !(model_.horizontal_rmse > 0)) {
    constant_ = least_ = largest_ = factor * static_cast<double>(static_cast<float>(*metres));
  }
}

DemWindow ToleranceWindows::read(const Window& wanted, Progress& progress) {
  const Window window{window_.col + wanted.col, window_.row + wanted.row, wanted.cols, wanted.rows};
  DemWindow result;
  result.heights = source_.read(window, progress);
  const int fresh = std::max(rows_seen_ - wanted.row, 0);
  const std::size_t before = count_heights(result.heights, fresh);
  std::vector<std::string> told;
  ErrorField error =
      resolve_error(model_, source_, georeference_, window, result.heights, told, workers_, progress);
  if (fresh < wanted.rows) {
    lost_ += before - count_heights(result.heights, fresh);
    rows_seen_ = wanted.row_end();
  }
  if (!error.sampling.is_constant()) {
    result.tolerance = error.sampling.release();
    for (std::size_t n = 0; n < result.tolerance.size(); ++n) {
      float& tolerance = result.tolerance.data()[n];
      tolerance = static_cast<float>(factor_ * static_cast<double>(tolerance));
      if (std::isnan(result.heights.data()[n])) continue;
      least_ = std::min(least_, static_cast<double>(tolerance));
      largest_ = std::max(largest_, static_cast<double>(tolerance));
    }
  }
  if (keep_) {
    result.keep = Grid<std::uint8_t>(window.rows, window.cols);
    for (int r = 0; r < window.rows; ++r) {
      const float* row = keep_->row(window.row + r) + window.col;
      std::transform(row, row + window.cols, result.keep.row(r), [](float value) { return value > 0; });
    }
  }
  return result;
}

std::vector<std::string> ToleranceWindows::warnings() const {
  if (lost_ == 0) return {};
  const std::string what = is_grid(model_.geologic_variation)
                               ? (is_grid(model_.vertical_rmse) ? "The error model" : "geologic_variation")
                               : "vertical_rmse";
  return {what + " has no value at " + std::to_string(lost_) + " of " + std::to_string(window_.cells()) +
          " cells where the DEM has a height; the ground there counts as unknown."};
}

}  // namespace sightbound
