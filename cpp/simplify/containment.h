// SPDX-License-Identifier: GPL-3.0-or-later
// What decides whether a collapse may be made: whether all the faces that it makes are where a surface may
// be.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "terrain/tin.h"
#include "volume/permission_grid.h"

namespace sightbound {

struct FaceChange {
  std::int32_t face = 0;
  std::array<Xyz, 3> after;
  std::size_t moved = 0;  // the corner that is drawn to the new place
};

struct StarChange {
  std::vector<std::int32_t> gone;  // faces
  std::vector<FaceChange> changed;
  Xyz to;
  bool free_height = false;  // it may be put higher or lower
};

// The largest on a face.
struct FaceDeviation {
  double metres = 0;  // rounded up
  double ratio = 0;   // of deviation to tolerance; 0 where both are
};

class Containment {
 public:
  virtual ~Containment() = default;
  // Where the new vertex may be: at `to`, or above or below it where that is free. Nothing: nowhere there.
  virtual std::optional<Xyz> place(const StarChange&) = 0;
  // It was made, as it stands, with the new vertex where place() said, or without any change of the surface.
  virtual void made(const StarChange&) {}
  // Of a face as it is now; nothing where that is not known.
  virtual std::optional<FaceDeviation> deviation_of(std::int32_t /*face*/, const std::array<Xyz, 3>&) const {
    return {};
  }
};

// Every face that is made lies wholly in a permission grid.
class GridContainment final : public Containment {
 public:
  // `shift`: from the Tin's own coordinates to the grid's, subtracted.
  GridContainment(PermissionGrid grid, const Xyz& shift) : grid_(std::move(grid)), shift_(shift) {}

  std::optional<Xyz> place(const StarChange& change) override {
    const Xyz to = change.to - shift_;
    if (!grid_.holds({to, to, to})) return {};
    for (const FaceChange& f : change.changed) {
      if (!grid_.holds({f.after[0] - shift_, f.after[1] - shift_, f.after[2] - shift_})) return {};
    }
    return change.to;
  }

 private:
  PermissionGrid grid_;
  Xyz shift_;
};

// Nothing but what leaves the surface as it is.
class NothingContained final : public Containment {
 public:
  std::optional<Xyz> place(const StarChange&) override { return {}; }
};

}  // namespace sightbound
