#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "foam/bubble_store.h"
#include "foam/foam_topology.h"
#include "foam/near_walls.h"
#include "foam/neighbours.h"

namespace spume::foam {

/// A straight piece of a film's rim: a border, where a third bubble's films begin, or a solid. It moves with
/// the plane that cuts it out: a step s leads from the film's first centre to the third, or is the unit
/// normal into the solid.
struct FilmEdge {
  std::int32_t third;        ///< the bubble beyond, -1 for a solid
  double length;             ///< [m], > 0
  Eigen::Vector3d middle;    ///< [m]
  Eigen::Vector3d from, to;  ///< its ends [m]; the film lies to the left, seen from the second bubble
  double lean;               ///< part of s along the line of centres, over that line's length
  double reach;              ///< part of s in the film's plane, which is square to the edge; > 0
};

/// A film's shape in its plane. What is not cut off of the disc's rim is its arcs, where it meets the air.
struct FilmOutline {
  std::vector<FilmEdge> edges;
  Eigen::Vector3d centre;   ///< of the disc in which the two balls meet [m]
  Eigen::Vector3d normal;   ///< unit, from the film's first bubble to its second
  double discRadius = 0;    ///< [m]
  double arc = 0;           ///< angle of the arcs, seen from that centre, 0..2 pi
  Eigen::Vector3d arcPull;  ///< integral of the outward unit normals along the arcs [m]
  Eigen::Vector3d moment;   ///< integral over the film of y - centre [m^3]
};

/// Traces the outlines of a foam's films. Holds scratch memory; one per thread.
class FilmOutlines {
 public:
  /// `topology` measured at the places and radii of `bubbles`, `neighbours` of it; `walls` may be empty. All
  /// must outlive this.
  FilmOutlines(const BubbleStore& bubbles, const FoamTopology& topology, const Neighbours& neighbours,
               const std::vector<NearWalls>& walls)
      : bubbles_(bubbles), topology_(topology), neighbours_(neighbours), walls_(walls) {}

  /// O(k^2 + m) in the number k of third bubbles and m of the neighbours of both.
  void trace(const Film& film, FilmOutline& outline);

 private:
  /// A plane that may cut the film, in the film's plane: the film lies where u . q <= offset, q measured from
  /// the disc's centre.
  struct Line {
    std::int32_t third;
    Eigen::Vector2d u;  ///< unit
    double offset;      ///< [m]
    double lean, reach;
  };

  void addLine(const Film& film, const FilmOutline& outline, std::int32_t third, const Eigen::Vector3d& step,
               double height);
  void addThirds(const Film& film, const FilmOutline& outline);
  void addWalls(const Film& film, const FilmOutline& outline);
  void clip(FilmOutline& outline) const;

  const BubbleStore& bubbles_;
  const FoamTopology& topology_;
  const Neighbours& neighbours_;
  const std::vector<NearWalls>& walls_;
  Eigen::Vector3d across_, upward_;  ///< axes of the film's plane
  std::vector<Line> lines_;
};

}  // namespace spume::foam
