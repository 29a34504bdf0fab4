#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coupling/liquid_cache.h"

namespace spume::coupling {

/// The numbered files of one kind in a run's folder, and what they weigh.
struct CacheListing {
  std::vector<int> frames;         ///< ascending
  std::vector<std::string> paths;  ///< of the frames
  std::uintmax_t bytes = 0;

  int lastFrame() const { return frames.empty() ? 0 : frames.back(); }
};

/// Files `stem`.####.`extension` of `folder`, e.g. ("out/pouring/liquid", "liquid", "vdb"). Empty if there
/// are none.
CacheListing listCache(const std::string& folder, const std::string& stem, const std::string& extension);

/// "1-150" or "1-150 (148 files)" where numbers are missing; "none" for an empty listing.
std::string describeFrames(const CacheListing& listing);

/// "3, 7-9": numbers that ascend, runs of neighbours as ranges.
std::string describeNumbers(const std::vector<int>& numbers);

/// Volume of the grid liquid of a cached frame [m^3], solids left out.
double cachedLiquidVolume(const LiquidFrame& frame);

}  // namespace spume::coupling
