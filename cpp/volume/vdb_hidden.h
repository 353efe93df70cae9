// SPDX-License-Identifier: GPL-3.0-or-later
// The tree of a hidden volume.
#pragma once

#include <bit>
#include <cstdint>

#include <openvdb/openvdb.h>

#include "volume/hidden_volume.h"
#include "volume/ratio_interval.h"

namespace sightbound {

using AnswerTree = openvdb::Int32Tree;

// Of all that is not asked; no packed answer is negative.
inline constexpr std::int32_t kNoAnswer = -1;

struct HiddenVolume::Trees {
  AnswerTree answers{kNoAnswer};
};

inline std::int32_t pack_answer(const TargetAnswer& answer) {
  if (answer.verdict == kNoVerdict) return kNoAnswer;
  const double p = static_cast<double>(answer.p);
  return answer.verdict << 16 | (p >= 0.5 ? half_below(p) : half_above(p));
}

inline TargetAnswer unpack_answer(std::int32_t packed) {
  if (packed == kNoAnswer) return {};
  return {from_half(static_cast<std::uint16_t>(packed & 0xffff)), static_cast<std::uint8_t>(packed >> 16)};
}

}  // namespace sightbound
