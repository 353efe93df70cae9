// SPDX-License-Identifier: GPL-3.0-or-later
// A DEM compared with the truth: with check points, or with a better DEM of a part of it.
//
// Points: the terrain's height at the point less the point's. Reference: the DEM's sample less the
// reference's height there, or less the reference's mean over the cell where the DEM holds means. What comes
// of the residuals: check_points.h. Both look for a shift sideways first (horizontal_shift.h).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "error_model/check_points.h"
#include "error_model/error_model.h"
#include "terrain/dem.h"
#include "terrain/tin.h"

namespace sightbound {

// Of a reference that covers more, this many tiles spread evenly over the overlap are compared.
inline constexpr std::size_t kMostCheckTiles = 64;
inline constexpr int kCheckTileSide = 256;                 // samples, fewer for a very fine reference
inline constexpr std::size_t kMostJudgedPlaces = 400'000;  // of those compared, evenly chosen

struct ErrorCheckOptions {
  CellContent content = CellContent::kSamples;
  bool correct_shift = false;            // judge the DEM that is left when the shift found is taken off
  std::optional<Correction> correction;  // that is to be taken off whatever shift is found
  int threads = 0;                       // 0 = all cores
};

// `completed` says what lies between the samples (resolve_error.h). Points in the DEM's CRS, metres. Throws
// InvalidInput when fewer than kFewestChecks lie on heights of the DEM; IoError, Cancelled.
ErrorCheck check_with_points(const DemSource&, const ErrorModel& completed, std::span<const Xyz> points,
                             const ErrorCheckOptions&, Progress&);

// The reference may have any CRS and cell size. Throws InvalidInput when the two do not overlap; IoError,
// Cancelled.
ErrorCheck check_with_reference(const DemSource&, const DemSource& reference, const ErrorCheckOptions&,
                                Progress&);

// What a cell of the DEM holds, as the reference shows: with which of the two it agrees better, the shift
// taken off. Empty where it does not tell: the two agree alike (within 10 % of the NMAD), as when the cells
// are of one size, or the ground is too flat or too little of it was compared.
std::optional<CellContent> content_seen(const DemSource&, const DemSource& reference, Progress&);

// A shift along the axes of the DEM's CRS, metres on the ground.
struct MapShift {
  double east = 0, north = 0, up = 0;
  double se_east = 0, se_north = 0, se_up = 0;
};
MapShift on_map(const HorizontalShift&, const DemSource&);
MapShift on_map(const Correction&, const DemSource&);  // without standard errors

// Writes the DEM with the shift taken off: its geotransform moved, its heights (in metres) lowered by `up`.
// Heights are not interpolated. Throws IoError, InvalidInput, Cancelled.
void write_corrected_dem(const std::string& path, const DemSource&, const MapShift&,
                         const std::vector<std::string>& creation_options, int threads, Progress&);

}  // namespace sightbound
