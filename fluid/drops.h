#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/marker_particles.h"
#include "fluid/marker_shares.h"

namespace spume::fluid {

/// Liquid too fine for the grid, in free flight.
struct Drop {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d velocity;  ///< [m/s]
  double volume;             ///< [m^3]
};

/// What became of the drops in one advance [m^3].
struct DropReport {
  double launched = 0;  ///< taken from the negative markers
  double left = 0;      ///< flown out of an open side of the domain
  std::vector<Drop> landed;
};

/// Escaped negative markers as ballistic drops (model, "Liquid"): each leaves with the liquid volume it stood
/// for when the grid last held it, flies under gravity, slides off solids and returns volume and momentum
/// where it lands.
class Drops {
 public:
  explicit Drops(const GridSpec& grid) : shares_(grid), sorter_(grid) {}

  /// Refreshes the volume each negative marker stands for (column `gas`), then turns those that are out of
  /// the liquid by more than their radius and kLaunchHeight cells into drops. Returns the volume launched
  /// [m^3].
  double launch(const MarkerScene& scene, const DenseField<float>& phi, const MacVelocity& velocity,
                MarkerSet& negative);

  /// Flies every drop for dt [s]; exact parabolas between collisions. Drops that end in liquid (phi < 0) or
  /// outside the domain are removed and reported.
  void advance(const MarkerScene& scene, const DenseField<float>& phi, double dt, DropReport& report);

  const std::vector<Drop>& all() const { return drops_; }
  /// Continues from a checkpoint.
  void restore(std::vector<Drop> drops) { drops_ = std::move(drops); }
  double volume() const;                           ///< [m^3]
  Eigen::Vector3d momentum(double density) const;  ///< [kg m/s]

 private:
  std::vector<Drop> drops_;
  MarkerShares shares_;
  MarkerSorter sorter_;
};

/// Gives the momentum of landed drops, less what their volume had at the liquid's own velocity, to the faces
/// of the cells they landed in: a face that carries the mass of one cell takes m (v - u)/(mass of that cell),
/// m at most that mass.
void depositMomentum(const GridSpec& grid, const std::vector<Drop>& landed, MacVelocity& velocity);

}  // namespace spume::fluid
