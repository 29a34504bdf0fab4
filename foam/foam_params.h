#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace spume::foam {

enum class Preset { paper, physical };
enum class DragLaw { coefficient, contaminated, clean };
enum class BuoyancyLaw { hydrostatic, pressureGradient };
enum class AirDragLaw { coefficient, stokes };
enum class AttractionLaw { none, coefficient, capillary };
enum class WetnessLaw { constant, height, perBubble };
enum class VolumeMode { relax, newton };
/// Which engine finds contacts and cells of the whole foam: PowerCells, or PowerDiagram as the reference.
/// What comes of it differs by round-off; the latter takes some twenty times as long.
enum class Connectivity { local, global };
/// Conjugate gradients with the diagonal blocks or an incomplete Cholesky factor, or a direct factorisation.
enum class LinearSolver { pcgJacobi, pcgIncompleteCholesky, cholmod };

/// How bubbles take to a solid.
struct SolidSurface {
  double adhesion = 0.05;  ///< s_sad of Eq. 7 [N/m], 0 to 100
  /// largest bubble it holds against its full buoyancy [m], 0 to 1; 0: clean glass, nothing sticks
  double detachRadius = 0;
  double attraction = 2e-7;  ///< beta of Eq. 8 in AttractionLaw::coefficient [N m], 0 to 1
  /// through the liquid, in AttractionLaw::capillary [degrees], 0 (wetting) to 180; glass that has been
  /// touched
  double contactAngle = 60;
};

/// Every number that tunes the foam; `presets.h` fills it for a named preset and a scene may override any
/// entry. `validate()` is called once, by FoamSolver's constructor.
struct FoamParams {
  Eigen::Vector3d gravity{0, -9.8, 0};  ///< [m/s^2]
  double density = 1000;                ///< rho of the liquid [kg/m^3], 1 to 20000
  double gasDensity = 1.2;              ///< [kg/m^3], 0 to 1000; air
  double viscosity = 1.002e-3;          ///< of the liquid, for the drag law [Pa s], 1e-5 to 100
  double gasViscosity = 1.8e-5;         ///< of the air, for the damping aloft [Pa s], 0 to 1
  double surfaceTension = 0.0728;       ///< sigma [N/m], 0.001 to 1

  /// lambda everywhere the same, changing with the height above the surface, or as each bubble was born with
  WetnessLaw wetnessLaw = WetnessLaw::height;
  double wetness = 0.4;         ///< lambda of Eq. 1 [-], 0 to 1; of bubbles born without one
  double wetnessAloft = 0.4;    ///< lambda at wetnessHeight above the surface [-], 0 to 1
  double wetnessHeight = 0.02;  ///< height over which lambda goes to wetnessAloft [m], > 0

  double springStiffness = 2;  ///< k of Eq. 2 [N/m], 0 to 1e7
  bool springFromSurfaceTension =
      false;  ///< k_ij = max(2 pi sigma s, 20 rho g r_i r_j) instead of max(k, floor)
  double springSurfaceTensionFactor = 0.75;  ///< s in that law [-], 0.5 to 1
  double springFloor = 20;                   ///< floor 20 rho g r_i r_j of the stiffness [-], 0 to 1000

  DragLaw dragLaw = DragLaw::contaminated;
  double dragCoefficient = 500;  ///< c of Eq. 3 [kg/m^3], 0 to 1e5
  /// largest radius c of Eq. 3 is used for in DragLaw::coefficient; contaminated above it [m], 0 to 1
  double dragCoefficientLimit = 1;
  BuoyancyLaw buoyancyLaw = BuoyancyLaw::hydrostatic;
  AirDragLaw airDragLaw = AirDragLaw::stokes;
  double airDragCoefficient = 5e-8;  ///< c_vis of Eq. 10 in AirDragLaw::coefficient [kg/s], 0 to 1e3
  double addedMass = 0.5;            ///< C_M [-], 0 to 2
  double liquidAdhesion = 0.3;       ///< s_lad of Eq. 5 [N/m], 0 to 100
  /// between floating bubbles, and of solids for them; none costs nothing
  AttractionLaw attractionLaw = AttractionLaw::none;
  bool weakPairs = true;             ///< floating bubbles attract each other; off: only solids attract them
  double attraction = 4e-6;          ///< alpha of Eq. 6 in AttractionLaw::coefficient [N], 0 to 1
  SolidSurface walls;                ///< of the domain, and of solids beyond the list
  std::vector<SolidSurface> solids;  ///< by solid index
  double wallStiffnessFactor = 10;   ///< wall spring = factor x spring stiffness [-], 0 to 1000
  double contactDamping = 0.2;       ///< zeta of c_lap = 2 zeta sqrt(k m) [-], 0 to 5
  /// rate at which films draw their borders to Plateau's law, see border_drift.h [1/s], 0 (none, costs
  /// nothing) to 100; a step goes at most a tenth of the way, which rates above 5 meet in steps of 20 ms
  double borderRate = 0;

  Connectivity connectivity = Connectivity::local;

  VolumeMode volumeMode = VolumeMode::relax;  ///< each cell by itself, or all with their neighbours in mind
  double volumeRate = 10;                     ///< gamma [1/s], 0 to 1000
  double volumeTolerance = 1e-3;              ///< |V - V0| / V0 newton leaves at most [-], 1e-10 to 0.1
  double radiusLimit = 2;                     ///< largest r / r0 [-], 1.1 to 10

  bool bursting = true;
  double burstMedianLife = 1;          ///< median life in air at burstReferenceRadius [s], 1e-3 to 1e9
  double burstReferenceRadius = 1e-3;  ///< [m], 1e-6 to 1
  double burstShape = 2;  ///< Weibull shape: 2 Rayleigh (Eq. 11 as a hazard), 4/3 thin films; 0.5 to 10
  /// hazard of a bubble that touches a solid over that of one in the open [-], 0 to 1; 1: walls do not matter
  double burstWallFactor = 1;
  double burstWallDistance = 0.01;  ///< psi from which on the hazard is whole again [m], 1e-6 to 1

  LinearSolver solver = LinearSolver::pcgIncompleteCholesky;
  /// Relative residual of the implicit step, 1e-12 to 1e-1. 1e-5 leaves a hundredth of what half the step
  /// would change (data/results/foam_speed.md).
  double solverTolerance = 1e-5;
  int solverIterations = 500;  ///< 1 to 100000
  std::uint64_t seed = 1;

  const SolidSurface& surfaceOf(int solid) const {
    return solid >= 0 && solid < static_cast<int>(solids.size()) ? solids[solid] : walls;
  }

  /// Throws InvalidParameter naming the first field out of range.
  void validate() const;
};

}  // namespace spume::foam
