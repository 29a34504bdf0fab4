#pragma once

#include <cmath>

namespace spume::foam {

/// c_lap of the pairwise damping -c_lap (v_i - v_j) of a contact [kg/s]: 2 zeta sqrt(k m) with the pair's
/// reduced mass. Deviation: Eq. 10's normalised Laplacian drags a cluster that moves rigidly; the pairwise
/// form conserves momentum.
inline double contactDamping(double zeta, double stiffness, double massI, double massJ) {
  return 2 * zeta * std::sqrt(stiffness * massI * massJ / (massI + massJ));
}

}  // namespace spume::foam
