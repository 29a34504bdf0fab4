#include <bit>
#include <cstring>
#include <sstream>

#include "coupling/atomic_file.h"
#include "coupling/bubble_cache.h"
#include "coupling/bubble_record.h"

namespace spume::coupling {
namespace {

/// The body of the file is this record, packed, little endian.
constexpr char kPlyProperties[] =
    "property float x\nproperty float y\nproperty float z\n"
    "property float vx\nproperty float vy\nproperty float vz\n"
    "property float pscale\nproperty double id\nproperty float age\nproperty int type\n"
    "property float vol\nproperty float wetness\n";
constexpr char kPlyFlags[] = "property int flags\n";  ///< the last; earlier versions did not write it
constexpr std::size_t kPlyFlagsBytes = sizeof(std::int32_t);
constexpr std::size_t kPlyRecordBytes =
    10 * sizeof(float) + sizeof(double) + sizeof(std::int32_t) + kPlyFlagsBytes;
static_assert(std::endian::native == std::endian::little, "the caches are written as they lie in memory");

std::string plyHeader(std::size_t count, const FrameStamp& stamp) {
  std::ostringstream header;
  header.precision(17);
  header << "ply\nformat binary_little_endian 1.0\ncomment frame " << stamp.frame << "\ncomment time "
         << stamp.time << "\ncomment fps " << stamp.fps << "\nelement vertex " << count << "\n"
         << kPlyProperties << kPlyFlags << "end_header\n";
  return header.str();
}

template <typename Value>
void put(std::string& out, Value value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename Value>
Value take(const char*& in) {
  Value value;
  std::memcpy(&value, in, sizeof value);
  in += sizeof value;
  return value;
}

void putRecord(std::string& out, const foam::BubbleStore& bubbles, std::size_t n) {
  for (int axis = 0; axis < 3; ++axis) put(out, static_cast<float>(bubbles.position[n][axis]));
  for (int axis = 0; axis < 3; ++axis) put(out, static_cast<float>(bubbles.velocity[n][axis]));
  put(out, static_cast<float>(bubbles.radius[n]));
  put(out, static_cast<double>(bubbles.id[n]));
  put(out, static_cast<float>(bubbles.age[n]));
  put(out, static_cast<std::int32_t>(bubbles.type[n]));
  put(out, static_cast<float>(bubbles.gas[n]));
  put(out, static_cast<float>(bubbles.wetness[n]));
  put(out, flagsOf(bubbles, n));
}

BubbleRecord takeRecord(const char*& in, bool hasFlags) {
  BubbleRecord record;
  for (double& x : record.position) x = take<float>(in);
  for (float& v : record.velocity) v = take<float>(in);
  record.radius = take<float>(in);
  record.id = static_cast<std::int64_t>(take<double>(in));
  record.age = take<float>(in);
  record.type = take<std::int32_t>(in);
  record.gas = take<float>(in);
  record.wetness = take<float>(in);
  if (hasFlags) record.flags = take<std::int32_t>(in);
  return record;
}

struct PlyContents {
  FrameStamp stamp;
  std::size_t count = 0;
  bool hasFlags = false;

  std::size_t recordBytes() const { return kPlyRecordBytes - (hasFlags ? 0 : kPlyFlagsBytes); }
};

/// What a header this program wrote announces. Throws SceneError.
PlyContents parsePlyHeader(const std::string& header, const std::string& path) {
  PlyContents contents;
  std::istringstream lines(header);
  std::string line, properties;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (first == "property") properties += line + "\n";
    if (first == "element") words >> contents.count;
    if (first == "comment" && second == "frame") words >> contents.stamp.frame;
    if (first == "comment" && second == "time") words >> contents.stamp.time;
    if (first == "comment" && second == "fps") words >> contents.stamp.fps;
  }
  contents.hasFlags = properties == std::string(kPlyProperties) + kPlyFlags;
  if (header.rfind("ply\nformat binary_little_endian 1.0\n", 0) != 0 ||
      (!contents.hasFlags && properties != kPlyProperties))
    throw SceneError(path + ": is not a PLY file of bubbles as this program writes it");
  return contents;
}

}  // namespace

void writeBubblesPly(const std::string& path, const foam::BubbleStore& bubbles, const FrameStamp& stamp) {
  std::string contents = plyHeader(bubbles.size(), stamp);
  contents.reserve(contents.size() + bubbles.size() * kPlyRecordBytes);
  for (std::size_t n = 0; n < bubbles.size(); ++n) putRecord(contents, bubbles, n);
  replaceFile(path, contents);
}

BubbleFrame readBubblesPly(const std::string& path) {
  constexpr char kEnd[] = "end_header\n";
  const std::string bytes = readFile(path);
  const std::size_t end = bytes.find(kEnd);
  if (end == std::string::npos) throw SceneError(path + ": is not a PLY file");
  const PlyContents contents = parsePlyHeader(bytes.substr(0, end), path);
  const std::size_t body = end + std::strlen(kEnd), held = bytes.size() - body;
  if (held / contents.recordBytes() != contents.count || held % contents.recordBytes())
    throw SceneError(path + ": is cut off: " + std::to_string(contents.count) + " bubbles announced, " +
                     std::to_string(held / contents.recordBytes()) + " present");
  std::vector<BubbleRecord> records;
  const char* in = bytes.data() + body;
  for (std::size_t n = 0; n < contents.count; ++n) records.push_back(takeRecord(in, contents.hasFlags));
  return {contents.stamp, storeOf(std::move(records), path)};
}

}  // namespace spume::coupling
