// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/surface_bytes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "volume/dem_surface.h"
#include "volume/tin_surface.h"

namespace sightbound {

namespace {

static_assert(std::endian::native == std::endian::little, "files are written low byte first");

constexpr std::int32_t kDem = 1, kTin = 2;
constexpr std::uint64_t kMostCells = std::uint64_t{1} << 40;

void put_profile(const GrowthProfile& profile, ByteWriter& to) {
  to.put(static_cast<std::int32_t>(profile.shape));
  to.put(profile.range_m);
  to.put(profile.exponent);
  to.put(profile.half_spacing_m);
}

GrowthProfile get_profile(ByteReader& from) {
  const auto shape = from.get<std::int32_t>();
  if (shape < 0 || shape > static_cast<std::int32_t>(GeologicShape::kGrowth)) {
    throw IoError("The volume's surface has a growth of unknown shape. Make the file again.");
  }
  GrowthProfile profile;
  profile.shape = static_cast<GeologicShape>(shape);
  profile.range_m = from.get<double>();
  profile.exponent = from.get<double>();
  profile.half_spacing_m = from.get<double>();
  return profile;
}

void put_grid(const Grid<float>& grid, ByteWriter& to) { to.put_list(grid.values()); }

Grid<float> get_grid(int rows, int cols, ByteReader& from) {
  const std::vector<float> values = from.get_list<float>();
  Grid<float> grid(rows, cols);
  if (values.size() != grid.size())
    throw IoError("The volume's surface has lists of unequal length. Make the file again.");
  std::copy(values.begin(), values.end(), grid.data());
  return grid;
}

void put_field(const SampleField& field, ByteWriter& to) {
  to.put(std::int32_t{field.is_constant()});
  if (field.is_constant()) {
    to.put(field.constant());
  } else {
    put_grid(field.values(), to);
  }
}

SampleField get_field(int rows, int cols, ByteReader& from) {
  if (from.get<std::int32_t>() != 0) return SampleField(from.get<float>());
  return SampleField(get_grid(rows, cols, from));
}

void put_dem(const DemInput& input, ByteWriter& to) {
  to.put(std::int32_t{input.heights.rows()});
  to.put(std::int32_t{input.heights.cols()});
  to.put(input.geotransform.coefficients());
  to.put(input.metres_per_unit);
  to.put_text(input.crs_wkt);
  put_grid(input.heights, to);
  put_field(input.error.sampling, to);
  put_field(input.error.amplitude, to);
  put_profile(input.error.profile, to);
  to.put_list(std::span<const CellSize>(input.error.cell_sizes));
  to.put_list(std::span<const double>(input.error.farthest));
  to.put(input.error.larger_side_m);
}

std::shared_ptr<const Surface> get_dem(ByteReader& from) {
  DemInput input;
  const int rows = from.get<std::int32_t>(), cols = from.get<std::int32_t>();
  if (rows < 2 || cols < 2 ||
      static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(cols) > kMostCells) {
    throw IoError("The volume's surface has a size that makes no sense. Make the file again.");
  }
  input.geotransform = Geotransform(from.get<std::array<double, 6>>());
  input.metres_per_unit = from.get<double>();
  input.crs_wkt = from.get_text();
  input.heights = get_grid(rows, cols, from);
  input.error.sampling = get_field(rows, cols, from);
  input.error.amplitude = get_field(rows, cols, from);
  input.error.profile = get_profile(from);
  input.error.cell_sizes = from.get_list<CellSize>();
  input.error.farthest = from.get_list<double>();
  input.error.larger_side_m = from.get<double>();
  return std::make_shared<DemSurface>(std::move(input));
}

void put_tin(const TinSurface& surface, ByteWriter& to) {
  const Tin& tin = surface.tin();
  const TinError& error = surface.error();
  to.put(static_cast<std::int32_t>(surface.metric()));
  to.put(tin.origin);
  to.put(tin.metres_per_unit);
  to.put_text(tin.crs_wkt);
  to.put_list(std::span<const Xyz>(tin.vertices));
  to.put_list(std::span<const Face>(tin.faces));
  to.put_list(std::span<const float>(error.sampling));
  to.put_list(std::span<const float>(error.amplitude));
  put_profile(error.profile, to);
  to.put(error.spacing_m);
}

std::shared_ptr<const Surface> get_tin(ByteReader& from) {
  const auto metric = from.get<std::int32_t>();
  Tin tin;
  tin.origin = from.get<Xyz>();
  tin.metres_per_unit = from.get<double>();
  tin.crs_wkt = from.get_text();
  tin.vertices = from.get_list<Xyz>();
  tin.faces = from.get_list<Face>();
  TinError error;
  error.sampling = from.get_list<float>();
  error.amplitude = from.get_list<float>();
  error.profile = get_profile(from);
  error.spacing_m = from.get<double>();
  for (const Face& face : tin.faces) {
    for (const std::int32_t v : face) {
      if (v < 0 || static_cast<std::size_t>(v) >= tin.vertices.size()) {
        throw IoError("The volume's surface names a vertex that it has not. Make the file again.");
      }
    }
  }
  return std::make_shared<TinSurface>(
      std::move(tin), std::move(error),
      metric == static_cast<std::int32_t>(Metric::kVertical) ? Metric::kVertical : Metric::kNormal);
}

}  // namespace

void write_surface(const Surface& surface, ByteWriter& to) {
  if (const auto* dem = dynamic_cast<const DemSurface*>(&surface)) {
    to.put(kDem);
    put_dem(dem->input(), to);
  } else {
    to.put(kTin);
    put_tin(dynamic_cast<const TinSurface&>(surface), to);
  }
}

std::shared_ptr<const Surface> read_surface(ByteReader& from) {
  const auto kind = from.get<std::int32_t>();
  if (kind == kDem) return get_dem(from);
  if (kind == kTin) return get_tin(from);
  throw IoError("The volume's surface is of an unknown kind. Make the file again.");
}

}  // namespace sightbound
