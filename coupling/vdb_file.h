#pragma once

// Includes OpenVDB, which is slow to compile: only the sources of the caches include this header.
#include <openvdb/openvdb.h>

#include <string>

#include "coupling/liquid_cache.h"

namespace spume::coupling {

/// Puts frame, time and fps on a grid.
void stampGrid(openvdb::GridBase& grid, const FrameStamp& stamp);
FrameStamp stampOf(const openvdb::GridBase& grid);

/// Writes the grids so that a full disk is noticed and leaves no file under `path`. Throws FileError.
void writeVdb(const std::string& path, const openvdb::GridCPtrVec& grids);

/// All grids of a file. Throws FileError: missing, unreadable, no VDB.
openvdb::GridPtrVec readVdb(const std::string& path);

/// The same with names and metadata only, without their values.
openvdb::GridPtrVec readVdbMetadata(const std::string& path);

/// The grid called `name` with the type of Grid, or null.
template <typename Grid>
typename Grid::Ptr findGrid(const openvdb::GridPtrVec& grids, const std::string& name) {
  for (const auto& grid : grids)
    if (grid->getName() == name && grid->isType<Grid>()) return openvdb::gridPtrCast<Grid>(grid);
  return nullptr;
}

}  // namespace spume::coupling
