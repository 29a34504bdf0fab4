#include "coupling/run_folder.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "coupling/atomic_file.h"
#include "coupling/scene_toml.h"

namespace spume::coupling {
namespace {

constexpr const char* kFrameFolders[] = {"liquid", "bubbles", "drops", "films", "preview"};
constexpr const char* kFolders[] = {"liquid", "bubbles", "drops", "films", "preview", "checkpoint"};
// run.json tells a run's folder from others: it is written first and removed last.
constexpr const char* kFiles[] = {"steps.csv", "frames.csv", "events.csv", "probes.csv",
                                  "log.txt",   "scene.toml", "run.json"};

std::string numbered(const std::string& stem, int frame, const char* suffix) {
  char number[16];
  std::snprintf(number, sizeof number, ".%04d", frame);
  return stem + number + suffix;
}

/// Whether a file in `folder` is one that a run writes there: liquid.0001.vdb in liquid, and so on.
bool isOurs(const std::filesystem::path& file, const std::string& folder) {
  return file.filename().string().rfind(folder + ".", 0) == 0;
}

/// Number of such a file's frame, or of a row of frames.csv; 0 if it has none.
int frameIn(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0 ? std::max(0, std::atoi(text.c_str() + start.size())) : 0;
}

}  // namespace

RunFolder::RunFolder(std::string root) : root_(std::move(root)) {
  for (const char* folder : kFolders) createFolder(root_ + "/" + folder);
}

void RunFolder::requireNoForeignFile(const std::string& root, bool restart) {
  std::error_code ignored;
  if (std::filesystem::exists(root + "/run.json", ignored)) return;
  for (const std::string file : kFiles) {
    const bool given = restart && file != "scene.toml";
    if (!given && std::filesystem::exists(root + "/" + file, ignored))
      throw FileError(root + "/" + file +
                      ": no run wrote this file, and one would replace it; name another " + "folder with -o" +
                      (file == "scene.toml" ? "" : ", or give it up with --restart"));
  }
}

std::string RunFolder::liquid(int frame) const { return numbered(root_ + "/liquid/liquid", frame, ".vdb"); }
std::string RunFolder::bubblesVdb(int frame) const {
  return numbered(root_ + "/bubbles/bubbles", frame, ".vdb");
}
std::string RunFolder::bubblesPly(int frame) const {
  return numbered(root_ + "/bubbles/bubbles", frame, ".ply");
}
std::string RunFolder::dropsVdb(int frame) const { return numbered(root_ + "/drops/drops", frame, ".vdb"); }
std::string RunFolder::dropsPly(int frame) const { return numbered(root_ + "/drops/drops", frame, ".ply"); }
std::string RunFolder::films(int frame) const { return numbered(root_ + "/films/films", frame, ".ply"); }
std::string RunFolder::preview(int frame) const {
  return numbered(root_ + "/preview/preview", frame, ".png");
}

int RunFolder::lastFrame() const {
  int last = 0;
  std::error_code ignored;
  for (const std::string folder : kFrameFolders)
    for (const auto& entry : std::filesystem::directory_iterator(root_ + "/" + folder, ignored))
      last = std::max(last, frameIn(entry.path().filename().string(), folder + "."));
  std::ifstream rows(root_ + "/frames.csv");
  for (std::string row; std::getline(rows, row);) last = std::max(last, frameIn(row, ""));
  return last;
}

void RunFolder::writeScene(const Scene& scene) const {
  replaceFile(this->scene(), coupling::writeScene(scene));
}

void RunFolder::clear() const {
  std::error_code ignored;
  for (const std::string folder : kFolders)
    for (const auto& entry : std::filesystem::directory_iterator(root_ + "/" + folder, ignored))
      if (isOurs(entry.path(), folder)) std::filesystem::remove(entry.path(), ignored);
  for (const char* file : kFiles) std::filesystem::remove(root_ + "/" + file, ignored);
}

}  // namespace spume::coupling
