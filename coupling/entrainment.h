#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "coupling/gas_ledger.h"
#include "coupling/scene.h"
#include "fluid/liquid_solver.h"
#include "foam/bubble_store.h"

namespace spume::coupling {

/// Gas waiting in one block of space for the next bubble it can pay.
struct Reservoir {
  double gas = 0;           ///< [m^3]
  std::uint64_t draws = 0;  ///< radii drawn so far; keys the next one
};

using BlockIndex = std::array<int, 3>;
using Reservoirs = std::map<BlockIndex, Reservoir>;  ///< ordered, so that a run does not depend on hashing

struct Birth {
  foam::NewBubble bubble;
  BirthCause cause;
};

/// Turns air caught by the level set into bubbles (model, Section 4, rules 2 to 5). The rate of gas comes
/// from the markers that left the set where streams meet fast enough, the sizes from the scene's
/// distribution: neither depends on dx, dt or the number of markers (README, "Measured").
class Entrainment {
 public:
  /// `dx` is the liquid's cell edge [m].
  Entrainment(const EntrainmentSpec& spec, double dx, std::uint64_t seed);

  /// Books the gas of `escaped` and `pockets` into `reservoirs` and `ledger` and returns the
  /// bubbles the reservoirs can pay, in the order of the leavers that tipped them.
  std::vector<Birth> step(const std::vector<fluid::EscapedMarker>& escaped,
                          const std::vector<fluid::CollapsedPocket>& pockets, Reservoirs& reservoirs,
                          GasLedger& ledger) const;

  /// Radius [m] of bubble number `draw` of a block: lognormal, redrawn until inside the cut.
  double drawRadius(const BlockIndex& block, std::uint64_t draw) const;

 private:
  struct Leaver;
  void payBubbles(const Leaver& leaver, const BlockIndex& block, Reservoir& reservoir,
                  std::vector<Birth>& births) const;

  EntrainmentSpec spec_;
  double dx_;
  std::uint64_t seed_;
};

}  // namespace spume::coupling
