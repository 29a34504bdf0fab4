#include "foam/forces/contact_damping.h"

#include <cmath>

namespace spume::foam {

double contactDamping(double zeta, double stiffness, double massI, double massJ) {
  return 2 * zeta * std::sqrt(stiffness * massI * massJ / (massI + massJ));
}

}  // namespace spume::foam
