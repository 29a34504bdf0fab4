#include "coupling/vdb_file.h"

#include <array>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <vector>

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

/// Where a VDB file keeps the identity that OpenVDB draws at random: behind magic number, three versions and
/// the flag for offsets.
constexpr std::streamoff kIdentityPlace = 8 + 3 * 4 + 1;
constexpr std::size_t kIdentityLength = 36;

/// Two 64-bit checksums of all that follows the identity.
std::array<std::uint64_t, 2> sumsOf(std::istream& file) {
  std::array<std::uint64_t, 2> sums{0xcbf29ce484222325ull, 0x9e3779b97f4a7c15ull};
  std::vector<std::uint64_t> words(1 << 16);
  file.seekg(kIdentityPlace + static_cast<std::streamoff>(kIdentityLength));
  while (file) {
    std::fill(words.begin(), words.end(), 0);
    file.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(words.size() * 8));
    for (std::size_t n = 0; 8 * n < static_cast<std::size_t>(file.gcount()); ++n) {
      sums[0] = std::rotl((sums[0] ^ words[n]) * 0x100000001b3ull, 29);
      sums[1] = std::rotl((sums[1] ^ words[n]) * 0xff51afd7ed558ccdull, 31);
    }
  }
  return sums;
}

/// Files of the same grids are to have the same bytes, so the identity is made from the contents.
void makeReproducible(const std::string& path) {
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  const auto [a, b] = sumsOf(file);
  const auto part = [](std::uint64_t sum, int shift, std::uint64_t mask) {
    return static_cast<unsigned long long>(sum >> shift & mask);
  };
  char identity[kIdentityLength + 1];
  std::snprintf(identity, sizeof identity, "%08llx-%04llx-%04llx-%04llx-%012llx", part(a, 32, 0xffffffff),
                part(a, 16, 0xffff), part(a, 0, 0xffff), part(b, 48, 0xffff), part(b, 0, 0xffffffffffff));
  file.clear();
  file.seekp(kIdentityPlace);
  file.write(identity, kIdentityLength);
  file.close();
  if (!file) throw FileError(path + ": cannot write: " + std::strerror(errno ? errno : EIO));
}

template <typename Value>
Value metaOr(const openvdb::GridBase& grid, const std::string& name, Value fallback) {
  const auto meta = grid.getMetadata<openvdb::TypedMetadata<Value>>(name);
  return meta ? meta->value() : fallback;
}

/// What `read` takes from the opened file.
template <typename Read>
openvdb::GridPtrVec readFrom(const std::string& path, const Read& read) {
  openvdb::initialize();
  checkReadable(path);
  try {
    openvdb::io::File file(path);
    constexpr bool kDelayLoad = false;  // the file may be replaced while it is in use
    file.open(kDelayLoad);
    return read(file);
  } catch (const openvdb::Exception& error) {
    throw FileError(path + ": cannot be read as OpenVDB: " + error.what());
  }
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
    makeReproducible(temporary);
  });
}

openvdb::GridPtrVec readVdb(const std::string& path) {
  return readFrom(path, [](openvdb::io::File& file) { return *file.getGrids(); });
}

openvdb::GridPtrVec readVdbMetadata(const std::string& path) {
  return readFrom(path, [](openvdb::io::File& file) { return *file.readAllGridMetadata(); });
}

}  // namespace spume::coupling
