// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/original_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"

namespace sightbound {

OriginalTin::OriginalTin(const Tin& tin, const Tin& frame) : tin_(tin) {
  if (tin.metres_per_unit != frame.metres_per_unit) {
    throw InvalidInput("original and simplified have different units of length in plan (" +
                       std::to_string(tin.metres_per_unit) + " and " + std::to_string(frame.metres_per_unit) +
                       " m); bring them into one CRS.");
  }
  const Xyz apart = tin.origin - frame.origin;
  shift_ = {apart.x * tin.metres_per_unit, apart.y * tin.metres_per_unit, apart.z};
}

bool OriginalTin::face(std::size_t number, Corners& corners) const {
  const Face& face = tin_.faces[number];
  for (std::size_t i = 0; i < 3; ++i) corners[i] = static_cast<std::size_t>(face[i]);
  return true;
}

OriginalDem::OriginalDem(Grid<float> heights, const Geotransform& geotransform, const Tin& frame)
    : heights_(std::move(heights)),
      to_frame_(geotransform.seen_from({frame.origin.x, frame.origin.y}, frame.metres_per_unit)),
      lowest_(frame.origin.z) {
  if (heights_.rows() < 2 || heights_.cols() < 2)
    throw InvalidInput("original has " + std::to_string(heights_.rows()) + " x " +
                       std::to_string(heights_.cols()) + " samples; it must have 2 x 2 at least.");
}

std::size_t OriginalDem::faces() const {
  return 2 * static_cast<std::size_t>(heights_.rows() - 1) * static_cast<std::size_t>(heights_.cols() - 1);
}

Xyz OriginalDem::place(std::size_t vertex) const {
  const auto cols = static_cast<std::size_t>(heights_.cols());
  const Xy p = to_frame_.of_sample(static_cast<double>(vertex % cols), static_cast<double>(vertex / cols));
  return {p.x, p.y, static_cast<double>(heights_.data()[vertex]) - lowest_};
}

bool OriginalDem::face(std::size_t number, Corners& corners) const {
  const auto cols = static_cast<std::size_t>(heights_.cols());
  const std::size_t square = number / 2, row = square / (cols - 1), col = square % (cols - 1);
  const std::size_t nw = row * cols + col, sw = nw + cols, se = sw + 1, ne = nw + 1;
  corners = number % 2 == 0 ? Corners{nw, sw, se} : Corners{nw, se, ne};
  return std::ranges::none_of(corners, [&](std::size_t n) { return std::isnan(heights_.data()[n]); });
}

}  // namespace sightbound
