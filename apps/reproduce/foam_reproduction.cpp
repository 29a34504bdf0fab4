#include "apps/reproduce/foam_studies.h"

namespace spume::apps {

Reproduction foamReproduction() {
  Reproduction table{"foam", "The foam beside published and exact figures", {}};
  for (const std::vector<Study>& studies :
       {loneBubbleStudies(), attractionStudies(), clusterStudies(), packingStudies(), contactStudies(),
        crowdStudies(), restStudies()})
    table.studies.insert(table.studies.end(), studies.begin(), studies.end());
  return table;
}

}  // namespace spume::apps
