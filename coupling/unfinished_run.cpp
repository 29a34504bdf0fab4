#include "coupling/unfinished_run.h"

#include <filesystem>

#include "coupling/atomic_file.h"
#include "coupling/checkpoint.h"
#include "coupling/run_summary.h"
#include "coupling/scene_toml.h"

namespace spume::coupling {
namespace {

constexpr char kWayOut[] = "; --restart starts anew and removes them, -o names another folder";

}  // namespace

Beginning beginningIn(const RunFolder& folder, const Scene& scene) {
  const int last = folder.lastFrame();
  if (last == 0) return Beginning::afresh;
  const std::string found =
      folder.root() + ": holds frames up to " + std::to_string(last) + " and no checkpoint to go on from";
  if (!std::filesystem::exists(folder.scene()))
    throw FileError(found + ", and no scene.toml that says of which scene" + kWayOut);
  std::string differences;
  for (const std::string& difference : sceneDifferences(readFile(folder.scene()), writeScene(scene)))
    differences += " " + difference + ";";
  if (!differences.empty()) {
    differences.pop_back();
    throw SceneError(found + "; they belong to another run:" + differences + kWayOut);
  }
  // A job that was killed early is submitted again by the same command, which must not need a person. Nothing
  // is lost by it: the same scene makes the same frames bit for bit, and each stays until its like replaces
  // it, as after any checkpoint. Where run.json says that the run came to an end, or a checkpoint had been
  // due, somebody has removed it, and hours of work may be all that is there.
  const bool killedEarly =
      isUnderWay(folder.runJson()) && last <= readScene(folder.scene()).output.checkpointEvery;
  if (!killedEarly) throw FileError(found + kWayOut);
  return Beginning::again;
}

}  // namespace spume::coupling
