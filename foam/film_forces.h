#pragma once

#include <Eigen/Core>
#include <vector>

#include "foam/block_system.h"
#include "foam/bubble_store.h"
#include "foam/film_outline.h"
#include "foam/foam_topology.h"
#include "foam/forces/film_tension.h"
#include "foam/near_walls.h"
#include "foam/neighbours.h"

namespace spume::foam {

/// What the surface tension of films and free surfaces does to every bubble while all cells hold their gas:
/// f = -dE/dx of the energy E = sum T_ij A_ij + sum T_i S_i at constant volumes. Moved bubbles keep their
/// volumes by changing their weights w = r^2, so with the pressures p that solve (dV/dw)^T p = dE/dw,
/// f = -(dE/dx)_w + sum_k p_k dV_k/dx. Forces of a foam without solids add up to nothing, to round-off.
/// At a solid films slide; left out is what the rim of a free surface does there, and what is square to the
/// solid is not meant to be followed. Holds scratch memory.
class FilmForces {
 public:
  /// `tension` [N/m] of each bubble's films: a film has the smaller of its two bubbles', a free surface
  /// freeTension() of its own. `fixed`: bubbles whose radius does not follow their volume; their pressure is
  /// 0. `topology` measured at the places and radii of `bubbles`, `neighbours` of it, `walls` that cut a
  /// bubble or empty. The same bits for any number of threads.
  void compute(const BubbleStore& bubbles, const FoamTopology& topology, const Neighbours& neighbours,
               const std::vector<NearWalls>& walls, const std::vector<double>& tension,
               const std::vector<double>& wetness, const std::vector<char>& fixed);

  const Vectors3& force() const { return force_; }                   ///< [N]
  const std::vector<double>& pressure() const { return pressure_; }  ///< over that of the air [Pa]

 private:
  /// What is left of a film's outline once its pulls are known.
  struct Face {
    Eigen::Vector3d normal, moment;
  };

  void trace(const BubbleStore& bubbles, const FoamTopology& topology, const Neighbours& neighbours,
             const std::vector<NearWalls>& walls, const std::vector<double>& tension);
  void addFilm(const Film& film, const FilmOutline& outline, const BubbleStore& bubbles,
               const std::vector<double>& tension, std::vector<TensionPull>& pulls) const;
  void addPulls(const BubbleStore& bubbles, const FoamTopology& topology);
  Eigen::Vector3d pressureOn(std::int32_t i, const BubbleStore& bubbles, const FoamTopology& topology,
                             const Neighbours& neighbours) const;

  std::vector<Face> face_;                       ///< by film
  std::vector<std::vector<TensionPull>> pulls_;  ///< by block of films
  std::vector<double> free_;                     ///< tension of each bubble's free surface [N/m]
  std::vector<double> byWeight_, pressure_;      ///< dE/dw [N/m], p [Pa]
  Vectors3 force_;
};

}  // namespace spume::foam
