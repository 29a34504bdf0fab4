#pragma once

#include <cstddef>
#include <vector>

#include "foam/lane_math.h"

namespace spume::foam {

/// The radical planes of one bubble with its overlapping neighbours, as columns. A point x_i + p is on the
/// bubble's side of plane k if n_k . p <= height_k.
struct CuttingPlanes {
  std::size_t count = 0;
  std::vector<double> nx, ny, nz;   ///< unit normals, towards the neighbour
  std::vector<double> height;       ///< signed distance of the plane from the bubble's centre [m]
  std::vector<double> heightShift;  ///< what undoing the tie-breaking jitter adds to the height [m]

  /// Makes room for `planes` planes, to whole lanes.
  void resize(std::size_t planes);
};

/// Straight edges of films, as columns: each a piece of a line in the plane of its disc.
struct FilmEdges {
  std::size_t count = 0;
  std::vector<double> offset;  ///< D, signed distance of the line from the disc's centre [m]
  std::vector<double> shift;   ///< what undoing the jitter adds to D [m]
  std::vector<double> t1, t2;  ///< ends along the line, from the point nearest to that centre [m], t2 > t1

  /// Makes room for `edges` edges and a block of lanes after them: closing gaps writes whole blocks.
  void reserve(std::size_t edges);
};

/// Cuts the disc of one plane by all other planes of the bubble (performance, "Foam geometry"), in stages to
/// be run for several discs in turn: each reads by whole lanes what the one before has just written bit by
/// bit, for which a processor would otherwise wait. O(m^2) in the number m of planes that cut the disc.
class DiscLines {
 public:
  /// What is left of a disc beside its edges.
  struct Rest {
    bool any = true;           ///< there is a film
    bool centreInside = true;  ///< no line cuts the disc's centre away
    bool closed = false;       ///< there are lines, and nothing is left of the rim
  };

  /// Collects the lines in which the other planes cut the disc of plane `face` in a ball of `radius` [m];
  /// false if there is no disc or one plane takes all of it.
  bool find(const CuttingPlanes& planes, std::size_t face, double radius);
  /// Then: where the lines meet the rim.
  void scale();
  /// Then: cuts the lines by each other, and adds to `edges` what is left of them.
  Rest clip(FilmEdges& edges) const;

  double discRadius2() const { return discRadius2_; }  ///< [m^2]

 private:
  void reserve(std::size_t lines);

  double discRadius2_ = 0;
  std::size_t count_ = 0;
  std::vector<double> ux_, uy_;  ///< unit normals in the plane, once scaled
  std::vector<double> offset_;   ///< D, signed distance from the disc's centre [m]
  std::vector<double> shift_;    ///< what undoing the jitter adds to D [m]
  std::vector<double> slope2_;   ///< squared sine of the angle between the planes [-]
  std::vector<double> half_;     ///< where the line meets the rim, at -half and half along it [m]
};

}  // namespace spume::foam
