#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coupling/errors.h"
#include "coupling/scene.h"
#include "coupling/simulation.h"

namespace spume::coupling {

/// The layout of a run's folder (see README.md). The constructor creates the folders it needs.
class RunFolder {
 public:
  /// Throws FileError.
  explicit RunFolder(std::string root);

  const std::string& root() const { return root_; }
  std::string scene() const { return root_ + "/scene.toml"; }
  std::string runJson() const { return root_ + "/run.json"; }
  std::string log() const { return root_ + "/log.txt"; }
  std::string checkpoints() const { return root_ + "/checkpoint"; }
  std::string movie() const { return root_ + "/preview/preview.mp4"; }
  std::string liquid(int frame) const;      ///< liquid/liquid.0001.vdb
  std::string bubblesVdb(int frame) const;  ///< bubbles/bubbles.0001.vdb
  std::string bubblesPly(int frame) const;  ///< bubbles/bubbles.0001.ply
  std::string preview(int frame) const;     ///< preview/preview.0001.png

  /// Writes scene.toml, every value resolved. Throws FileError.
  void writeScene(const Scene& scene) const;
  /// Removes caches, pictures, statistics and checkpoints of an earlier run: what RunFolder knows, nothing
  /// else.
  void clear() const;

 private:
  std::string root_;
};

/// What run.json says about a run, beside machine and versions.
struct RunSummary {
  std::string status = "running";  ///< running, done, stopped, failed
  int frames = 0, steps = 0;
  double simulatedTime = 0, wallSeconds = 0;  ///< [s]
  int threads = 0;
  std::size_t births = 0, bursts = 0, bubbles = 0;
  GasLedger gas;
  double liquidVolume = 0, poured = 0, drained = 0;  ///< [m^3]
  std::map<std::string, double> stageSeconds;        ///< summed over the run
  std::vector<std::string> switchedOff;              ///< features the scene does not ask for
};

/// Adds a frame to the totals.
void accumulate(RunSummary& summary, const FrameReport& frame);

/// Features of the program that this scene leaves out, in words.
std::vector<std::string> switchedOff(const Scene& scene);

/// Writes run.json. Atomic. Throws FileError.
void writeRunJson(const std::string& path, const Scene& scene, const RunSummary& summary);

}  // namespace spume::coupling
