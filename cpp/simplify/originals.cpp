// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/originals.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "terrain/tin_cleaning.h"

namespace sightbound {

namespace {

// The values of a sample: a height, a tolerance and whether it is kept; as much again while it is made.
constexpr std::size_t kBytesOfSample = 16;

void check_values(const DemWindow& read) {
  for (const float height : read.heights.values()) {
    if (std::abs(height) > static_cast<float>(kLargestCoordinate)) {
      throw InvalidInput("A height of the DEM is " + number_text(height) +
                         "; it must be within 1e9. Make it nodata (NaN).");
    }
  }
  for (std::size_t i = 0; i < read.tolerance.size(); ++i) {
    const float tolerance = read.tolerance.values()[i];
    if (std::isnan(read.heights.values()[i]) || (tolerance >= 0 && std::isfinite(tolerance))) continue;
    throw InvalidInput("tolerance is " + number_text(tolerance) + "; give metres, 0 or more.");
  }
}

// Rounded down: a tolerance is never exceeded.
void multiply(Grid<float>& tolerance, double factor) {
  for (float& value : tolerance.values()) {
    const double wanted = factor * static_cast<double>(value);
    value = static_cast<float>(wanted);
    if (static_cast<double>(value) > wanted) value = std::nextafter(value, 0.0F);
  }
}

}  // namespace

void Originals::set_factor(double factor) {
  factor_ = factor;
  part_.reset();
}

Originals::Part::Part(DemWindow read, double tolerance_m, const Window& where, double place_rounding)
    : window(where),
      dem(std::move(read)),
      original(dem.heights, dem.tolerance, tolerance_m, where, place_rounding) {}

const Originals::Part& Originals::rows_of(int first_row, int last_row, Progress& progress) {
  Window window{0, first_row, cols(), last_row - first_row + 1};
  if (part_ && part_->window.contains(window)) return *part_;
  part_.reset();
  if (static_cast<std::int64_t>(rows()) * cols() <= samples_at_once_) window = {0, 0, cols(), rows()};
  DemWindow read = dem_.read(window, progress);
  check_values(read);
  if (factor_ != 1) multiply(read.tolerance, factor_);
  const double tolerance = factor_ * tolerance_m_;
  part_.emplace(std::move(read), tolerance, window, place_rounding_);
  const Original& original = part_->original;
  if (!original.varying() && tolerance > 0 && tolerance < original.written()) {
    throw InvalidInput("tolerance is " + number_text(tolerance) +
                       "; on slopes as steep as here coordinates as numbers of 53 bits are good for " +
                       number_text(original.written()) +
                       " m. Give more, or 0, or take an offset off the CRS.");
  }
  margin_ = std::max(margin_, original.margin());
  return *part_;
}

int Originals::tiles_at_once(int tile) const {
  return static_cast<int>(std::max<std::int64_t>(samples_at_once_ / cols() / tile, 1));
}

std::size_t Originals::bytes(int tile) const {
  const auto held = std::min<std::int64_t>(rows(), std::int64_t{tiles_at_once(tile)} * tile + 1);
  return static_cast<std::size_t>(held * cols()) * kBytesOfSample;
}

}  // namespace sightbound
