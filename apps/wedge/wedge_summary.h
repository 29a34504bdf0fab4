#pragma once

#include <string>
#include <vector>

namespace spume::apps {

/// How far the run of a variant is and what came out so far.
struct VariantSummary {
  std::string folder;
  std::vector<std::string> values;  ///< of the keys that vary
  std::string status;               ///< "not begun", or what run.json says: running, stopped, failed, done
  int frames = 0;
  double bubbles = 0, mostBubbles = 0, births = 0, contacts = 0;  ///< last, most, all and last [-]
  double seconds = 0, liquidSeconds = 0, foamSeconds = 0;         ///< a frame, mean [s]
  double volumeDrift = 0;  ///< of the liquid against what it should be, worst frame [-]
  double volumeError = 0;  ///< of a bubble's cell, worst frame [-]
};

/// The outcome of a sweep.
struct WedgeSummary {
  std::vector<std::string> keys;
  std::vector<VariantSummary> variants;

  std::string csv() const;
  /// A line a variant for a terminal.
  std::string text() const;
};

/// Reads wedge.csv of a sweep's folder and what its runs have written. Throws coupling::FileError or
/// SceneError.
WedgeSummary summarize(const std::string& folder);

}  // namespace spume::apps
