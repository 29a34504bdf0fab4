#pragma once

namespace spume::foam {

/// Wall spring along grad psi, k (gap - psi) [N]; the contact is closed, and the spring acts, while this is
/// positive (model, "wall contact"). `gap` [m] is r for a free bubble, 0 for one that adheres; `stiffness`
/// [N/m].
double wallContact(double stiffness, double psi, double gap);

/// d force / d psi of a closed contact [N/m], < 0.
double wallContactSlope(double stiffness);

}  // namespace spume::foam
