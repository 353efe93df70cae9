// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/cells_in_doubt.h"

#include <algorithm>
#include <bit>

namespace sightbound {

namespace {

// What decides must be found anew for each of them; what is seen is kept for all of one.
constexpr int kMostSixteens = 16;
constexpr double kShareOfBounds = 0.1;  // of the time

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// All blocks of all views; `f(view, block)`.
void each_block(std::vector<ProbableView>& views, const Workers& workers, Progress& progress, double share,
                const auto& f) {
  progress.begin(share, static_cast<double>(views.size()));
  for (ProbableView& view : views) {
    const double part = 1.0 / static_cast<double>(view.blocks());
    workers.for_each(view.blocks(), [&](std::size_t block) {
      progress.check();
      f(view, block);
      progress.advance(part);
    });
  }
}

}  // namespace

CellsInDoubt::CellsInDoubt(int rows, int cols, int layers)
    : layers_(layers),
      all_(static_cast<Layers>((1u << layers) - 1)),
      cells_{Grid<Layers>::zeros(rows, cols), Grid<Layers>::zeros(rows, cols),
             Grid<std::uint32_t>::zeros(rows, cols)} {}

void CellsInDoubt::count(std::vector<ProbableView>& views, const EarlyStop& stop, const MemoryBudget& budget,
                         std::size_t taken, const Workers& workers, Progress& progress, double share) {
  each_block(views, workers, progress, kShareOfBounds * share,
             [&](ProbableView& view, std::size_t block) { view.bound(block, cells_); });
  list(budget, taken);
  const int most = stop.looks().back().realisations;
  int drawn = 0;
  for (const Look& look : stop.looks()) {
    const double of_look = (1 - kShareOfBounds) * share * (look.realisations - drawn) / most;
    const int from = drawn;
    while (drawn < look.realisations) {
      const int lanes = std::min(look.realisations - drawn, kMostSixteens * kLanes);
      const Draws draws{static_cast<std::uint32_t>(drawn), (lanes + kLanes - 1) / kLanes};
      draw(views, draws, lanes, workers, progress, of_look * lanes / (look.realisations - from));
      drawn += lanes;
    }
    settle(stop, look, look.realisations == most, workers);
  }
}

// Gives each cell in doubt its place.
void CellsInDoubt::list(const MemoryBudget& budget, std::size_t taken) {
  std::size_t items = at(layers_);  // 0 stands for no place
  for (std::size_t n = 0; n < cells_.open.size(); ++n) {
    Layers& open = cells_.open.data()[n];
    open = static_cast<Layers>(open & ~cells_.seen.data()[n]);
    if (open == 0) continue;
    cells_.item.data()[n] = static_cast<std::uint32_t>(items);
    items += at(layers_);
  }
  budget.require(taken + items * (sizeof(Tally) + kMostSixteens * sizeof(std::uint16_t)),
                 "A probable viewshed with " + std::to_string(items) + " cells in doubt",
                 "Give a smaller max_distance, an extent or fewer heights, or allow a larger memory_budget.");
  tallies_.assign(items, {});
}

void CellsInDoubt::draw(std::vector<ProbableView>& views, const Draws& draws, int lanes,
                        const Workers& workers, Progress& progress, double share) {
  const std::size_t stride = at(draws.sixteens);
  bits_.assign(tallies_.size() * stride, 0);
  each_block(views, workers, progress, share, [&](ProbableView& view, std::size_t block) {
    view.look(block, cells_, draws, {bits_.data(), stride});
  });
  // Of the last sixteen some may not be wanted.
  const int rest = lanes % kLanes;
  const auto of_last = static_cast<std::uint16_t>(rest == 0 ? 0xFFFF : (1u << rest) - 1);
  constexpr std::size_t kItems = 1 << 14;  // at a time
  workers.for_each((tallies_.size() + kItems - 1) / kItems, [&](std::size_t n) {
    for (std::size_t i = n * kItems; i < std::min((n + 1) * kItems, tallies_.size()); ++i) {
      Tally& tally = tallies_[i];
      if (tally.settled) continue;
      int seen = tally.seen;
      for (std::size_t k = 0; k < stride; ++k) {
        const std::uint16_t bits = bits_[i * stride + k];
        seen += std::popcount(static_cast<unsigned>(k + 1 < stride ? bits : bits & of_last));
      }
      tally.seen = static_cast<std::uint16_t>(seen);
      tally.realisations = static_cast<std::uint16_t>(tally.realisations + lanes);
    }
  });
}

// Settled heights of a cell are not asked about any more.
void CellsInDoubt::settle(const EarlyStop& stop, const Look& look, bool last, const Workers& workers) {
  workers.for_each(at(cells_.open.rows()), [&](std::size_t row) {
    for (int col = 0; col < cells_.open.cols(); ++col) {
      Layers& open = cells_.open.at(static_cast<int>(row), col);
      for (unsigned layers = open; layers != 0; layers &= layers - 1) {
        const int layer = std::countr_zero(layers);
        Tally& tally = tallies_[cells_.item.at(static_cast<int>(row), col) + at(layer)];
        if (!last && !stop.is_settled(static_cast<double>(tally.seen) / tally.realisations, look)) continue;
        tally.settled = 1;
        open = static_cast<Layers>(open & ~(1u << layer));
      }
    }
  });
}

CellsInDoubt::Answer CellsInDoubt::answer(int row, int col, int layer, int most) const {
  if (cells_.seen.at(row, col) >> layer & 1) return {1, most, true};
  const std::uint32_t item = cells_.item.at(row, col);
  const Tally& tally = tallies_[item + at(layer)];
  if (item == 0 || tally.realisations == 0) return {0, most, true};
  return {static_cast<double>(tally.seen) / tally.realisations, tally.realisations, false};
}

}  // namespace sightbound
