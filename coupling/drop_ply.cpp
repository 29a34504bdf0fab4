#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <sstream>

#include "coupling/atomic_file.h"
#include "coupling/drop_cache.h"

namespace spume::coupling {
namespace {

static_assert(std::endian::native == std::endian::little, "the caches are written as they lie in memory");

/// The body of the file is this record, packed, in the order of kProperties.
struct Numbers {
  float position[3], velocity[3], radius, volume;
};
constexpr char kProperties[] =
    "property float x\nproperty float y\nproperty float z\n"
    "property float vx\nproperty float vy\nproperty float vz\n"
    "property float pscale\nproperty float vol\nproperty double id\n";
constexpr std::size_t kRecordBytes = sizeof(Numbers) + sizeof(double);

std::string headerOf(std::size_t count, const FrameStamp& stamp) {
  std::ostringstream header;
  header.precision(17);
  header << "ply\nformat binary_little_endian 1.0\ncomment frame " << stamp.frame << "\ncomment time "
         << stamp.time << "\ncomment fps " << stamp.fps << "\nelement vertex " << count << "\n"
         << kProperties << "end_header\n";
  return header.str();
}

void putRecord(std::string& out, const fluid::Drop& drop) {
  Numbers numbers;
  Eigen::Map<Eigen::Vector3f>(numbers.position) = drop.position.cast<float>();
  Eigen::Map<Eigen::Vector3f>(numbers.velocity) = drop.velocity.cast<float>();
  numbers.radius = static_cast<float>(radiusOf(drop));
  numbers.volume = static_cast<float>(drop.volume);
  const double id = static_cast<double>(drop.id);
  out.append(reinterpret_cast<const char*>(&numbers), sizeof numbers);
  out.append(reinterpret_cast<const char*>(&id), sizeof id);
}

fluid::Drop takeRecord(const char* in) {
  Numbers numbers;
  double id;
  std::memcpy(&numbers, in, sizeof numbers);
  std::memcpy(&id, in + sizeof numbers, sizeof id);
  return {Eigen::Map<Eigen::Vector3f>(numbers.position).cast<double>(),
          Eigen::Map<Eigen::Vector3f>(numbers.velocity).cast<double>(), numbers.volume,
          static_cast<std::uint64_t>(id)};
}

}  // namespace

double radiusOf(const fluid::Drop& drop) { return std::cbrt(3 * drop.volume / (4 * std::numbers::pi)); }

void writeDropsPly(const std::string& path, const std::vector<fluid::Drop>& drops, const FrameStamp& stamp) {
  std::string contents = headerOf(drops.size(), stamp);
  for (const fluid::Drop& drop : drops) putRecord(contents, drop);
  replaceFile(path, contents);
}

std::vector<fluid::Drop> readDropsPly(const std::string& path) {
  constexpr char kEnd[] = "end_header\n";
  const std::string contents = readFile(path);
  const std::size_t end = contents.find(kEnd);
  const std::size_t properties = contents.find(kProperties);
  if (end == std::string::npos || properties == std::string::npos || properties > end)
    throw SceneError(path + ": is not a PLY file of drops as this program writes it");
  const std::size_t body = end + std::strlen(kEnd);
  if ((contents.size() - body) % kRecordBytes) throw SceneError(path + ": is cut off");
  std::vector<fluid::Drop> drops;
  for (std::size_t at = body; at < contents.size(); at += kRecordBytes)
    drops.push_back(takeRecord(contents.data() + at));
  std::sort(drops.begin(), drops.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return drops;
}

}  // namespace spume::coupling
