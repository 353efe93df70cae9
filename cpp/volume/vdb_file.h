// SPDX-License-Identifier: GPL-3.0-or-later
// Our .vdb files: whole or not there, the same bytes for the same content, damage seen before OpenVDB reads
// it.
//
// Behind what OpenVDB writes (which every OpenVDB tool reads, taking no notice of the rest) stand 24 bytes: 8
// that say "sightvdb", the size of OpenVDB's part and a checksum of it, each 8 bytes, low byte first. OpenVDB
// trusts the numbers in a file, so that a damaged one may crash it; and it writes a random identifier, which
// we replace.
#pragma once

#include <string>

#include <openvdb/openvdb.h>

namespace sightbound {

struct VdbContent {
  openvdb::GridPtrVec grids;
  openvdb::MetaMap metadata;  // of the file
};

// Written beside `path`, renamed when whole; keeps what stood there when it fails. Grids keep their own
// saveFloatAsHalf(). Throws IoError.
void write_vdb(const std::string& path, const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata);

// `what` a file must be, for messages ("an error volume"). Throws IoError (no such file, damaged, cut off),
// InvalidInput (no .vdb, or one that Sightbound did not write).
VdbContent read_vdb(const std::string& path, const std::string& what);

// The grid of that name and type. Throws InvalidInput when there is none.
template <class Grid>
typename Grid::Ptr grid_of(const VdbContent& content, const std::string& name, const std::string& path,
                           const std::string& what);

// The value of that name and type; throws InvalidInput when there is none.
template <class T>
T metadata_of(const VdbContent& content, const std::string& name, const std::string& path,
              const std::string& what);

[[noreturn]] void refuse_vdb(const std::string& path, const std::string& what, const std::string& why);

template <class Grid>
typename Grid::Ptr grid_of(const VdbContent& content, const std::string& name, const std::string& path,
                           const std::string& what) {
  for (const openvdb::GridBase::Ptr& grid : content.grids) {
    if (grid->getName() != name) continue;
    if (auto found = openvdb::gridPtrCast<Grid>(grid)) return found;
  }
  refuse_vdb(path, what, "it has no grid '" + name + "' of the right type");
}

template <class T>
T metadata_of(const VdbContent& content, const std::string& name, const std::string& path,
              const std::string& what) {
  const auto found = content.metadata.getMetadata<openvdb::TypedMetadata<T>>(name);
  if (!found) refuse_vdb(path, what, "it has no entry '" + name + "' of the right type");
  return found->value();
}

}  // namespace sightbound
