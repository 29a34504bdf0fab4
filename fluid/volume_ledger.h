#pragma once

#include <numeric>
#include <vector>

namespace spume::fluid {

/// What volume control must remember between sub-steps: with the phi of the same moment an exact checkpoint.
struct VolumeLedger {
  std::vector<double>
      target;  ///< liquid each body should hold, in the order of LiquidBodies, without bubble gas [m^3]
  std::vector<double> loss;  ///< what each body loses to the level set's errors, as far as learnt [m^3/s]
  double unassigned = 0;     ///< target of bodies that vanished while no other was left [m^3]
  std::vector<double> pocketGas;  ///< gas each closed pocket should hold, in the order of AirPockets [m^3]

  /// Initial + poured - drained - drops in flight [m^3].
  double total() const { return std::accumulate(target.begin(), target.end(), unassigned); }
};

}  // namespace spume::fluid
