#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>

#include "coupling/distance_field.h"
#include "coupling/scene.h"

namespace spume::coupling {

/// Distances to the solids of a scene that are kept in files, each read and sampled once: checks, the liquid
/// and every picture ask for them. Thread-safe.
class SolidFileStore {
 public:
  /// As `distanceFromFile`, which see.
  std::shared_ptr<const DistanceField> distance(const ShapeSpec& shape, double dx, double longest);

 private:
  using Key = std::tuple<ShapeKind, std::string, double, double, double>;  // of all that is asked for
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const DistanceField>> fields_;
};

}  // namespace spume::coupling
