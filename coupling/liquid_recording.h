#pragma once

#include <string>
#include <vector>

#include "coupling/cache_listing.h"
#include "coupling/entrainment.h"
#include "coupling/scene.h"
#include "coupling/simulation.h"

namespace spume::coupling {

/// A bubble that the motion of a liquid bore.
struct RecordedBirth {
  double time;               ///< end of the step it was born in [s]
  Eigen::Vector3d position;  ///< [m]
  double radius;             ///< [m]
  BirthCause cause;
};

/// What the folder of a run keeps of its liquid.
class LiquidRecording {
 public:
  /// Throws FileError (a file is missing or cannot be read) or SceneError (its content; no cached liquid).
  explicit LiquidRecording(const std::string& folder);

  const std::string& folder() const { return folder_; }
  /// liquid/liquid.####.vdb.
  const CacheListing& frames() const { return frames_; }
  /// Every step with what frames.csv and run.json sum up of it, by time.
  const std::vector<StepReport>& steps() const { return steps_; }
  /// Of markers and pockets, by time.
  const std::vector<RecordedBirth>& births() const { return births_; }

  /// Throws SceneError with every difference, if the liquid of `scene` is not the one that was recorded:
  /// other keys of the domain, the liquid, what it flows round, in and out of, or of what it entrains.
  void requireSameLiquid(const Scene& scene) const;

 private:
  std::string folder_;
  CacheListing frames_;
  std::vector<StepReport> steps_;
  std::vector<RecordedBirth> births_;
};

}  // namespace spume::coupling
