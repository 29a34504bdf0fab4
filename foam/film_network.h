#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/film_outline.h"
#include "foam/foam_topology.h"
#include "foam/near_walls.h"
#include "foam/neighbours.h"

namespace spume::foam {

/// Where a node of a network may go.
enum class NodeHold : std::uint8_t {
  none,   ///< anywhere
  plane,  ///< along a wall: square to `axis`
  line,   ///< along the edge of two walls: along `axis`
  fixed   ///< on the rim of a free surface, or where the outlines of films do not fit together
};

struct FilmNode {
  Eigen::Vector3d position;  ///< [m]
  NodeHold hold = NodeHold::none;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< unit, of `plane` and `line`
};

/// A border: the line in which the films of three bubbles meet.
struct FilmBorder {
  std::array<std::int32_t, 3> bubbles;  ///< ascending
  std::vector<std::int32_t> nodes;      ///< from its end in the direction against (x1 - x0) x (x2 - x0)
  int films = 0;                        ///< that have it in their rim: 3 where all fits
};

/// A point in which four borders meet.
struct FilmPoint {
  std::array<std::int32_t, 4> bubbles;  ///< ascending
  std::int32_t node;
};

/// One film as a disc of triangles. Its nodes stand in `FilmNetwork::slots` from `firstSlot` on: the rim
/// first, counterclockwise seen from bubble j, then those inside; corners of triangles count from there. The
/// first `rim` triangles lie along the rim, triangle s between rim nodes s and s + 1.
struct NetworkFilm {
  std::int32_t i, j;  ///< its bubbles, i < j; the triangles' normals point to j
  std::int32_t rim;   ///< nodes of the rim
  std::int32_t firstSlot, endSlot, firstTriangle, endTriangle;
};

/// The films of a foam as one mesh: films share the nodes of their borders, borders those of their points.
/// At first the plane films of the power cells; `relaxFilms` gives them the shape of soap films.
struct FilmNetwork {
  std::vector<FilmNode> nodes;
  std::vector<NetworkFilm> films;
  std::vector<std::int32_t> slots;                     ///< the node of each slot
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< slots of their film, from its first
  std::vector<FilmBorder> borders;
  std::vector<FilmPoint> points;
  /// Border and stretch of it (from nodes[stretch] to the next) of each rim slot's edge, -1: no border.
  std::vector<std::array<std::int32_t, 2>> borderOfSlot;
  std::size_t torn = 0;  ///< borders that their three films do not agree about, by round-off; held fixed

  double areaOf(const NetworkFilm& film) const;  ///< [m^2]
  const Eigen::Vector3d& at(const NetworkFilm& film, std::int32_t corner) const {
    return nodes[slots[film.firstSlot + corner]].position;
  }
};

/// Meshes the films of `topology`, measured at the places and radii of `bubbles`; `neighbours` of it; `walls`
/// that cut them, or empty. Every straight edge and every 30 degrees of an arc become `segments` >= 1
/// stretches, every film segments^2 triangles for each of these. The same network for any number of threads.
FilmNetwork meshFilms(const BubbleStore& bubbles, const FoamTopology& topology, const Neighbours& neighbours,
                      const std::vector<NearWalls>& walls, int segments);

}  // namespace spume::foam
