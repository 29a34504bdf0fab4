#pragma once

#include <map>
#include <string>
#include <vector>

#include "coupling/errors.h"
#include "coupling/gas_ledger.h"
#include "coupling/scene.h"
#include "coupling/simulation.h"

namespace spume::coupling {

/// What run.json says about a run, beside machine and versions.
struct RunSummary {
  std::string status = "running";  ///< running, done, stopped, failed
  int threads = 0;                 ///< 0: as many as the machine has
  int frames = 0, steps = 0;
  double simulatedTime = 0, wallSeconds = 0;  ///< [s]; wall time of the frames
  std::size_t births = 0, bursts = 0, bubbles = 0, mostBubbles = 0;
  GasLedger gas;
  double liquidVolume = 0, targetVolume = 0, poured = 0, drained = 0;  ///< [m^3]
  std::vector<std::string> switchedOff;        ///< features the scene does not ask for
  std::map<std::string, double> stageSeconds;  ///< "liquid", "foam", "entrainment" and each of their stages
};

/// Adds a frame to the totals.
void accumulate(RunSummary& summary, const FrameReport& frame);

/// What to say where the grid liquid ended far from what it should hold; empty where it did not. `cellVolume`
/// [m^3] is that of the grid.
std::string volumeWarning(const RunSummary& summary, double cellVolume);

/// Features of the program that this scene leaves out, in words.
std::vector<std::string> switchedOff(const Scene& scene);

/// Whether a run.json says that its run has neither ended nor stopped, and is one of this very program: same
/// version, same SIMD path. False if there is none.
bool isUnderWay(const std::string& path);

/// Writes run.json. Atomic. Throws FileError.
void writeRunJson(const std::string& path, const Scene& scene, const RunSummary& summary);

}  // namespace spume::coupling
