#pragma once

#include <string>

#include "coupling/errors.h"
#include "coupling/run_summary.h"
#include "coupling/scene.h"

namespace spume::coupling {

/// The layout of a run's folder (see README.md). The constructor creates the folders it needs.
class RunFolder {
 public:
  /// Throws FileError.
  explicit RunFolder(std::string root);

  /// Throws FileError where `root` holds no run but a file a run would write over: somebody's own scene.toml,
  /// or, unless `restart` gives leave, another such file.
  static void requireNoForeignFile(const std::string& root, bool restart);

  const std::string& root() const { return root_; }
  std::string scene() const { return root_ + "/scene.toml"; }
  std::string runJson() const { return root_ + "/run.json"; }
  std::string log() const { return root_ + "/log.txt"; }
  std::string checkpoints() const { return root_ + "/checkpoint"; }
  std::string movie() const { return root_ + "/preview/preview.mp4"; }
  std::string liquid(int frame) const;      ///< liquid/liquid.0001.vdb
  std::string bubblesVdb(int frame) const;  ///< bubbles/bubbles.0001.vdb
  std::string bubblesPly(int frame) const;  ///< bubbles/bubbles.0001.ply
  std::string dropsVdb(int frame) const;    ///< drops/drops.0001.vdb
  std::string dropsPly(int frame) const;    ///< drops/drops.0001.ply
  std::string films(int frame) const;       ///< films/films.0001.ply
  std::string preview(int frame) const;     ///< preview/preview.0001.png

  /// The last frame of which there is a cache, a picture or a row of frames.csv; 0 if there is none.
  int lastFrame() const;

  /// Writes scene.toml, every value resolved. Throws FileError.
  void writeScene(const Scene& scene) const;
  /// Removes caches, pictures, statistics and checkpoints of an earlier run: what a run writes, nothing else.
  void clear() const;

 private:
  std::string root_;
};

}  // namespace spume::coupling
