#include "apps/wedge/wedge_folder.h"

#include <filesystem>

#include "coupling/atomic_file.h"
#include "coupling/checkpoint.h"

namespace spume::apps {
namespace {

namespace fs = std::filesystem;

/// A run that was begun in a variant's folder must be of the same scene, but for what may change on the way.
void requireSameRun(const WedgeVariant& variant, const std::string& folder) {
  const std::string begun = folder + "/" + variant.folder + "/scene.toml";
  if (!fs::exists(begun)) return;
  const auto differences =
      coupling::sceneDifferences(coupling::readFile(begun), coupling::writeScene(variant.scene));
  if (differences.empty()) return;
  throw coupling::SceneError(folder + "/" + variant.folder + ": holds a run of another scene (" +
                             differences.front() + "); name another folder with -o, or remove this one");
}

const std::string kScriptStart = std::string("#!/bin/sh\n") + kWedgeMark, kTableStart = "folder,";

/// Throws FileError if the file is there and no sweep wrote it: those of a sweep begin with `start`.
void requireOurs(const std::string& path, const std::string& start) {
  if (!fs::exists(path) || coupling::readFile(path).starts_with(start)) return;
  throw coupling::FileError(path + ": no sweep wrote this file, and one would replace it; name another " +
                            "folder with -o");
}

void writeScript(const std::string& path, const std::string& text) {
  coupling::replaceFile(path, text);
  std::error_code ignored;  // a file system without such bits: `sh commands.sh` works all the same
  fs::permissions(path, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                  fs::perm_options::add, ignored);
}

}  // namespace

void writeWedge(const Wedge& wedge, const std::string& folder, const std::string& program,
                const std::optional<SlurmRequest>& slurm) {
  for (const char* script : {"/commands.sh", "/wedge.sbatch"}) requireOurs(folder + script, kScriptStart);
  for (const char* table : {"/wedge.csv", "/summary.csv"}) requireOurs(folder + table, kTableStart);
  for (const WedgeVariant& variant : wedge.variants) requireSameRun(variant, folder);
  for (const WedgeVariant& variant : wedge.variants) {
    coupling::createFolder(folder + "/" + variant.folder);
    coupling::replaceFile(folder + "/" + variant.folder + "/" + kVariantScene,
                          coupling::writeScene(variant.scene));
  }
  coupling::replaceFile(folder + "/wedge.csv", wedgeTable(wedge));
  writeScript(folder + "/commands.sh", commandScript(wedge, program));
  if (slurm) writeScript(folder + "/wedge.sbatch", slurmScript(wedge, *slurm));
}

void writeSummary(const WedgeSummary& summary, const std::string& folder) {
  requireOurs(folder + "/summary.csv", kTableStart);
  coupling::replaceFile(folder + "/summary.csv", summary.csv());
}

}  // namespace spume::apps
