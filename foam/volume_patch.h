#pragma once

#include <cstdint>
#include <vector>

#include "foam/foam_params.h"
#include "foam/neighbours.h"
#include "foam/part_measurement.h"
#include "foam/topology_part.h"

namespace spume::foam {

/// Brings the few cells that do not hold their gas yet to do so, at the cost of their surroundings alone:
/// they are corrected, with those of their neighbours that this would put off the tolerance, and what that
/// changes is measured anew. Cells that appear, vanish
/// or change their neighbours need several more Newton steps than all others; each step is taken around what
/// the last one has left or disturbed.
class VolumePatch {
 public:
  /// Corrects radii and clamped flags until all cells hold their gas to the tolerance, or no step helps any
  /// more. `topology` and `neighbours` as measured with all bubbles, volumes noted; leaves the topology and
  /// the bubbles as a measurement with the new radii would, the neighbours as they were before the last step.
  /// `walls` may be empty.
  void settle(const FoamParams& params, const std::vector<NearWalls>& walls, FoamTopology& topology,
              Neighbours& neighbours, BubbleStore& bubbles);

 private:
  /// Distance of a bubble from those off, in neighbours.
  enum Ring : char { elsewhere, isOff, beside, watched };

  void choose(const std::vector<std::int32_t>& off, const Neighbours& neighbours, std::size_t bubbles);
  void correct(const FoamParams& params, const FoamTopology& topology, const Neighbours& neighbours,
               BubbleStore& bubbles);
  void gather(const BubbleStore& bubbles);
  void project(const FoamParams& params);
  bool freeDisturbed(const FoamParams& params);

  std::vector<Ring> ring_;             ///< of every bubble
  std::vector<std::int32_t> place_;    ///< in the patch, of every bubble, or -1
  std::vector<std::int32_t> rows_;     ///< of the patch, ascending
  std::vector<char> fixed_;            ///< by place in rows_: does not change itself
  std::vector<double> radius_;         ///< by place in rows_, as measured [m]
  std::vector<double> change_;         ///< of the weights since, by place in rows_ [m^2]
  std::vector<std::int32_t> changed_;  ///< rows that the last step has given another radius
  BubbleStore part_;                   ///< of these rows what a projection reads: ids, gas, radii, clamped
  FoamTopology topology_;
  Neighbours neighbours_;
  PartMeasurement measurement_;
};

}  // namespace spume::foam
