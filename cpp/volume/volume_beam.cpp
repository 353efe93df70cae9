// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/vdb_beam_walk.h"
#include "volume/volume_ray.h"

namespace sightbound {

namespace {

bool lies_within(const Section& section, const LinePart& part) {
  return section.begin >= part.begin && section.end <= part.end;
}

}  // namespace

BeamWalk VolumeRays::walk(const VolumeBeam& beam) const {
  return {walked(), beam, volume_.beyond_ratio(), volume_.surface().metric() == Metric::kVertical};
}

bool VolumeRays::clear(const VolumeBeam& beam, const LinePart& part, double ratio, Grain grain) const {
  BeamWalk walk = this->walk(beam);
  if (!walk.runs()) return false;
  const auto least = static_cast<float>(ratio);
  const bool sheet = volume_.surface().sides() == Sides::kSheet;  // either side is clear
  const auto is_clear = [&](float low, float high) { return low >= least || (sheet && high <= -least); };
  return walk.blocks(part.begin, part.end, [&](const Section& section, const Section&, int index) {
    const Found found = walk.of_blocks(
        section, index, Telling::kLowest,
        [&](const BeamBlock& b) { return b.known && is_clear(b.least.low, b.most.high); },
        [&](const BeamBlock& b) { return sheet || b.most.low >= least; });
    if (found != Found::kMaybe || grain == Grain::kBlocks) return found == Found::kYes;
    return walk.voxels(index, part.begin, part.end, [&](const Section& slab, const Section&, int at) {
      return walk.of_voxels(slab, at, Telling::kLowest, [&](const BeamVoxel& v) {
        return v.known && is_clear(v.ratio.low, v.ratio.high);
      });
    });
  });
}

// Is there a section that every line crosses, all of whose voxels stop lines? OfBlock, OfVoxel: whether they
// do; `may`: whether a voxel of the block does.
template <class OfBlock, class OfVoxel, class May>
bool VolumeRays::any_section(const VolumeBeam& beam, const LinePart& part, Grain grain,
                             const OfBlock& of_block, const OfVoxel& of_voxel, const May& may) const {
  BeamWalk walk = this->walk(beam);
  if (!walk.runs()) return false;
  return !walk.blocks(part.begin, part.end, [&](const Section& section, const Section& whole, int index) {
    const Found found = walk.of_blocks(section, index, Telling::kHighest, of_block, may);
    if (found == Found::kYes && lies_within(whole, part)) return false;
    if (found == Found::kNo || grain == Grain::kBlocks) return true;
    return walk.voxels(index, part.begin, part.end, [&](const Section& slab, const Section& all, int at) {
      return !(lies_within(all, part) && walk.of_voxels(slab, at, Telling::kHighest, of_voxel));
    });
  });
}

bool VolumeRays::blocked(const VolumeBeam& beam, const LinePart& part, double ratio, Grain grain) const {
  if (volume_.surface().sides() == Sides::kSheet) return false;
  const auto most = static_cast<float>(-ratio);
  return any_section(
      beam, part, grain, [&](const BeamBlock& b) { return b.known && b.most.high <= most; },
      [&](const BeamVoxel& v) { return v.known && v.ratio.high <= most; },
      [&](const BeamBlock& b) { return b.least.high <= most; });
}

bool VolumeRays::doubtful(const VolumeBeam& beam, const LinePart& part, double ratio, Grain grain) const {
  const auto most = static_cast<float>(ratio);
  return any_section(
      beam, part, grain, [&](const BeamBlock& b) { return b.most.low <= most; },
      [&](const BeamVoxel& v) { return v.ratio.low <= most; },
      [&](const BeamBlock& b) { return b.least.low <= most; });
}

}  // namespace sightbound
