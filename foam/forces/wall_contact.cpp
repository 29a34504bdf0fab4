#include "foam/forces/wall_contact.h"

#include <algorithm>

namespace spume::foam {

double wallContact(double stiffness, double psi, double gap) { return stiffness * std::max(0.0, gap - psi); }

double wallContactSlope(double stiffness, double psi, double gap) { return psi < gap ? -stiffness : 0; }

}  // namespace spume::foam
