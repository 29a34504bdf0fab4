#include "apps/reproduce/liquid_studies.h"

namespace spume::apps {

Reproduction liquidReproduction() {
  Reproduction table{"liquid", "The liquid beside published and exact figures", {}};
  for (const std::vector<Study>& studies :
       {transportStudies(), escapeStudies(), exactFlowStudies(), waveStudies(), damBreakStudies(),
        tankStudies(), fillingStudies(), tensionStudies()})
    table.studies.insert(table.studies.end(), studies.begin(), studies.end());
  return table;
}

}  // namespace spume::apps
