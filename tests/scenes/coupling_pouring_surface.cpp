#include <gtest/gtest.h>
#include <openvdb/tools/Diagnostics.h>

#include "coupling/scene_toml.h"
#include "coupling/simulation.h"
#include "fluid/vdb_grids.h"

namespace spume::coupling {
namespace {

/// Long enough for the jet to fall, to break up in the pool and to throw drops.
constexpr int kFrames = 24;

TEST(CoarsePouring, EverySurfacePassesTheLevelSetCheckOfOpenVdb) {
  openvdb::initialize();
  Simulation simulation(
      readScene(std::string(SPUME_SOURCE_DIR) + "/data/scenes/pouring.toml", {{"domain.resolution", "32"}}));
  for (int frame = 1; frame <= kFrames; ++frame) {
    simulation.advanceFrame();
    const auto& liquid = simulation.liquid();
    EXPECT_EQ(openvdb::tools::checkLevelSet(*fluid::surfaceGrid(liquid.grid, liquid.phi)), "")
        << "frame " << frame;
  }
}

}  // namespace
}  // namespace spume::coupling
