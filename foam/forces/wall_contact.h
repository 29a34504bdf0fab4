#pragma once

namespace spume::foam {

/// One-sided wall spring along grad psi, k max(0, gap - psi) [N]: `gap` is r for a free bubble, 0 for one
/// that adheres (model, "wall contact"); `stiffness` [N/m].
double wallContact(double stiffness, double psi, double gap);

/// d force / d psi [N/m], <= 0.
double wallContactSlope(double stiffness, double psi, double gap);

}  // namespace spume::foam
