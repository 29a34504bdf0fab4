#include "foam/forces/wall_contact.h"

namespace spume::foam {

double wallContact(double stiffness, double psi, double gap) { return stiffness * (gap - psi); }

double wallContactSlope(double stiffness) { return -stiffness; }

}  // namespace spume::foam
