#include "coupling/vdb_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "coupling/atomic_file.h"

namespace spume::coupling {
namespace {

/// openvdb::io::File closes its stream without asking whether all was written, so a full disk would pass
/// unnoticed. This archive writes the same format to a stream that can be asked.
class StreamArchive : public openvdb::io::Archive {
 public:
  Ptr copy() const override { return std::make_shared<StreamArchive>(*this); }
  void write(const openvdb::GridCPtrVec&, const openvdb::MetaMap&) const override {}
  void writeTo(std::ostream& stream, const openvdb::GridCPtrVec& grids) const {
    constexpr bool kSeekable = true;
    Archive::write(stream, grids, kSeekable, openvdb::MetaMap());
  }
};

template <typename Value>
Value metaOr(const openvdb::GridBase& grid, const std::string& name, Value fallback) {
  const auto meta = grid.getMetadata<openvdb::TypedMetadata<Value>>(name);
  return meta ? meta->value() : fallback;
}

}  // namespace

void stampGrid(openvdb::GridBase& grid, const FrameStamp& stamp) {
  grid.insertMeta("frame", openvdb::Int32Metadata(stamp.frame));
  grid.insertMeta("time", openvdb::DoubleMetadata(stamp.time));
  grid.insertMeta("fps", openvdb::DoubleMetadata(stamp.fps));
}

FrameStamp stampOf(const openvdb::GridBase& grid) {
  FrameStamp stamp;
  stamp.frame = metaOr<openvdb::Int32>(grid, "frame", stamp.frame);
  stamp.time = metaOr<double>(grid, "time", stamp.time);
  stamp.fps = metaOr<double>(grid, "fps", stamp.fps);
  return stamp;
}

void writeVdb(const std::string& path, const openvdb::GridCPtrVec& grids) {
  replaceFile(path, [&](const std::string& temporary) {
    errno = 0;
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    if (stream) StreamArchive().writeTo(stream, grids);
    stream.close();
    if (!stream) throw FileError(path + ": cannot write: " + std::strerror(errno ? errno : EIO));
  });
}

openvdb::GridPtrVec readVdb(const std::string& path) {
  openvdb::initialize();
  checkReadable(path);
  try {
    openvdb::io::File file(path);
    constexpr bool kDelayLoad = false;  // the file may be replaced while it is in use
    file.open(kDelayLoad);
    return *file.getGrids();
  } catch (const openvdb::Exception& error) {
    throw FileError(path + ": cannot be read as OpenVDB: " + error.what());
  }
}

}  // namespace spume::coupling
