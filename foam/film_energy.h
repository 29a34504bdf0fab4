#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/film_network.h"

namespace spume::foam {

/// What a network of films descends: E = A + sum_c (kappa_c dV_c^2 / 2 - p_c dV_c), A the area of all films,
/// dV_c the volume a cell has gained since the start, p_c its pressure over the films' tension [1/m]. Held
/// nodes feel only what they may follow. The same bits for any number of threads.
class FilmEnergy {
 public:
  using Columns = std::vector<Eigen::Vector3d>;

  /// Starts where the network's nodes are, with all pressures 0. `network` must outlive this; its nodes'
  /// positions are read here alone.
  FilmEnergy(const FilmNetwork& network, std::size_t bubbles);

  const Columns& start() const { return start_; }
  /// E [m^2] and its gradient [m] with the nodes at `x` [m].
  double at(const Columns& x, Columns& gradient);
  /// p_c -= kappa_c dV_c at the last x: what the volumes' stiffness has borne the pressures bear (augmented
  /// Lagrangian).
  void correctPressures();

  double area() const;                                               ///< at the last x [m^2]
  const std::vector<double>& gained() const { return gained_; }      ///< dV_c at the last x [m^3]
  const std::vector<double>& pressure() const { return pressure_; }  ///< [1/m], up to a constant

 private:
  void listSlots();
  void listFilms(std::size_t bubbles);
  void setStiffness();
  void measure(const Columns& x);
  void measureFilm(std::size_t f, const Columns& x);
  void gather(Columns& gradient) const;
  double pressureOf(std::int32_t c) const { return pressure_[c] - stiffness_[c] * gained_[c]; }

  const FilmNetwork& network_;
  Columns start_;
  std::vector<std::int32_t> slotStart_, slotOfNode_;  ///< slots of each node
  std::vector<std::int32_t> filmOfSlot_;
  std::vector<std::int32_t> filmStart_, filmOfCell_;  ///< films of each bubble
  Columns areaPull_, volumePull_;                     ///< gradients of area and swept volume, by slot
  std::vector<double> area_, swept_;                  ///< by film [m^2], [m^3]
  std::vector<double> flat_;                          ///< by film: rounds areas off near nothing [m^4]
  std::vector<double> gained_, pressure_, stiffness_;
};

}  // namespace spume::foam
