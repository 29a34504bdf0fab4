#pragma once

#include <cstdint>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/drop.h"
#include "fluid/grid_spec.h"
#include "fluid/marker_set.h"
#include "fluid/volume_ledger.h"

namespace spume::fluid {

/// All that a step of the liquid reads and writes: plain data, float grids, so that a copy of it is an exact
/// checkpoint. `vdb_grids.h` turns it into OpenVDB grids and back.
struct LiquidState {
  GridSpec grid;
  double time = 0;            ///< [s]
  std::int64_t subSteps = 0;  ///< sub-steps taken since the start; keys the random numbers of reseeding
  DenseField<float> phi;      ///< signed distance to the surface at cell centres [m], < 0 in liquid
  MacVelocity velocity;       ///< [m/s], extrapolated into air and solids
  double lead = 0;            ///< [s]; the velocity is that of time + lead, the middle of the coming sub-step
  MacField<float> pressureGradient;  ///< of the last projection on faces [Pa/m]; 0 away from the liquid
  MarkerSet positive, negative;
  VolumeLedger volume;          ///< what each connected body and each closed pocket should hold
  std::vector<Drop> drops;      ///< in flight, in the order of their launch
  std::uint64_t dropsEver = 0;  ///< launched since the start; the next drop's id
};

/// to = from, in parallel and without giving back memory: done every step, so that a step that fails can be
/// undone.
void copyState(const LiquidState& from, LiquidState& to);

}  // namespace spume::fluid
