#include "apps/reproduce/reproduction.h"

namespace spume::apps {

const std::vector<Reproduction>& reproductions() {
  static const std::vector<Reproduction> kAll{liquidReproduction(), foamReproduction(), sceneReproduction()};
  return kAll;
}

}  // namespace spume::apps
