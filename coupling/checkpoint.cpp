#include "coupling/checkpoint.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "coupling/atomic_file.h"
#include "coupling/scene_toml.h"
#include "coupling/simd_path.h"
#include "coupling/state_archive.h"

namespace spume::coupling {
namespace {

constexpr std::size_t kKept = 2;  // checkpoints: the newest may be damaged by a dying disk
constexpr char kMagic[8] = {'S', 'P', 'U', 'M', 'E', 'C', 'K', 'P'};
constexpr std::uint32_t kVersion = 8;  // of the format
constexpr char kPrefix[] = "checkpoint.", kSuffix[] = ".bin";

struct Header {
  char magic[8];
  std::uint32_t version;
  std::uint32_t reserved;
  std::uint64_t size;      ///< of what follows [bytes]
  std::uint64_t checksum;  ///< of what follows
};
static_assert(sizeof(Header) == 32);

/// 64-bit check sum of eight interleaved streams (so that it runs at memory speed); not meant against
/// forgery.
std::uint64_t checksumOf(std::string_view bytes) {
  constexpr std::uint64_t kPrime = 0x9e3779b97f4a7c15ull;
  std::uint64_t lanes[8] = {1, 2, 3, 4, 5, 6, 7, 8};
  while (!bytes.empty()) {
    std::uint64_t words[8] = {};
    const std::size_t size = std::min(bytes.size(), sizeof words);
    std::memcpy(words, bytes.data(), size);
    for (int i = 0; i < 8; ++i) lanes[i] = std::rotl((lanes[i] ^ words[i]) * kPrime, 29);
    bytes.remove_prefix(size);
  }
  std::uint64_t sum = 0;
  for (const std::uint64_t lane : lanes) sum = std::rotl((sum ^ lane) * kPrime, 31);
  return sum;
}

/// Writers only read what they are given, but share their functions with the reader, which does not.
template <typename Value>
Value& asWritable(const Value& value) {
  return const_cast<Value&>(value);
}

std::string payloadOf(const Scene& scene, const SimulationState& state) {
  ArchiveWriter writer;
  std::string text = writeScene(scene), simd = kSimdPath;
  archiveAll(writer, text, simd, asWritable(state));
  return std::move(writer.bytes);
}

/// The part of a checkpoint file after its header, checked. Throws DamagedData.
std::string_view payloadOf(const std::string& contents) {
  Header header;
  if (contents.size() < sizeof header) throw DamagedData("it is too short to be a checkpoint");
  std::memcpy(&header, contents.data(), sizeof header);
  if (std::memcmp(header.magic, kMagic, sizeof kMagic)) throw DamagedData("it is no checkpoint");
  if (header.version != kVersion)
    throw DamagedData("its format is version " + std::to_string(header.version) +
                      ", this program reads version " + std::to_string(kVersion));
  const std::string_view payload = std::string_view(contents).substr(sizeof header);
  if (payload.size() != header.size)
    throw DamagedData("it holds " + std::to_string(payload.size()) + " of " + std::to_string(header.size) +
                      " bytes");
  if (checksumOf(payload) != header.checksum) throw DamagedData("its checksum does not match its contents");
  return payload;
}

struct Contents {
  std::string scene, simd;
  SimulationState state;
};

Contents readCheckpoint(const std::string& path) {
  const std::string bytes = readFile(path);
  ArchiveReader reader(payloadOf(bytes));
  Contents contents;
  archiveAll(reader, contents.scene, contents.simd, contents.state);
  if (!reader.atEnd()) throw DamagedData("it holds more than a state");
  return contents;
}

/// Paths of a folder's checkpoints, newest first.
std::vector<std::string> checkpointsIn(const std::string& folder) {
  std::map<long, std::string, std::greater<>> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    long frame = 0;
    int used = 0;
    const bool named = std::sscanf(name.c_str(), "checkpoint.%ld.bin%n", &frame, &used) == 1;
    if (named && static_cast<std::size_t>(used) == name.size()) found[frame] = entry.path().string();
  }
  std::vector<std::string> paths;
  for (const auto& [frame, path] : found) paths.push_back(path);
  return paths;
}

void requireSameRun(const std::string& path, const Contents& contents, const Scene& scene) {
  std::vector<std::string> differences = sceneDifferences(contents.scene, writeScene(scene));
  if (contents.simd != kSimdPath)
    differences.push_back("SIMD path = " + contents.simd + " there, " + kSimdPath + " here");
  if (differences.empty()) return;
  std::string message = path + ": belongs to another run; start anew or undo the difference:";
  for (const std::string& difference : differences) message += " " + difference + ";";
  message.pop_back();
  throw SceneError(message);
}

/// Dotted key -> value of a text that writeScene wrote.
std::map<std::string, std::string> valuesOf(const std::string& text) {
  std::map<std::string, std::string> values;
  std::map<std::string, int> items;
  std::istringstream lines(text);
  std::string line, table;
  while (std::getline(lines, line)) {
    if (line.rfind("[[", 0) == 0) {
      table = line.substr(2, line.size() - 4);
      const int item = items[table]++;
      table.append(".").append(std::to_string(item));
    } else if (line.rfind("[", 0) == 0) {
      table = line.substr(1, line.size() - 2);
    } else if (const std::size_t equals = line.find(" = "); equals != std::string::npos) {
      const std::size_t unit = line.rfind("   # ");
      values[table + "." + line.substr(0, equals)] =
          line.substr(equals + 3, unit - std::min(unit, equals + 3));
    }
  }
  return values;
}

bool changesTheMotion(const std::string& key) {
  static const std::set<std::string> kFree{"scene.name", "scene.title", "time.frames"};
  return key.rfind("output.", 0) != 0 && key.rfind("camera.", 0) != 0 && key.rfind("look.", 0) != 0 &&
         !kFree.count(key);
}

}  // namespace

void writeCheckpoint(const std::string& folder, const Scene& scene, const SimulationState& state) {
  createFolder(folder);
  char number[16];
  std::snprintf(number, sizeof number, "%06d", state.frame);
  const std::string payload = payloadOf(scene, state);
  Header header{{}, kVersion, 0, payload.size(), checksumOf(payload)};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  std::string contents(reinterpret_cast<const char*>(&header), sizeof header);
  replaceFile(folder + "/" + kPrefix + number + kSuffix, contents += payload);
  const std::vector<std::string> paths = checkpointsIn(folder);
  for (std::size_t n = kKept; n < paths.size(); ++n) std::filesystem::remove(paths[n]);
}

std::optional<LoadedCheckpoint> readNewestCheckpoint(const std::string& folder, const Scene& scene) {
  LoadedCheckpoint loaded;
  const std::vector<std::string> paths = checkpointsIn(folder);
  for (const std::string& path : paths) {
    try {
      Contents contents = readCheckpoint(path);
      requireSameRun(path, contents, scene);
      loaded.path = path;
      loaded.state = std::move(contents.state);
      return loaded;
    } catch (const DamagedData& damage) {
      loaded.warnings.push_back(path + ": damaged: " + damage.what());
    }
  }
  if (paths.empty()) return std::nullopt;
  throw FileError("no checkpoint can be read: " + loaded.warnings.front() +
                  "; start anew (--restart), or give the run another folder");
}

std::vector<std::string> sceneDifferences(const std::string& there, const std::string& here) {
  const std::map<std::string, std::string> before = valuesOf(there), now = valuesOf(here);
  std::set<std::string> keys;
  for (const auto& [key, value] : before) keys.insert(key);
  for (const auto& [key, value] : now) keys.insert(key);
  const auto valueIn = [](const std::map<std::string, std::string>& values, const std::string& key) {
    const auto found = values.find(key);
    return found == values.end() ? std::string("absent") : found->second;
  };
  std::vector<std::string> differences;
  for (const std::string& key : keys) {
    const std::string old = valueIn(before, key), current = valueIn(now, key);
    if (old != current && changesTheMotion(key))
      differences.push_back(key + " = " + old + " there, " + current + " here");
  }
  return differences;
}

}  // namespace spume::coupling
