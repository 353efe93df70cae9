// SPDX-License-Identifier: GPL-3.0-or-later
// Grids of the file: k_low and k_high (half floats; exact, since the bounds are halves), ambiguous (0 or 1,
// sheets), and `surface`: bytes, four to a number, in leaves along k. What other tools should know stands in
// the file's metadata.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/version.h"
#include "volume/surface_bytes.h"
#include "volume/vdb.h"
#include "volume/vdb_file.h"

namespace sightbound {

namespace {

constexpr const char* kWhat = "an error volume";
constexpr const char* kFormat = "error_volume";
constexpr std::int32_t kFormatVersion = 1;
constexpr double kMostRatio = 1e4;  // Student's quantile of the confidence next to 1 is 1.6e3

using FloatLeaf = openvdb::FloatTree::LeafNodeType;

openvdb::math::Transform::Ptr transform_of(const VolumeFrame& frame, double side, double height) {
  const double across = side / frame.metres_per_unit;
  return std::make_shared<openvdb::math::Transform>(std::make_shared<openvdb::math::ScaleTranslateMap>(
      openvdb::Vec3d(across, across, height),
      openvdb::Vec3d(frame.x + across / 2, frame.y + across / 2, height / 2)));
}

// Values and tiles of `from` in another tree of the same shape.
template <class To, class F>
void copy_tree(const RatioTree& from, To& to, const F& value_of) {
  for (auto it = from.cbeginLeaf(); it; ++it) {
    auto* leaf = to.probeLeaf(it->origin());
    for (openvdb::Index n = 0; n < RatioLeaf::SIZE; ++n) leaf->setValueOnly(n, value_of(it->getValue(n)));
  }
  auto tile = from.cbeginValueAll();
  tile.setMaxDepth(RatioTree::DEPTH - 2);
  for (; tile; ++tile) to.addTile(tile.getLevel(), tile.getCoord(), value_of(*tile), tile.isValueOn());
}

openvdb::FloatGrid::Ptr bounds_grid(const RatioTree& ratios, const char* name,
                                    const openvdb::math::Transform::Ptr& transform, bool low) {
  const auto value_of = [low](std::int32_t packed) { return low ? unpack(packed).low : unpack(packed).high; };
  auto tree =
      std::make_shared<openvdb::FloatTree>(ratios, value_of(ratios.background()), openvdb::TopologyCopy());
  copy_tree(ratios, *tree, value_of);
  auto grid = openvdb::FloatGrid::create(tree);
  grid->setName(name);
  grid->setTransform(transform);
  grid->setSaveFloatAsHalf(true);
  return grid;
}

std::shared_ptr<ErrorVolume::Trees> join_bounds(const openvdb::FloatTree& low, const openvdb::FloatTree& high,
                                                double largest_ratio, const std::string& path) {
  const float end = beyond(largest_ratio);
  const auto require = [&](bool sound) {
    if (!sound) refuse_vdb(path, kWhat, "k_low and k_high do not fit together");
  };
  require(low.hasSameTopology(high) && low.background() == end && high.background() == end);
  const auto joined = [&](float a, float b) {
    require(a >= -end && a <= b && b <= end);
    return pack(static_cast<double>(a), static_cast<double>(b));
  };
  auto trees = std::make_shared<ErrorVolume::Trees>(low, joined(end, end));
  for (auto it = trees->ratios.beginLeaf(); it; ++it) {
    const FloatLeaf &a = *low.probeConstLeaf(it->origin()), &b = *high.probeConstLeaf(it->origin());
    for (openvdb::Index n = 0; n < RatioLeaf::SIZE; ++n)
      it->setValueOnly(n, joined(a.getValue(n), b.getValue(n)));
  }
  auto tile = low.cbeginValueAll();
  tile.setMaxDepth(RatioTree::DEPTH - 2);
  for (; tile; ++tile) {
    const openvdb::Coord at = tile.getCoord();
    trees->ratios.addTile(tile.getLevel(), at, joined(*tile, high.getValue(at)), tile.isValueOn());
  }
  return trees;
}

openvdb::Int32Grid::Ptr bytes_grid(const std::vector<char>& bytes) {
  auto grid = openvdb::Int32Grid::create(0);
  grid->setName("surface");
  for (std::size_t at = 0, n = 0; at < bytes.size(); at += 4 * RatioLeaf::SIZE, ++n) {
    auto* leaf = grid->tree().touchLeaf({0, 0, static_cast<int>(8 * n)});
    std::array<std::int32_t, RatioLeaf::SIZE> words{};
    std::memcpy(words.data(), bytes.data() + at, std::min<std::size_t>(sizeof(words), bytes.size() - at));
    for (openvdb::Index i = 0; i < RatioLeaf::SIZE; ++i) leaf->setValueOn(i, words[i]);
  }
  return grid;
}

std::vector<char> bytes_from(const openvdb::Int32Grid& grid, std::int64_t count, const std::string& path) {
  const std::size_t leaves = grid.tree().leafCount();
  if (count < 0 ||
      (static_cast<std::uint64_t>(count) + 4 * RatioLeaf::SIZE - 1) / (4 * RatioLeaf::SIZE) != leaves) {
    refuse_vdb(path, kWhat, "its surface is incomplete");
  }
  std::vector<char> bytes(leaves * 4 * RatioLeaf::SIZE);
  for (std::size_t n = 0; n < leaves; ++n) {
    const auto* leaf = grid.tree().probeConstLeaf({0, 0, static_cast<int>(8 * n)});
    if (leaf == nullptr) refuse_vdb(path, kWhat, "its surface is incomplete");
    for (openvdb::Index i = 0; i < RatioLeaf::SIZE; ++i) {
      const std::int32_t word = leaf->getValue(i);
      std::memcpy(bytes.data() + 4 * (n * RatioLeaf::SIZE + i), &word, 4);
    }
  }
  bytes.resize(static_cast<std::size_t>(count));
  return bytes;
}

void put_report(const VolumeReport& report, ByteWriter& to) {
  for (const std::size_t n : {report.faces, report.faces_not_held, report.voxels, report.leaves,
                              report.unknown_columns, report.ambiguous_voxels}) {
    to.put(std::uint64_t{n});
  }
  to.put(report.finest_needed_m);
  to.put(std::uint64_t{report.warnings.size()});
  for (const std::string& warning : report.warnings) to.put_text(warning);
}

VolumeReport get_report(ByteReader& from) {
  VolumeReport report;
  for (std::size_t* n : {&report.faces, &report.faces_not_held, &report.voxels, &report.leaves,
                         &report.unknown_columns, &report.ambiguous_voxels}) {
    *n = static_cast<std::size_t>(from.get<std::uint64_t>());
  }
  report.finest_needed_m = from.get<double>();
  for (auto left = from.get<std::uint64_t>(); left > 0; --left) report.warnings.push_back(from.get_text());
  return report;
}

void put_columns(const PlanMask& mask, ByteWriter& to) {
  to.put(std::int32_t{mask.cols()});
  to.put(std::int32_t{mask.rows()});
  to.put_list(std::span<const std::uint64_t>(mask.words()));
}

PlanMask get_columns(ByteReader& from) {
  const int cols = from.get<std::int32_t>(), rows = from.get<std::int32_t>();
  const std::vector<std::uint64_t> words = from.get_list<std::uint64_t>();
  if (cols == 0 && rows == 0) return {};
  const std::uint64_t across = (static_cast<std::uint64_t>(cols) + 7) / 8,
                      down = (static_cast<std::uint64_t>(rows) + 7) / 8;
  if (cols < 0 || rows < 0 || words.size() != across * down)
    throw IoError("The volume's columns are incomplete. Make the file again.");
  PlanMask mask(cols, rows, true);
  for (std::size_t n = 0; n < words.size(); ++n) {
    mask.set_8(static_cast<int>(n % across), static_cast<int>(n / across), words[n]);
  }
  mask.summarise();
  return mask;
}

}  // namespace

void ErrorVolume::save(const std::string& path, Progress& progress) const {
  initialize_vdb();
  progress.check();
  const auto transform = transform_of(surface_->frame(), voxel_m_, voxel_height_m_);
  openvdb::GridCPtrVec grids{bounds_grid(trees_->ratios, "k_low", transform, true),
                             bounds_grid(trees_->ratios, "k_high", transform, false)};
  progress.check();
  if (surface_->sides() == Sides::kSheet) {
    auto tree = std::make_shared<openvdb::BoolTree>(trees_->ambiguous, false, true, openvdb::TopologyCopy());
    auto ambiguous = openvdb::BoolGrid::create(tree);
    ambiguous->setName("ambiguous");
    ambiguous->setTransform(transform);
    grids.push_back(ambiguous);
  }
  ByteWriter bytes;
  put_report(report_, bytes);
  put_columns(unknown_, bytes);
  write_surface(*surface_, bytes);
  grids.push_back(bytes_grid(bytes.bytes()));

  openvdb::MetaMap metadata;
  const auto put = [&](const char* name, const auto& value) {
    metadata.insertMeta(name, openvdb::TypedMetadata<std::decay_t<decltype(value)>>(value));
  };
  put("sightbound_format", std::string(kFormat));
  put("sightbound_format_version", kFormatVersion);
  put("made_by", "Sightbound " + version());
  put("error_model", error_model_);
  put("crs_wkt", surface_->frame().crs_wkt);
  put("frame_x", surface_->frame().x);
  put("frame_y", surface_->frame().y);
  put("metres_per_unit", surface_->frame().metres_per_unit);
  put("metric", std::string(surface_->metric() == Metric::kVertical ? "vertical" : "normal"));
  put("sides", std::string(surface_->sides() == Sides::kSolid ? "solid" : "sheet"));
  put("voxel_m", voxel_m_);
  put("voxel_height_m", voxel_height_m_);
  put("largest_ratio", largest_ratio_);
  put("largest_confidence", largest_confidence());
  if (tails_ != Tails::kNormal) put("tails", name_of(tails_));  // files of normal tails are as they were
  put("surface_bytes", static_cast<std::int64_t>(bytes.bytes().size()));
  write_vdb(path, grids, metadata);
  progress.check();
}

ErrorVolume ErrorVolume::open(const std::string& path, Progress& progress) {
  progress.check();
  const VdbContent content = read_vdb(path, kWhat);
  const auto get = [&]<class T>(const char* name, T) { return metadata_of<T>(content, name, path, kWhat); };
  if (get("sightbound_format", std::string()) != kFormat) refuse_vdb(path, kWhat, "it holds something else");
  const std::int32_t format_version = get("sightbound_format_version", std::int32_t{});
  if (format_version != kFormatVersion) {
    throw InvalidInput("'" + path + "' has version " + std::to_string(format_version) +
                       " of the format; this version of Sightbound reads " + std::to_string(kFormatVersion) +
                       ".");
  }
  ErrorVolume volume;
  volume.voxel_m_ = get("voxel_m", double{});
  volume.voxel_height_m_ = get("voxel_height_m", double{});
  volume.largest_ratio_ = get("largest_ratio", double{});
  volume.error_model_ = get("error_model", std::string());
  if (content.metadata["tails"]) volume.tails_ = tails_from(get("tails", std::string()));
  const auto sensible = [](double value, double most) { return value > 0 && value <= most; };
  if (!sensible(volume.voxel_m_, 1e5) || !sensible(volume.voxel_height_m_, 1e5) ||
      !sensible(volume.largest_ratio_, kMostRatio)) {
    refuse_vdb(path, kWhat, "its voxel sizes or confidences make no sense");
  }
  progress.check();
  const auto trees = join_bounds(grid_of<openvdb::FloatGrid>(content, "k_low", path, kWhat)->tree(),
                                 grid_of<openvdb::FloatGrid>(content, "k_high", path, kWhat)->tree(),
                                 volume.largest_ratio_, path);
  progress.check();
  const std::vector<char> bytes = bytes_from(*grid_of<openvdb::Int32Grid>(content, "surface", path, kWhat),
                                             get("surface_bytes", std::int64_t{}), path);
  ByteReader reader(bytes);
  volume.report_ = get_report(reader);
  volume.unknown_ = get_columns(reader);
  volume.surface_ = read_surface(reader);
  if (volume.surface_->sides() == Sides::kSheet) {
    trees->ambiguous.topologyUnion(grid_of<openvdb::BoolGrid>(content, "ambiguous", path, kWhat)->tree());
  }
  volume.report_.bytes = trees->ratios.memUsage() + trees->ambiguous.memUsage() + volume.surface_->bytes();
  volume.trees_ = trees;
  return volume;
}

}  // namespace sightbound
