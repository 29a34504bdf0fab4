#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/drop.h"
#include "fluid/lost_markers.h"
#include "fluid/marker_particles.h"
#include "fluid/marker_shares.h"

namespace spume::fluid {

/// What became of the drops in one advance.
struct DropFlight {
  double left = 0;  ///< flown out of an open side of the domain [m^3]
  std::vector<Drop> landed;
};

/// Escaped negative markers as ballistic drops (model, "Liquid"): each leaves with the liquid volume it stood
/// for when the grid last held it, flies under gravity, slides off solids and returns volume and momentum
/// where it lands. The drops themselves belong to the caller's state.
class Drops {
 public:
  explicit Drops(const GridSpec& grid) : shares_(grid), sorter_(grid) {}

  /// Sets the volume each negative marker stands for (column `gas`) where the grid knows it: see
  /// MarkerShares::refreshLiquid. Returns the sum of what it set [m^3].
  double refreshVolumes(const MarkerScene& scene, const DenseField<float>& phi, const MarkerSet& positive,
                        MarkerSet& negative);

  /// Takes the negative markers that are out of the liquid by more than their radius and kLaunchHeight cells
  /// out of the set. Returns them as drops without id, in the order of the set.
  std::vector<Drop> launch(const MarkerScene& scene, const DenseField<float>& phi,
                           const MacVelocity& velocity, MarkerSet& negative);

 private:
  MarkerShares shares_;
  LostMarkers lost_;
  MarkerSorter sorter_;
};

/// Flies every drop for dt [s]: exact parabolas between collisions, which are looked for every half cell of
/// the way. Drops that come into liquid (phi < 0) or leave the domain are removed and reported.
DropFlight fly(const MarkerScene& scene, const DenseField<float>& phi, double dt, std::vector<Drop>& drops);

double volumeOf(const std::vector<Drop>& drops);  ///< [m^3]
/// [kg m/s]
Eigen::Vector3d momentumOf(const std::vector<Drop>& drops, double density);

/// Gives the momentum of landed drops, less what their volume had at the liquid's own velocity, to the faces
/// of the cells they landed in: a face that carries the mass of one cell takes m (v - u)/(mass of that cell),
/// m at most that mass.
void depositMomentum(const GridSpec& grid, const std::vector<Drop>& landed, MacVelocity& velocity);

}  // namespace spume::fluid
