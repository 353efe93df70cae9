// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/memory_budget.h"
#include "base/number_text.h"
#include "base/parallel.h"
#include "simplify/block_decimation.h"
#include "simplify/place_rounding.h"
#include "simplify/written_tin.h"

namespace sightbound {

namespace {

constexpr double kShareOfBlocks = 0.6, kShareOfPasses = 0.35;  // of the progress

// A block keeps so many times its part of the target, so that rough blocks may have more than others.
constexpr double kSpareForTarget = 4;

void check_sides(int rows, int cols) {
  const std::string sides = std::to_string(rows) + " x " + std::to_string(cols) + " samples";
  if (rows < 2 || cols < 2) throw InvalidInput("The DEM has " + sides + "; a surface needs 2 x 2 at least.");
  if (rows > kMostCells || cols > kMostCells) {
    throw InvalidInput("The DEM has " + sides + ", more than " + std::to_string(kMostCells) +
                       " a side; give a part of it.");
  }
}

void check(const SimplifyOptions& options) {
  if (!(options.tolerance_m >= 0) || !std::isfinite(options.tolerance_m)) {
    throw InvalidInput("tolerance is " + number_text(options.tolerance_m) + "; give metres, 0 or more.");
  }
  if (options.target_faces < 0) {
    throw InvalidInput("target_faces is " + std::to_string(options.target_faces) +
                       "; give 0 (no target) or more.");
  }
  if (options.block < 1 || options.block > kMostCells) {
    throw InvalidInput("block is " + std::to_string(options.block) + "; give 1 to " +
                       std::to_string(kMostCells) + ".");
  }
  const SimplifyOptions::Bytes& bytes = options.target_bytes;
  if (!(bytes.most >= 0 && bytes.of_vertex >= 0 && bytes.of_face > 0)) {
    throw InvalidInput("target_bytes is " + number_text(bytes.most) + "; give 0 (no target) or more.");
  }
  if (bytes.most > 0 && options.target_faces > 0) {
    throw InvalidInput("target_faces and target_bytes say the same thing; give only one of them.");
  }
  for (const auto& [tolerance, name] : {std::pair{options.border_tolerance_m, "border_tolerance"},
                                        std::pair{options.break_line_tolerance_m, "break_line_tolerance"}}) {
    if (tolerance >= 0 && std::isfinite(tolerance)) continue;
    throw InvalidInput(std::string(name) + " is " + number_text(tolerance) + "; give metres, 0 or more.");
  }
  if (options.keep_border && options.border_tolerance_m > 0)
    throw InvalidInput("keep_border keeps the outline where it is; give no border_tolerance with it.");
  if (!(options.least_gain >= 0 && options.least_gain <= 1)) {
    throw InvalidInput("least_gain is " + number_text(options.least_gain) + "; give a part, 0 to 1.");
  }
}

LineRules line_rules(const SimplifyOptions& options, const DemPlace& place) {
  const auto& g = place.geotransform.coefficients();
  const double unit = place.metres_per_unit;
  return {options.border_tolerance_m,
          options.break_line_tolerance_m,
          {g[1] * unit, g[4] * unit, g[2] * unit, g[5] * unit}};
}

// Tiles wander, so that what lies at a seam in one pass lies inside a tile in another; with odd eighths none
// has its edges at rims of blocks. They grow as faces do: with few of them in a tile, most would lie at
// seams.
PassPlan plan_of(std::size_t n, const Decimation& decimation, const Originals& originals, int block,
                 const LineRules& lines) {
  constexpr std::array<std::array<int, 2>, 4> kShifts{{{1, 1}, {5, 5}, {1, 5}, {5, 1}}};  // eighths of a tile
  constexpr double kFacesOfTile = 1000;
  const double density = static_cast<double>(decimation.mesh().triangles()) /
                         (static_cast<double>(originals.rows()) * originals.cols());
  int tile = block;
  while (tile < kLargestTile * block && density * tile * tile < kFacesOfTile) tile *= 2;
  const auto [x, y] = kShifts[n % kShifts.size()];
  return {.tile = tile, .shift_x = x * tile / 8, .shift_y = y * tile / 8, .lines = lines};
}
constexpr std::size_t kLeastPasses = 3, kMostPasses = 100;

// Until little is gained. Advances `progress` by a share.
void decimate(Decimation& decimation, Originals& originals, const SimplifyOptions& options,
              const LineRules& lines, double share, const Workers& workers, Progress& progress) {
  double left = share;
  for (std::size_t n = 0; n < kMostPasses; ++n) {
    PassPlan plan = plan_of(n, decimation, originals, options.block, lines);
    plan.relax = true;
    plan.share = 0.5 * left;
    left -= plan.share;
    const std::size_t gone = decimation.pass(plan, originals, workers, progress);
    decimation.compact();
    const auto faces = static_cast<double>(decimation.mesh().triangles());
    if (n + 1 >= kLeastPasses && static_cast<double>(gone) < options.least_gain * faces) return;
  }
}

// What is left is weighed in faces or in bytes.
struct Target {
  double most, of_vertex, of_face;

  explicit Target(const SimplifyOptions& options)
      : most(options.target_bytes.most),
        of_vertex(options.target_bytes.of_vertex),
        of_face(options.target_bytes.of_face) {
    if (options.target_faces > 0) {
      most = static_cast<double>(options.target_faces);
      of_vertex = 0;
      of_face = 1;
    }
  }
  bool is_set() const { return most > 0; }
  double faces() const { return most / (of_face + of_vertex / 2); }  // about
  std::size_t collapses_to_go(const PlanMesh& mesh) const {
    const double weight =
        of_vertex * static_cast<double>(mesh.vertices()) + of_face * static_cast<double>(mesh.triangles());
    return weight > most ? static_cast<std::size_t>(std::ceil((weight - most) / (of_vertex + 2 * of_face)))
                         : 0;
  }
};

// Until the target is reached; where the tolerance does not let it be, until little is gained.
void decimate_to_target(Decimation& decimation, const Target& target, Originals& originals,
                        const SimplifyOptions& options, const LineRules& lines, const Workers& workers,
                        Progress& progress) {
  double left = kShareOfPasses;
  std::size_t fruitless = 0;
  for (std::size_t n = 0; n < kMostPasses && fruitless < kLeastPasses; ++n) {
    const std::size_t collapses = target.collapses_to_go(decimation.mesh());
    if (collapses == 0) return;
    PassPlan plan = plan_of(n, decimation, originals, options.block, lines);
    plan.relax = fruitless > 0;
    plan.share = 0.2 * left;
    left -= plan.share;
    const std::size_t gone = decimation.pass_of(collapses, plan, originals, workers, progress);
    decimation.compact();
    const auto faces = static_cast<double>(decimation.mesh().triangles());
    const bool little = gone < collapses / 2 && static_cast<double>(gone) < options.least_gain * faces;
    fruitless = little ? fruitless + 1 : 0;
  }
}

// A DEM that is held by somebody else.
class DemInMemory final : public DemWindows {
 public:
  DemInMemory(const Grid<float>& heights, const SimplifyOptions& options)
      : heights_(heights), tolerance_(options.tolerance), keep_(options.keep) {
    check_size(tolerance_.rows(), tolerance_.cols(), "tolerance");
    check_size(keep_.rows(), keep_.cols(), "keep");
  }
  int rows() const override { return heights_.rows(); }
  int cols() const override { return heights_.cols(); }
  DemWindow read(const Window& window, Progress& progress) override {
    progress.check();
    return {part_of(heights_, window), part_of(tolerance_, window), part_of(keep_, window)};
  }

 private:
  void check_size(int rows, int cols, const std::string& name) const {
    if ((rows == 0 && cols == 0) || (rows == heights_.rows() && cols == heights_.cols())) return;
    throw InvalidInput(name + " has " + std::to_string(rows) + " x " + std::to_string(cols) +
                       " values, the DEM " + std::to_string(heights_.rows()) + " x " +
                       std::to_string(heights_.cols()) + "; give one for each sample.");
  }
  template <class T>
  static Grid<T> part_of(const Grid<T>& all, const Window& window) {
    if (all.empty()) return {};
    Grid<T> part(window.rows, window.cols);
    for (int r = 0; r < window.rows; ++r) {
      std::copy_n(all.row(window.row + r) + window.col, window.cols, part.row(r));
    }
    return part;
  }

  const Grid<float>& heights_;
  const Grid<float>& tolerance_;
  const Grid<std::uint8_t>& keep_;
};

// `before` and `after` number the mesh's vertices in two levels, `followed` says where those of the first
// went.
std::vector<std::int32_t> coarser(const std::vector<std::int32_t>& before, const SimplifiedTin& finer,
                                  const std::vector<std::int32_t>& followed,
                                  const std::vector<std::int32_t>& after) {
  std::vector<std::int32_t> result(finer.tin.vertices.size());
  for (std::size_t v = 0; v < before.size(); ++v) {
    result[static_cast<std::size_t>(before[v])] = after[static_cast<std::size_t>(followed[v])];
  }
  return result;
}

void check_factors(std::span<const double> factors, const SimplifyOptions& options) {
  bool ascend = !factors.empty() && factors[0] == 1;
  for (std::size_t n = 1; n < factors.size(); ++n) {
    ascend = ascend && std::isfinite(factors[n] * options.tolerance_m) && factors[n] > factors[n - 1];
  }
  if (!ascend) throw InvalidInput("Tolerances of a hierarchy have to grow from one to the next.");
  if (factors.size() > 1 && (options.target_faces > 0 || options.target_bytes.most > 0))
    throw InvalidInput("A hierarchy has no target: give several tolerances, or one and a target.");
}

}  // namespace

std::vector<SimplifiedTin> simplify_dem_levels(DemWindows& dem, const DemPlace& place,
                                               const SimplifyOptions& options,
                                               std::span<const double> factors, Progress& progress) {
  check_sides(dem.rows(), dem.cols());
  check(options);
  check_factors(factors, options);
  const MemoryBudget budget(options.memory_bytes);
  const Workers workers(options.threads);
  Originals originals(dem, options.tolerance_m, place_rounding(place, dem.rows(), dem.cols()),
                      options.samples_at_once);
  const std::size_t bytes = bytes_of_blocks(originals, options.block, workers.count());
  budget.require(bytes, "Simplifying the DEM", "Give a part of it.");
  const LineRules lines = line_rules(options, place);
  BlockPlan blocks{.block = options.block,
                   .kinds = {dem.rows(), dem.cols(), options.keep_border, options.border_tolerance_m > 0},
                   .break_lines = options.break_lines,
                   .pass = {.share = kShareOfBlocks, .lines = lines}};
  const Target target(options);
  if (target.is_set()) {
    const std::size_t faces = count_faces(originals, options.block, progress);
    blocks.least_part =
        kSpareForTarget * target.faces() / static_cast<double>(std::max<std::size_t>(faces, 1));
  }
  BlocksDecimated done = decimate_blocks(originals, blocks, budget, workers, progress);
  if (done.faces_before == 0)
    throw InvalidInput("The DEM has no three samples side by side that are not nodata: it makes no surface.");
  Decimation& decimation = done.left;
  std::vector<SimplifiedTin> levels;
  std::vector<std::int32_t> number;  // of the mesh's vertices, in the last level
  for (const double factor : factors) {
    if (!levels.empty()) {
      originals.set_factor(factor);
      decimation.forget_what_failed();
      decimation.follow_vertices();
    }
    if (target.is_set()) {
      decimate_to_target(decimation, target, originals, options, lines, workers, progress);
    } else {
      const double share = kShareOfPasses / static_cast<double>(factors.size());
      decimate(decimation, originals, options, lines, share, workers, progress);
    }
    WrittenTin written = written_tin(decimation.mesh(), place, originals, workers, progress);
    written.made.report.faces_before = done.faces_before;
    written.made.report.break_line_edges_lost = done.break_line_edges_lost;
    written.made.report.kept_for_rounding_m = originals.margin();
    if (!levels.empty())
      levels.back().coarser_vertex = coarser(number, levels.back(), decimation.followed(), written.number);
    levels.push_back(std::move(written.made));
    number = std::move(written.number);
  }
  return levels;
}

SimplifiedTin simplify_dem(DemWindows& dem, const DemPlace& place, const SimplifyOptions& options,
                           Progress& progress) {
  constexpr std::array<double, 1> kOnce{1};
  return std::move(simplify_dem_levels(dem, place, options, kOnce, progress)[0]);
}

std::vector<SimplifiedTin> simplify_dem_levels(const DemTerrain& terrain, const SimplifyOptions& options,
                                               std::span<const double> factors, Progress& progress) {
  check_sides(terrain.heights.rows(), terrain.heights.cols());
  DemInMemory dem(terrain.heights, options);
  return simplify_dem_levels(dem, {terrain.geotransform, terrain.metres_per_unit, terrain.crs_wkt}, options,
                             factors, progress);
}

SimplifiedTin simplify_dem(const DemTerrain& terrain, const SimplifyOptions& options, Progress& progress) {
  constexpr std::array<double, 1> kOnce{1};
  return std::move(simplify_dem_levels(terrain, options, kOnce, progress)[0]);
}

}  // namespace sightbound
