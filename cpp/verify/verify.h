// SPDX-License-Identifier: GPL-3.0-or-later
// How far a simplified TIN is from its original, certified: knows nothing of how it was made.
//
// Height fields (verify_heights): both are piecewise linear, so their vertical deviation is linear on each
// piece of the overlay of the two triangulations, and so is the tolerance E on each face of the original.
// Deviation and deviation / E are therefore largest at corners of pieces: at vertices of the one in a face of
// the other, and where edges cross. All corners of all pieces are looked at, and each bound is outward of its
// rounding. O(pieces); the simplified faces lie in bins (some 200 bytes each), the original is read face by
// face.
// Any TIN (verify_distances): the distance to a surface changes no faster than the place (it is 1-Lipschitz),
// so it is bounded around every sample. Both surfaces are sampled the finer, the nearer a place may come to
// the largest distance, until no bound is more than a resolution above the truth.
//
//   1 largest_deviation.bound is not below the deviation at any place of the common footprint
//   2 largest_ratio.bound likewise of deviation / E (distances with a tolerance that varies: of the
//   original's
//     places)
//   3 flipped, folded and degenerate faces are counted one by one, uncovered and surplus area measured
//   4 the same report for any number of threads
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "verify/original_surface.h"

#include "base/progress.h"
#include "terrain/tin.h"

namespace sightbound {

// What the simplified TIN may be away from the original, more than 0 metres: one number, or one for each
// vertex of the original, linear between them.
struct Tolerance {
  double metres = 0;                     // used when of_vertices is empty
  std::span<const float> of_vertices{};  // NaN only where a DEM has no sample
};

struct VerifyOptions {
  // verify_distances: what bounds are above the truth at most; 0 = a 64th of the largest distance or of the
  // tolerance. Coarser where half a million triangles at once do not do; the report says so.
  double resolution_m = 0;
  int threads = 0;  // 0 = all cores
};

struct Extreme {
  double bound = 0;     // certified, outward
  double measured = 0;  // at corners of pieces, or at places looked at
  Xyz place;            // CRS; on the simplified TIN
  std::size_t simplified_face = 0;
};

// Faces of the simplified TIN with a defect.
struct FaceCount {
  std::size_t count = 0;
  std::size_t first = 0;  // number of the first of them
};

struct Area {
  double m2 = 0;
  Xyz place;  // CRS; in plan the middle of the face with most of it
};

// Of the deviation at the original's vertices, in bins of one width.
struct Histogram {
  double low = 0, high = 0;  // metres
  std::vector<std::size_t> counts;
};

struct VerifyReport {
  std::string method;                  // "vertical" or "distance"
  Extreme largest_deviation;           // metres, absolute
  Extreme largest_ratio;               // deviation / tolerance
  FaceCount flipped;                   // they look down (vertical)
  FaceCount folded;                    // others of the simplified lie above or below them (vertical)
  FaceCount degenerate;                // without width in plan (vertical), or without area
  Area uncovered;                      // of the original's plan that no simplified face covers (vertical)
  Area surplus;                        // of the simplified beyond the original (vertical)
  std::size_t uncovered_vertices = 0;  // of the original
  double resolution_m = 0;             // the bounds are at most about that much above the truth
  std::size_t original_faces = 0, simplified_faces = 0;
  std::size_t pieces = 0;                        // looked at; of distances: triangles
  double mean_deviation = 0, rms_deviation = 0;  // at the original's vertices, metres
  Histogram histogram;
  // Simplified less original at each vertex of the original (distance: without sign), metres; NaN where
  // uncovered or no part of the surface.
  std::vector<float> vertex_deviation;

  bool within_tolerance() const { return largest_ratio.bound <= 1; }
  bool well_formed() const { return flipped.count + folded.count + degenerate.count == 0; }
};

// The original must be a height field; where it is not, of faces above one another each is compared. Throws
// InvalidInput (an empty TIN, an index out of range, a coordinate that is not finite, a tolerance that is not
// more than 0 or has the wrong length), Cancelled. Takes all of `progress`.
VerifyReport verify_heights(const OriginalSurface& original, const Tin& simplified, const Tolerance&,
                            const VerifyOptions&, Progress&);

// Both ways: from all of the simplified to the original and back.
VerifyReport verify_distances(const Tin& original, const Tin& simplified, const Tolerance&,
                              const VerifyOptions&, Progress&);

// The one or the other: heights where the original is a height field (terrain/tin_height_field.h).
VerifyReport verify(const Tin& original, const Tin& simplified, const Tolerance&, const VerifyOptions&,
                    Progress&);

}  // namespace sightbound
