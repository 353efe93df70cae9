// SPDX-License-Identifier: GPL-3.0-or-later
// Besides what another containment asks of new faces: every place of the original keeps the surface near.
//
// The distance from one triangle is a convex function, and the tolerance linear on an original face. So a
// piece of it is within the tolerance when its three corners are within theirs of one and the same face; a
// face whose corners are not is cut into four pieces, a few times. For each original face the faces are kept
// that prove it; only a change of one of them asks again, with the new faces of the star in the place of the
// old ones.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "simplify/containment.h"

namespace sightbound {

class BothWays final : public Containment {
 public:
  // metres at each vertex of the original, linear on its faces. `original` and `forward` must outlive this.
  BothWays(const Tin& original, std::vector<float> tolerance, Containment& forward);

  std::optional<Xyz> place(const StarChange&) override;
  void made(const StarChange&) override;

  // Bytes a face of the original takes, about.
  static constexpr std::size_t kBytesPerFace = 260;

 private:
  using Triangle = std::array<Xyz, 3>;
  struct Near {  // a face that may prove something
    std::int32_t face;
    Triangle at;
  };

  void gather(const StarChange&);
  void candidates_for(std::int32_t original, const StarChange&);
  bool covered(const Triangle& piece, const std::array<double, 3>& tolerance, int depth);
  bool is_covered(std::int32_t original);

  const Tin& original_;
  Containment& forward_;
  std::vector<float> tolerance_;                   // at each vertex of the original
  std::vector<Triangle> faces_;                    // as they are now
  std::vector<std::vector<std::int32_t>> proved_;  // originals by each face, ascending
  std::vector<std::vector<std::int32_t>> by_;      // faces that prove each original, ascending
  std::vector<std::int32_t> near_;                 // originals that the star proves
  std::vector<Near> candidates_;
  std::vector<std::int32_t> used_;
};

}  // namespace sightbound
