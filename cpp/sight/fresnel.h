// SPDX-License-Identifier: GPL-3.0-or-later
// The first Fresnel zone of a radio link: what an obstacle must keep out of for the link to be nearly as good
// as in free space (ITU-R P.530: 60 % of its radius).
#pragma once

#include <cmath>

namespace sightbound {

inline constexpr double kSpeedOfLight = 299792458;  // metres a second

inline double wavelength_m(double frequency_mhz) { return kSpeedOfLight / (1e6 * frequency_mhz); }

// Radius at a share t of the distance: sqrt(wavelength d1 d2 / D), metres.
inline double first_zone_radius(double wavelength, double distance, double t) {
  return std::sqrt(wavelength * distance * t * (1 - t));
}

}  // namespace sightbound
