// SPDX-License-Identifier: GPL-3.0-or-later
// How the hot loops are written once for every processor. Marked functions are compiled several times and the
// best version for the machine is taken when the program starts; none of them reorders or contracts an
// operation.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(SIGHTBOUND_SCALAR)
#define SIGHTBOUND_VECTOR __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define SIGHTBOUND_VECTOR
#endif
// A part of such a function: compiled with it, not once for the plainest processor.
#if defined(__GNUC__)
#define SIGHTBOUND_INLINE inline __attribute__((always_inline))
#else
#define SIGHTBOUND_INLINE inline
#endif

namespace sightbound {

// One instruction each, also in vectors; NaN gives b.
inline float smaller(float a, float b) { return a < b ? a : b; }
inline float larger(float a, float b) { return a > b ? a : b; }

}  // namespace sightbound
