#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/film_outline.h"
#include "foam/foam_topology.h"

namespace spume::foam {

/// What a piece of surface does to a bubble whose ball carries it.
struct TensionPull {
  std::int32_t bubble;
  Eigen::Vector3d force;  ///< -dE/dx, E the surface energy [N]
  double byWeight;        ///< dE/dw, w the squared radius [N/m]
};

/// Tension of a bubble's free surface [N/m] where its films have `filmTension` [N/m]: T / sqrt(1 + 3 lambda).
/// Two equal balls then balance at their rest length (Eq. 1) whatever their wetness: at lambda 0 a free
/// surface is a film, at 1 it is half of one and they touch in a point.
double freeTension(double filmTension, double wetness);

/// Adds to `pulls` what the film's tension T [N/m] does through its straight edges, to its own two bubbles
/// and to the third one of each. An edge is drawn into the film by T L; its points lie on the radical planes,
/// (x_j - x_i) . v = (y - x_i) . dx_i - (y - x_j) . dx_j + (dw_i - dw_j)/2 and the same with the third, so by
/// virtual work, for the force decomposed as a (x_j - x_i) + b (x_k - x_i), f_i = (a + b)(y - x_i),
/// f_j = -a (y - x_j), f_k = -b (y - x_k). Where three films of one tension meet at 120 degrees nothing is
/// left. On a solid of normal n an edge slides, n . v = 0: the part b n of its force the solid bears.
void addEdgeTension(const Film& film, const FilmOutline& outline, double tension,
                    const std::vector<Eigen::Vector3d>& position, std::vector<TensionPull>& pulls);

/// Adds what film and free surfaces do along the film's arcs, with the tensions of the film and of the free
/// surfaces of its first and second bubble [N/m]. Together with the edges a film pulls no momentum out of
/// nothing; `radius` [m].
void addArcTension(const Film& film, const FilmOutline& outline, double tension, double freeI, double freeJ,
                   const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                   std::vector<TensionPull>& pulls);

}  // namespace spume::foam
