// SPDX-License-Identifier: GPL-3.0-or-later
// A target's answer is one number of a tree of 32-bit numbers: verdict in the upper half of the bits, p as a
// half float in the lower. Active: targets with a verdict. Tree coordinates (i, j, k) are the lattice's.
#include "volume/hidden_volume.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <openvdb/tools/Prune.h>

#include "base/error.h"
#include "volume/vdb_block.h"
#include "volume/vdb_hidden.h"

namespace sightbound {

namespace {

// Fills one leaf's place in the stack, as a tile when all of it is alike.
void add_leaf(const TargetLattice& lattice, const std::vector<std::size_t>& begins,
              const std::vector<std::int32_t>& packed, const openvdb::Coord& origin,
              NodeStack<AnswerTree>& stack) {
  auto leaf = std::make_unique<AnswerTree::LeafNodeType>(origin, kNoAnswer, false);
  for (int x = 0; x < 8 && origin.x() + x < lattice.nx; ++x) {
    for (int y = 0; y < 8 && origin.y() + y < lattice.ny; ++y) {
      const std::size_t n = lattice.number(origin.x() + x, origin.y() + y);
      const TargetColumn& column = lattice.columns[n];
      const int last = std::min(column.last, origin.z() + 7);
      for (int k = std::max(column.first, origin.z()); k <= last; ++k) {
        const std::int32_t answer = packed[begins[n] + static_cast<std::size_t>(k - column.first)];
        if (answer == kNoAnswer) continue;
        leaf->setValueOn(static_cast<openvdb::Index>(x << 6 | y << 3 | (k & 7)), answer);
      }
    }
  }
  if (leaf->isEmpty()) return;
  std::int32_t same = 0;
  bool active = false;
  if (leaf->isConstant(same, active)) {
    stack.add_tile(origin, same, active);
  } else {
    stack.add(std::move(leaf));
  }
}

void add_columns_of_8(const TargetLattice& lattice, const std::vector<std::size_t>& begins,
                      const std::vector<std::int32_t>& packed, int i8, int j8, NodeStack<AnswerTree>& stack) {
  int low = 0, high = -1;
  for (int j = 8 * j8; j < std::min(8 * j8 + 8, lattice.ny); ++j) {
    for (int i = 8 * i8; i < std::min(8 * i8 + 8, lattice.nx); ++i) {
      const TargetColumn& column = lattice.column(i, j);
      if (column.size() == 0) continue;
      low = high < low ? column.first : std::min(low, column.first);
      high = std::max(high < low ? column.last : high, column.last);
    }
  }
  if (high < low) return;
  for (int k8 = floor_div(low, 8); k8 <= floor_div(high, 8); ++k8)
    add_leaf(lattice, begins, packed, {8 * i8, 8 * j8, 8 * k8}, stack);
}

std::vector<std::string> put_together(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::vector<std::string> all = a;
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

// `both` decides where both have a verdict; where one has, it stands when `alone`.
template <class Both>
HiddenVolume combined(const HiddenVolume& a, const HiddenVolume& b, bool alone, const char* name, Both both) {
  if (&a.lattice() != &b.lattice() && !(a.lattice() == b.lattice())) {
    throw InvalidInput(
        "The two hidden volumes have different targets (spacing, ceiling or terrain); make both with the "
        "same "
        "targets.");
  }
  if (a.info().confidence != b.info().confidence) {
    throw InvalidInput("The two hidden volumes have different confidences (" +
                       std::to_string(a.info().confidence) + " and " + std::to_string(b.info().confidence) +
                       "): their verdicts are different claims. Make both with one confidence.");
  }
  const TargetLattice& lattice = a.lattice();
  HiddenVolumeBuilder builder(a.shared_lattice());
  const Workers workers;
  workers.for_each(static_cast<std::size_t>(lattice.ny), [&](std::size_t row) {
    const int j = static_cast<int>(row);
    std::vector<TargetAnswer> of_a, of_b;
    for (int i = 0; i < lattice.nx; ++i) {
      of_a.resize(static_cast<std::size_t>(lattice.column(i, j).size()));
      of_b.resize(of_a.size());
      a.column(i, j, of_a);
      b.column(i, j, of_b);
      for (std::size_t n = 0; n < of_a.size(); ++n) {
        const bool in_a = of_a[n].verdict != kNoVerdict, in_b = of_b[n].verdict != kNoVerdict;
        if (in_a && in_b) {
          of_a[n] = both(of_a[n], of_b[n]);
        } else if (!alone) {
          of_a[n] = {};
        } else if (in_b) {
          of_a[n] = of_b[n];
        }
      }
      builder.set_column(i, j, of_a);
    }
  });
  HiddenVolumeInfo info = a.info();
  info.observers = put_together(a.info().observers, b.info().observers);
  info.operations = put_together(a.info().operations, b.info().operations);
  info.operations.emplace_back(name);
  return builder.finish(std::move(info), workers);
}

}  // namespace

HiddenVolume::HiddenVolume(std::shared_ptr<const TargetLattice> lattice, std::shared_ptr<const Trees> trees,
                           HiddenVolumeInfo info)
    : lattice_(std::move(lattice)), trees_(std::move(trees)), info_(std::move(info)) {}
HiddenVolume::HiddenVolume(HiddenVolume&&) noexcept = default;
HiddenVolume& HiddenVolume::operator=(HiddenVolume&&) noexcept = default;
HiddenVolume::~HiddenVolume() = default;

std::size_t HiddenVolume::bytes() const {
  return trees_->answers.memUsage() + lattice_->columns.size() * sizeof(TargetColumn);
}

TargetAnswer HiddenVolume::at(int i, int j, int k) const {
  return unpack_answer(trees_->answers.getValue({i, j, k}));
}

void HiddenVolume::column(int i, int j, std::span<TargetAnswer> answers) const {
  const TargetColumn& column = lattice_->column(i, j);
  openvdb::tree::ValueAccessor<const AnswerTree> tree(trees_->answers);
  for (int k = column.first; k <= column.last; ++k)
    answers[static_cast<std::size_t>(k - column.first)] = unpack_answer(tree.getValue({i, j, k}));
}

VerdictVolumes HiddenVolume::volumes() const {
  std::array<std::uint64_t, 3> count{};
  for (auto it = trees_->answers.cbeginValueOn(); it; ++it) {
    const std::uint8_t verdict = unpack_answer(*it).verdict;
    if (verdict <= kVisible) count[verdict] += it.getVoxelCount();
  }
  const auto m3 = [&](std::uint8_t v) { return static_cast<double>(count[v]) * lattice_->target_m3(); };
  return {m3(kHidden), m3(kUncertain), m3(kVisible)};
}

bool operator==(const HiddenVolume& a, const HiddenVolume& b) {
  if (!(*a.lattice_ == *b.lattice_)) return false;
  const AnswerTree &p = a.trees_->answers, &q = b.trees_->answers;
  if (p.activeVoxelCount() != q.activeVoxelCount() || !p.hasSameTopology(q)) return false;
  auto i = p.cbeginValueOn(), j = q.cbeginValueOn();
  for (; i && j; ++i, ++j) {
    if (*i != *j) return false;
  }
  return !i && !j;
}

HiddenVolumeBuilder::HiddenVolumeBuilder(std::shared_ptr<const TargetLattice> lattice)
    : lattice_(std::move(lattice)) {
  begins_.reserve(lattice_->columns.size());
  std::size_t targets = 0;
  for (const TargetColumn& column : lattice_->columns) {
    begins_.push_back(targets);
    targets += static_cast<std::size_t>(column.size());
  }
  packed_.assign(targets, kNoAnswer);
}

void HiddenVolumeBuilder::set_column(int i, int j, std::span<const TargetAnswer> answers) {
  std::int32_t* out = packed_.data() + begins_[lattice_->number(i, j)];
  for (const TargetAnswer& answer : answers) *out++ = pack_answer(answer);
}

HiddenVolume HiddenVolumeBuilder::finish(HiddenVolumeInfo info, const Workers& workers) {
  const int across = (lattice_->nx + 127) / 128, down = (lattice_->ny + 127) / 128;
  std::vector<NodeStack<AnswerTree>> stacks(static_cast<std::size_t>(across) *
                                            static_cast<std::size_t>(down));
  workers.for_each(stacks.size(), [&](std::size_t n) {
    const int a = static_cast<int>(n) % across, b = static_cast<int>(n) / across;
    NodeStack<AnswerTree> stack(a, b, kNoAnswer);
    for (int j8 = 16 * b; j8 < 16 * b + 16 && 8 * j8 < lattice_->ny; ++j8) {
      for (int i8 = 16 * a; i8 < 16 * a + 16 && 8 * i8 < lattice_->nx; ++i8)
        add_columns_of_8(*lattice_, begins_, packed_, i8, j8, stack);
    }
    stacks[n] = std::move(stack);
  });
  auto trees = std::make_shared<HiddenVolume::Trees>();
  put_together(stacks, trees->answers);
  openvdb::tools::prune(trees->answers, 0, /*threaded=*/false);
  packed_ = {};
  begins_ = {};
  return {std::move(lattice_), std::move(trees), std::move(info)};
}

std::size_t HiddenVolumeBuilder::bytes_needed(const TargetLattice& lattice) {
  // Leaves are filled by a fifth at worst (one layer in eight, or two that part two leaves).
  return lattice.columns.size() * (sizeof(TargetColumn) + sizeof(std::size_t)) +
         lattice.targets() * 6 * sizeof(std::int32_t);
}

HiddenVolume union_of_seen(const HiddenVolume& a, const HiddenVolume& b) {
  return combined(a, b, true, "union of seen", better_of);
}

HiddenVolume intersection_of_seen(const HiddenVolume& a, const HiddenVolume& b) {
  return combined(a, b, false, "intersection of seen", worse_of);
}

HiddenVolume difference_of_seen(const HiddenVolume& a, const HiddenVolume& b) {
  return combined(a, b, false, "difference of seen", [](const TargetAnswer& p, const TargetAnswer& q) {
    return p.verdict == kVisible ? TargetAnswer{0, kHidden} : q;
  });
}

}  // namespace sightbound
