#include "coupling/momentum_exchange.h"

namespace spume::coupling {

std::vector<fluid::Push> reactions(const std::vector<foam::DragImpulse>& drag) {
  std::vector<fluid::Push> pushes;
  pushes.reserve(drag.size());
  for (const foam::DragImpulse& on : drag) {
    const double size = on.impulse.norm();
    if (size > 0 && on.slip > 0) pushes.push_back({on.position, -on.impulse, size / on.slip});
  }
  return pushes;
}

}  // namespace spume::coupling
