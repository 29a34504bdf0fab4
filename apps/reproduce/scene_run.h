#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/reproduce/reproduction.h"
#include "coupling/liquid_part.h"
#include "coupling/scene_toml.h"
#include "coupling/simulation.h"
#include "foam/foam_topology.h"

namespace spume::apps {

/// Columns of a run, one entry a frame.
struct FrameCurves {
  std::vector<double> frame, time;                 ///< [-], [s]
  std::vector<double> steps, foamSteps;            ///< shared ones, and those the foam split them into [-]
  std::vector<double> bubbles, surface, contacts;  ///< at the frame's end [-]
  std::vector<double> overlaps, flagged;           ///< pairs of balls; hidden or at their limit [-]
  std::vector<double> seconds, foamSeconds;        ///< whole; without the liquid, as the paper counts [s]
  std::vector<double> liquidSeconds;               ///< of the liquid [s]
  std::vector<double> diagramSeconds;              ///< of power cells, contacts and volumes [s]
  std::vector<double> worstVolume, medianVolume;   ///< |V - V0|/V0 of unflagged bubbles [-]
  std::vector<double> births, gas;                 ///< in the frame [-]; in the bubbles at its end [m^3]
  std::vector<double> liquidVolume, targetVolume;  ///< of the grid liquid, and what it should be [m^3]
  std::vector<double> foamIterations, pressureIterations;  ///< of their solvers, summed over the frame [-]

  std::size_t size() const { return frame.size(); }
};

/// Reads frames.csv and steps.csv of a run's folder. Throws coupling::FileError or SceneError.
FrameCurves readFrameCurves(const std::string& folder);

/// A scene that has run, with its last state.
struct SceneRun {
  std::string name;
  coupling::Scene scene;
  std::string folder;
  FrameCurves frames;
  coupling::SimulationState state;  ///< its liquid has moved into `liquid`
  std::unique_ptr<coupling::LiquidPart> liquid;
  foam::FoamTopology topology;  ///< of the last bubbles, walls left out

  const foam::BubbleStore& bubbles() const { return state.bubbles; }
  /// Distance of points to solids and walls as the foam sees it [m].
  Eigen::VectorXd distanceToSolids(const std::vector<Eigen::Vector3d>& points) const;
};

/// Runs a scene, or goes on with it, in the folder `variant` of the runs, and reads what it left. The run
/// writes no caches but the PLY of bubbles. Throws what the run throws, and SceneError or FileError;
/// SceneError, too, where the folder holds a longer run than asked for.
SceneRun runScene(const StudyContext& context, const coupling::Scene& scene, const std::string& variant);

/// The same of `name`.toml in the folder of the scenes, as long as the context says.
SceneRun runScene(const StudyContext& context, const std::string& name, const std::string& variant,
                  const coupling::Overrides& overrides = {});

/// The bubbles of every cached frame of a run from `firstFrame` on; columns that are not cached hold their
/// defaults.
struct CachedFrame {
  int frame;
  foam::BubbleStore bubbles;
};
std::vector<CachedFrame> cachedFrames(const SceneRun& run, int firstFrame);

}  // namespace spume::apps
