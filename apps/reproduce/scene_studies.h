#pragma once

#include "apps/reproduce/reproduction.h"

namespace spume::apps {

// The scenes of the founding paper [Busaryev 2012], each in a file of its own.
Study clusterStudy();
Study soapStudy();
Study pouringStudy();
Study cokeStudy();
Study crowdedCokeStudy();

}  // namespace spume::apps
