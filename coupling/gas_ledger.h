#pragma once

namespace spume::coupling {

/// Gas since the start of the run [m^3], closed to 1e-12 of `entered()`:
/// inBubbles + inReservoirs = entered() - burst - killed - left.
struct GasLedger {
  double bornMarkers = 0;     ///< paid by escaped markers
  double bornPockets = 0;     ///< paid by collapsed pockets
  double bornSources = 0;     ///< bubble sources and bubbles the scene starts with
  double bornNucleation = 0;  ///< out of solution at walls
  double grown = 0;           ///< taken up from dissolved gas, less what was given back to it
  double burst = 0, killed = 0,
         left = 0;          ///< given back to the air, removed by the scene, gone from the domain
  double notEntrained = 0;  ///< leavers below the onset: booked, never a bubble
  double unplaced = 0;      ///< of sources whose bubbles found no place: booked, never a bubble
  double inBubbles = 0, inReservoirs = 0;  ///< held at the end

  double entered() const { return bornMarkers + bornPockets + bornSources + bornNucleation + grown; }
  double imbalance() const { return inBubbles + inReservoirs - (entered() - burst - killed - left); }
};

/// Of a bubble born from the motion of the liquid.
enum class BirthCause { marker, pocket };

}  // namespace spume::coupling
