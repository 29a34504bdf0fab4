#include "coupling/cache_kind.h"

#include <fstream>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "coupling/atomic_file.h"
#include "coupling/vdb_file.h"

namespace spume::coupling {
namespace {

/// The first of the names that is there, by what it stands for.
std::optional<CacheKind> kindAmong(const std::set<std::string>& found,
                                   std::initializer_list<std::pair<const char*, CacheKind>> names) {
  for (const auto& [name, kind] : names)
    if (found.count(name)) return kind;
  return std::nullopt;
}

std::string listOf(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list.append(list.empty() ? "" : ", ").append(name);
  return list.empty() ? "nothing" : list;
}

}  // namespace

CacheLabel labelOfVdb(const std::string& path) {
  const openvdb::GridPtrVec grids = readVdbMetadata(path);
  std::set<std::string> names;
  for (const auto& grid : grids) names.insert(grid->getName());
  const auto kind = kindAmong(
      names, {{"surface", CacheKind::liquid}, {"bubbles", CacheKind::bubbles}, {"drops", CacheKind::drops}});
  if (!kind)
    throw SceneError(path + ": holds " + listOf(names) +
                     "; expected the grids surface and vel, or points called bubbles or drops");
  return {*kind, stampOf(*grids.front())};
}

CacheLabel labelOfPly(const std::string& path) {
  checkReadable(path);
  std::ifstream file(path, std::ios::binary);
  std::string line, last;
  std::set<std::string> properties;
  FrameStamp stamp;
  if (!std::getline(file, line) || line != "ply") throw SceneError(path + ": is not a PLY file");
  while (std::getline(file, line) && line != "end_header") {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (first == "comment" && second == "frame") words >> stamp.frame;
    if (first == "comment" && second == "time") words >> stamp.time;
    if (first == "comment" && second == "fps") words >> stamp.fps;
    while (words >> last) {
    }
    if (first == "property") properties.insert(last);
  }
  // Bubbles have all that drops have, and their class.
  const auto kind = kindAmong(
      properties, {{"id_a", CacheKind::films}, {"type", CacheKind::bubbles}, {"pscale", CacheKind::drops}});
  if (!kind)
    throw SceneError(path + ": holds " + listOf(properties) +
                     "; expected the bubbles, drops or films that this program writes");
  return {*kind, stamp};
}

}  // namespace spume::coupling
