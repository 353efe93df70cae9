// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/version.h"
#include "volume/vdb.h"
#include "volume/vdb_file.h"
#include "volume/vdb_hidden.h"

namespace sightbound {

namespace {

constexpr const char* kWhat = "a hidden volume";
constexpr const char* kFormat = "hidden_volume";
constexpr int kFormatVersion = 1;

// Integer coordinates are the middles of targets.
openvdb::math::Transform::Ptr transform_of(const TargetLattice& lattice) {
  const double s = lattice.spacing_m, h = lattice.height_spacing_m;
  const Xyz middle = lattice.centre(0, 0, 0);
  return std::make_shared<openvdb::math::Transform>(std::make_shared<openvdb::math::ScaleTranslateMap>(
      openvdb::Vec3d(s, s, h), openvdb::Vec3d(middle.x, middle.y, middle.z)));
}

template <class Grid>
typename Grid::Ptr named_grid(const char* name, const openvdb::math::Transform::Ptr& transform,
                              typename Grid::ValueType background) {
  auto grid = Grid::create(background);
  grid->setName(name);
  grid->setTransform(transform);
  return grid;
}

// One tree value for each of `answers`, voxels and tiles alike.
template <class Grid, class F>
void copy_values(const AnswerTree& answers, Grid& grid, F value_of) {
  auto accessor = grid.getAccessor();
  for (auto it = answers.cbeginValueOn(); it; ++it) {
    if (it.isVoxelValue()) {
      accessor.setValueOn(it.getCoord(), value_of(*it));
    } else {
      accessor.addTile(it.getLevel(), it.getCoord(), value_of(*it), true);
    }
  }
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += text + '\n';
  return all;
}

// One line each: the texts are one-line JSON or names.
std::vector<std::string> parted(const std::string& all) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = all.find('\n', at);
    texts.push_back(all.substr(at, end - at));
    at = end == std::string::npos ? all.size() : end + 1;
  }
  return texts;
}

std::vector<std::string> one_line_each(std::vector<std::string> texts) {
  for (std::string& text : texts) {
    for (char& c : text) {
      if (c == '\n' || c == '\r') c = ' ';
    }
  }
  return texts;
}

class Reader {
 public:
  Reader(const std::string& path, const VdbContent& content) : path_(path), content_(content) {}

  template <class T>
  T get(const char* name) const {
    return metadata_of<T>(content_, name, path_, kWhat);
  }
  template <class Grid>
  typename Grid::Ptr grid(const char* name) const {
    return grid_of<Grid>(content_, name, path_, kWhat);
  }
  void require(bool sound, const char* why) const {
    if (!sound) refuse_vdb(path_, kWhat, why);
  }

 private:
  const std::string& path_;
  const VdbContent& content_;
};

std::shared_ptr<const TargetLattice> read_lattice(const Reader& reader) {
  auto lattice = std::make_shared<TargetLattice>();
  lattice->frame = {reader.get<double>("frame_x"), reader.get<double>("frame_y"),
                    reader.get<double>("metres_per_unit"), reader.get<std::string>("crs_wkt")};
  lattice->corner = {reader.get<double>("corner_x"), reader.get<double>("corner_y"),
                     reader.get<double>("corner_z")};
  lattice->spacing_m = reader.get<double>("spacing_m");
  lattice->height_spacing_m = reader.get<double>("height_spacing_m");
  lattice->ceiling_m = reader.get<double>("ceiling_m");
  lattice->nx = reader.get<std::int32_t>("nx");
  lattice->ny = reader.get<std::int32_t>("ny");
  reader.require(
      lattice->nx > 0 && lattice->ny > 0 && static_cast<double>(lattice->nx) * lattice->ny < 2147483647.0 &&
          lattice->spacing_m > 0 && lattice->height_spacing_m > 0 && lattice->frame.metres_per_unit > 0,
      "its lattice makes no sense");
  const auto ground = reader.grid<openvdb::FloatGrid>("ground");
  const auto first = reader.grid<openvdb::Int32Grid>("first"), last = reader.grid<openvdb::Int32Grid>("last");
  const auto ground_at = ground->getConstAccessor();
  const auto first_at = first->getConstAccessor(), last_at = last->getConstAccessor();
  lattice->columns.resize(static_cast<std::size_t>(lattice->nx) * static_cast<std::size_t>(lattice->ny));
  for (int j = 0; j < lattice->ny; ++j) {
    for (int i = 0; i < lattice->nx; ++i) {
      TargetColumn& column = lattice->columns[lattice->number(i, j)];
      float height = std::numeric_limits<float>::quiet_NaN();
      if (ground_at.probeValue({i, j, 0}, height))
        column.ground = height;
      else
        column.ground = std::numeric_limits<float>::quiet_NaN();
      column.first = first_at.getValue({i, j, 0});
      column.last = last_at.getValue({i, j, 0});
    }
  }
  return lattice;
}

}  // namespace

void HiddenVolume::save(const std::string& path, Progress& progress) const {
  initialize_vdb();
  progress.check();
  const TargetLattice& lattice = *lattice_;
  const auto transform = transform_of(lattice);
  auto p = named_grid<openvdb::FloatGrid>("p", transform, 0.0f);
  auto verdict = named_grid<openvdb::Int32Grid>("verdict", transform, std::int32_t{kNoVerdict});
  p->setSaveFloatAsHalf(true);
  copy_values(trees_->answers, *p, [](std::int32_t packed) { return unpack_answer(packed).p; });
  progress.check();
  copy_values(trees_->answers, *verdict,
              [](std::int32_t packed) { return std::int32_t{unpack_answer(packed).verdict}; });
  auto ground = named_grid<openvdb::FloatGrid>("ground", transform, 0.0f);
  auto first = named_grid<openvdb::Int32Grid>("first", transform, 0);
  auto last = named_grid<openvdb::Int32Grid>("last", transform, -1);
  auto ground_at = ground->getAccessor();
  auto first_at = first->getAccessor(), last_at = last->getAccessor();
  for (int j = 0; j < lattice.ny; ++j) {
    for (int i = 0; i < lattice.nx; ++i) {
      const TargetColumn& column = lattice.column(i, j);
      if (!std::isnan(column.ground)) ground_at.setValueOn({i, j, 0}, column.ground);
      if (column.first != 0) first_at.setValueOn({i, j, 0}, column.first);
      if (column.last != -1) last_at.setValueOn({i, j, 0}, column.last);
    }
  }
  progress.check();

  openvdb::MetaMap metadata;
  const auto put = [&](const char* name, const auto& value) {
    metadata.insertMeta(name, openvdb::TypedMetadata<std::decay_t<decltype(value)>>(value));
  };
  put("sightbound_format", std::string(kFormat));
  put("sightbound_format_version", std::int32_t{kFormatVersion});
  put("made_by", info_.made_by.empty() ? "Sightbound " + version() : info_.made_by);
  put("frame_x", lattice.frame.x);
  put("frame_y", lattice.frame.y);
  put("metres_per_unit", lattice.frame.metres_per_unit);
  put("crs_wkt", lattice.frame.crs_wkt);
  put("corner_x", lattice.corner.x);
  put("corner_y", lattice.corner.y);
  put("corner_z", lattice.corner.z);
  put("spacing_m", lattice.spacing_m);
  put("height_spacing_m", lattice.height_spacing_m);
  put("ceiling_m", lattice.ceiling_m);
  put("nx", std::int32_t{lattice.nx});
  put("ny", std::int32_t{lattice.ny});
  put("confidence", info_.confidence);
  put("error_model", info_.error_model);
  put("observers", joined(one_line_each(info_.observers)));
  put("operations", joined(one_line_each(info_.operations)));
  write_vdb(path, {p, verdict, ground, first, last}, metadata);
  progress.check();
}

HiddenVolume HiddenVolume::open(const std::string& path, Progress& progress) {
  progress.check();
  const VdbContent content = read_vdb(path, kWhat);
  const Reader reader(path, content);
  const std::string format = reader.get<std::string>("sightbound_format");
  reader.require(format == kFormat, "it holds something else");
  const auto format_version = reader.get<std::int32_t>("sightbound_format_version");
  if (format_version != kFormatVersion) {
    throw InvalidInput("'" + path + "' has version " + std::to_string(format_version) +
                       " of the format; this version of Sightbound reads " + std::to_string(kFormatVersion) +
                       ".");
  }
  progress.check();
  auto lattice = read_lattice(reader);
  HiddenVolumeInfo info;
  info.confidence = reader.get<double>("confidence");
  info.error_model = reader.get<std::string>("error_model");
  info.made_by = reader.get<std::string>("made_by");
  info.observers = parted(reader.get<std::string>("observers"));
  info.operations = parted(reader.get<std::string>("operations"));

  const auto p = reader.grid<openvdb::FloatGrid>("p");
  const auto verdict = reader.grid<openvdb::Int32Grid>("verdict");
  reader.require(p->tree().activeVoxelCount() == verdict->tree().activeVoxelCount(),
                 "p and verdict are not of the same targets");
  auto trees = std::make_shared<Trees>();
  openvdb::tree::ValueAccessor<AnswerTree> answers(trees->answers);
  const auto verdict_at = verdict->getConstAccessor();
  for (auto it = p->cbeginValueOn(); it; ++it) {
    const openvdb::Coord at = it.getCoord();
    const std::int32_t claim = verdict_at.getValue(at);
    reader.require(claim >= kHidden && claim <= kVisible && *it >= 0 && *it <= 1,
                   "p or verdict is out of range");
    const std::int32_t packed = pack_answer({*it, static_cast<std::uint8_t>(claim)});
    if (it.isVoxelValue()) {
      answers.setValueOn(at, packed);
    } else {
      answers.addTile(it.getLevel(), at, packed, true);
    }
  }
  return {std::move(lattice), std::move(trees), std::move(info)};
}

}  // namespace sightbound
