// SPDX-License-Identifier: GPL-3.0-or-later
// A set of voxel columns, with summaries for squares of 8 and of 128 columns: 1 bit a column.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sightbound {

enum class PlanState : std::uint8_t { kNone, kSome, kAll };

class PlanMask {
 public:
  PlanMask() = default;
  // Columns [0, cols) x [0, rows) in i and j, none of them set; all columns outside count as `outside`.
  PlanMask(int cols, int rows, bool outside);

  int cols() const { return cols_; }
  int rows() const { return rows_; }
  bool at(int i, int j) const {
    if (i < 0 || j < 0 || i >= cols_ || j >= rows_) return outside_;
    return word(i >> 3, j >> 3) >> ((i & 7) * 8 + (j & 7)) & 1;
  }
  // Of the 8 x 8 columns from (8 i8, 8 j8), and of the 128 x 128 from (128 i128, 128 j128).
  PlanState of_8(int i8, int j8) const {
    if (i8 < 0 || j8 < 0 || i8 >= words_across_ || j8 >= words_down_)
      return outside_ ? PlanState::kAll : PlanState::kNone;
    const std::uint64_t bits = word(i8, j8);
    return bits == 0 ? PlanState::kNone : ~bits == 0 ? PlanState::kAll : PlanState::kSome;
  }
  PlanState of_128(int i128, int j128) const;
  std::size_t count() const;  // of columns set within

  // Bit 8 (i & 7) + (j & 7) of the 8 x 8 columns from (8 i8, 8 j8); bits beyond cols and rows become
  // `outside`. Different squares of 128 may be set at the same time; call summarise() at the end.
  void set_8(int i8, int j8, std::uint64_t bits);
  void summarise();

  std::size_t bytes() const { return words_.size() * sizeof(std::uint64_t) + blocks_.size(); }
  const std::vector<std::uint64_t>& words() const { return words_; }

 private:
  std::uint64_t word(int i8, int j8) const {
    return words_[static_cast<std::size_t>(j8) * static_cast<std::size_t>(words_across_) +
                  static_cast<std::size_t>(i8)];
  }

  int cols_ = 0, rows_ = 0, words_across_ = 0, words_down_ = 0, blocks_across_ = 0, blocks_down_ = 0;
  bool outside_ = false;
  std::vector<std::uint64_t> words_;
  std::vector<PlanState> blocks_;
};

}  // namespace sightbound
