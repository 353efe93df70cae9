// SPDX-License-Identifier: GPL-3.0-or-later
// Height fields: the vertical deviation from the original, exact, with nothing lost to voxels.
//
// Each face knows the original faces under it. A new face and these cut each other into convex pieces in
// plan; on each of them new height, original height and tolerance are linear, so that all of it is within the
// tolerance when its corners are. At each corner the new height is linear in the height of the new vertex: an
// interval for it, whose middle is taken, since that leaves most to the collapses to come. The footprint of a
// star stays the same, so the originals under its new faces are those under its old ones. Where the outline
// may move it does not: it may come back over ground that it gave up, and originals are looked up by their
// place.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "simplify/containment.h"
#include "simplify/plan_index.h"

namespace sightbound {

class HeightContainment final : public Containment {
 public:
  // metres at each vertex, linear on each face; less kWrittenSlack, which is more than rounding below 1000
  // km. `original` must outlive this and be a height field.
  HeightContainment(const Tin& original, std::vector<float> tolerance, bool outline_moves);

  std::optional<Xyz> place(const StarChange&) override;
  void made(const StarChange&) override;
  std::optional<FaceDeviation> deviation_of(std::int32_t face, const std::array<Xyz, 3>&) const override;

  // Bytes a face of the original takes, about.
  static constexpr std::size_t kBytesPerFace = 80;

 private:
  struct Interval {
    double low, high;
  };
  using Triangle = std::array<Xyz, 3>;
  // A triangle seen in plan from a place near it, so that products of large coordinates cancel nothing.
  struct Flat {
    Flat(const Triangle&, const Xyz& here);
    bool meets(const Flat& o) const {
      return low_x <= o.high_x && o.low_x <= high_x && low_y <= o.high_y && o.low_y <= high_y;
    }
    Triangle at;
    double low_x, low_y, high_x, high_y;
  };

  void gather(const StarChange&);
  Triangle original(std::int32_t face) const;
  bool narrow(const Flat& made, std::size_t moved, std::size_t n, Interval& heights) const;

  const Tin& original_;
  std::vector<float> tolerance_;
  std::optional<PlanIndex> index_;                  // of the originals, where the outline may move
  std::vector<std::vector<std::int32_t>> beneath_;  // originals under each face, ascending
  std::vector<std::int32_t> near_;                  // under the star
  std::vector<Flat> flat_;                          // these, seen from the new vertex
};

}  // namespace sightbound
