// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/plan_mask.h"

#include <algorithm>

namespace sightbound {

namespace {
// Which bits of the word that begins at `first` (columns) lie within [0, end).
std::uint64_t inside_bits(int first_i, int first_j, int end_i, int end_j) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 8 && first_i + i < end_i; ++i) {
    for (int j = 0; j < 8 && first_j + j < end_j; ++j) bits |= std::uint64_t{1} << (i * 8 + j);
  }
  return bits;
}
}  // namespace

PlanMask::PlanMask(int cols, int rows, bool outside)
    : cols_(cols),
      rows_(rows),
      words_across_((cols + 7) / 8),
      words_down_((rows + 7) / 8),
      blocks_across_((cols + 127) / 128),
      blocks_down_((rows + 127) / 128),
      outside_(outside),
      words_(static_cast<std::size_t>(words_across_) * static_cast<std::size_t>(words_down_), 0),
      blocks_(static_cast<std::size_t>(blocks_across_) * static_cast<std::size_t>(blocks_down_),
              PlanState::kNone) {
  for (int j8 = 0; j8 < words_down_; ++j8) {
    for (int i8 = 0; i8 < words_across_; ++i8) {
      if (i8 + 1 == words_across_ || j8 + 1 == words_down_) set_8(i8, j8, 0);
    }
  }
  summarise();
}

PlanState PlanMask::of_128(int i128, int j128) const {
  if (i128 < 0 || j128 < 0 || i128 >= blocks_across_ || j128 >= blocks_down_) {
    return outside_ ? PlanState::kAll : PlanState::kNone;
  }
  return blocks_[static_cast<std::size_t>(j128) * static_cast<std::size_t>(blocks_across_) +
                 static_cast<std::size_t>(i128)];
}

std::size_t PlanMask::count() const {
  std::size_t count = 0;
  for (int j8 = 0; j8 < words_down_; ++j8) {
    for (int i8 = 0; i8 < words_across_; ++i8) {
      count +=
          static_cast<std::size_t>(std::popcount(word(i8, j8) & inside_bits(8 * i8, 8 * j8, cols_, rows_)));
    }
  }
  return count;
}

void PlanMask::set_8(int i8, int j8, std::uint64_t bits) {
  const std::uint64_t inside = inside_bits(8 * i8, 8 * j8, cols_, rows_);
  words_[static_cast<std::size_t>(j8) * static_cast<std::size_t>(words_across_) +
         static_cast<std::size_t>(i8)] = (bits & inside) | (outside_ ? ~inside : 0);
}

void PlanMask::summarise() {
  for (int b = 0; b < blocks_down_; ++b) {
    for (int a = 0; a < blocks_across_; ++a) {
      bool all = true, none = true;
      for (int j8 = 16 * b; j8 < 16 * b + 16; ++j8) {
        for (int i8 = 16 * a; i8 < 16 * a + 16; ++i8) {
          const PlanState state = of_8(i8, j8);
          all = all && state == PlanState::kAll;
          none = none && state == PlanState::kNone;
        }
      }
      blocks_[static_cast<std::size_t>(b) * static_cast<std::size_t>(blocks_across_) +
              static_cast<std::size_t>(a)] = all    ? PlanState::kAll
                                             : none ? PlanState::kNone
                                                    : PlanState::kSome;
    }
  }
}

}  // namespace sightbound
