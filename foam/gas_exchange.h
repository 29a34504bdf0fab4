#pragma once

#include <cstdint>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/surroundings.h"

namespace spume::foam {

/// Gas in solution, from which immersed bubbles grow or into which they shrink. Defaults: carbon dioxide in
/// cola at 25 C.
struct DissolvedGasParams {
  bool enabled = false;
  double concentration = 148;      ///< at the start and of what is poured in [mol/m^3], 0 to 1e5; 6.5 g/l
  double henry = 3.4e-4;           ///< saturation per pressure [mol/(m^3 Pa)], 1e-9 to 1
  double diffusivity = 1.9e-9;     ///< D in the liquid [m^2/s], 1e-12 to 1e-6
  double pressure = 101325;        ///< of the air above [Pa], 1 to 1e8
  double temperature = 298.15;     ///< [K], 200 to 500
  double surfaceTension = 0.0728;  ///< of the bubbles' surface [N/m]; the foam's
  bool depletes = true;            ///< what bubbles take is missing from the liquid

  /// Amount of gas in a volume at the pressure of the air [mol/m^3]; all gas is booked at that pressure.
  double molesPerVolume() const;
};

/// Radius [m] after dt [s] of a bubble of age `age` that slips through the liquid at `slip` [m/s]
/// [Epstein and Plesset 1950]: dr/dt = D (c - k_H (p + 2 sigma / r)) R T / p x (1/r + 1/sqrt(pi D t)). A
/// rising bubble's boundary layer is renewed: Sh/(2 r) with Sh = 1 + (1 + Pe)^(1/3), Pe = 2 r slip / D, for
/// the rigid surface of contaminated water [Clift, Grace and Weber 1978] replaces the bracket where it is
/// larger. One step of Runge and Kutta in sqrt(t), where the equation for r^2 is smooth. 0: dissolved.
double exchangedRadius(const DissolvedGasParams& params, double concentration, double radius, double age,
                       double slip, double dt);

/// A bubble smaller than this has dissolved [m]: Laplace's pressure does the rest within milliseconds.
inline constexpr double kSmallestBubble = 2e-6;

/// What a radius does when its bubble's gas changes.
enum class Radius { follows, stays };

/// Lets the immersed part of every bubble exchange gas for dt [s] with liquid of the given concentration
/// [mol/m^3]: the gas follows, and with `Radius::follows` the radius. Where volumes are held at the end of
/// each step (holdsVolumes), radii come after then, and stay as geometry was measured with them until. Sets
/// `dissolved` (one flag per bubble) of those that vanish, whose gas the caller gives back with them, and
/// returns the gas the others took up, < 0 if they gave it [m^3].
double exchangeGas(const DissolvedGasParams& params, double concentration, const Surroundings& around,
                   double dt, Radius radius, BubbleStore& bubbles, std::vector<std::uint8_t>& dissolved);

}  // namespace spume::foam
