#pragma once

#include <cstddef>
#include <vector>

#include "apps/reproduce/soft_packing.h"

namespace spume::apps {

/// Shear modulus of `balls` balls at rest that touch as listed, in a periodic box of that volume: the second
/// derivative of the springs' energy by a simple shear the balls may answer by moving, over the volume, mean
/// of the planes there are (xy in 2D; xy, yz and zx in 3D) [stiffness / radius^(dimensions - 2)]. With e the
/// change of a contact's separation by the shear, M its stiffness and H that of all: (sum e M e - X H^-1
/// X)/V, where X is what the shear alone does to the forces. Balls that touch none, or only balls of
/// `contacts` which are held by nothing else, must not be listed. NaN if the contacts do not hold each other.
double shearModulus(const std::vector<SoftPacking::Contact>& contacts, std::size_t balls, int dimensions,
                    double volume);

}  // namespace spume::apps
