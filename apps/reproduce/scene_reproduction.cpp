#include "apps/reproduce/scene_studies.h"

namespace spume::apps {

Reproduction sceneReproduction() {
  return {"scenes",
          "The paper's scenes beside ours",
          {clusterStudy(), soapStudy(), pouringStudy(), cokeStudy(), crowdedCokeStudy()},
          {{"cluster_volume.svg", "cluster: worst error of a bubble's volume against frame, as Fig. 6"},
           {"soap_growth.svg", "soap: bubbles, and the time of a frame"},
           {"pouring_lives.svg", "pouring: share of the bubbles that burst within a time out of the water"},
           {"coke_clusters.svg", "coke: how floating bubbles lie, with attraction and without, as Fig. 10"},
           {"coke_100k_frames.svg", "coke_100k: time and complexity of a frame, as Fig. 7"}}};
}

}  // namespace spume::apps
