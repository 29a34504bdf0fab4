#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
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

/// Cuts the discs of some planes of a bubble by all its other planes, in stages that are each run for all
/// discs: a stage reads by whole lanes what the one before has just written bit by bit, for which a processor
/// would otherwise wait. O(m) in the number m of planes for each disc, and O(l^2) in that l of those that cut
/// it.
class DiscLines {
 public:
  /// What is left of a disc beside its edges.
  struct Rest {
    bool any = true;           ///< there is a film
    bool centreInside = true;  ///< no line cuts the disc's centre away
    bool closed = false;       ///< there are lines, and nothing is left of the rim
  };

  /// Collects the lines in which the other planes cut the discs of the planes `faces`, in a ball of `radius`
  /// [m].
  void find(const CuttingPlanes& planes, std::span<const std::int32_t> faces, double radius);
  /// Whether there is a disc of that face, and no single plane takes all of it. Only such a one may be asked
  /// for the rest.
  bool isLeft(std::size_t disc) const { return gone_[disc] == 0; }
  /// Then: where the lines meet the rims.
  void scale();
  /// Then: cuts the lines of a disc by each other, and adds to `edges` what is left of them.
  Rest clip(std::size_t disc, FilmEdges& edges) const;

  double discRadius2(std::size_t disc) const { return frame_.radius2[disc]; }  ///< [m^2]

 private:
  /// The discs as columns: normal and height of the plane, two unit vectors in it, and the square of the
  /// radius.
  struct Frames {
    std::vector<double> nx, ny, nz, height, shift, ux, uy, uz, vx, vy, vz, radius2;
  };

  void reserve(std::size_t discs, std::size_t planes);
  void frameDiscs(const CuttingPlanes& planes, double radius);
  void findInBlock(const CuttingPlanes& planes, std::size_t k);

  std::size_t discs_ = 0, stride_ = 0;  ///< how many; places for the lines of each
  std::vector<std::size_t> face_;       ///< the plane of each disc
  std::vector<std::uint32_t> gone_;     ///< not 0 if nothing is left of it
  std::vector<std::size_t> count_;      ///< of its lines
  Frames frame_;
  std::vector<double> ux_, uy_;  ///< normals in the plane; unit vectors once scaled
  std::vector<double> offset_;   ///< D, signed distance from the disc's centre [m], once scaled
  std::vector<double> shift_;    ///< what undoing the jitter adds to D [m], once scaled
  std::vector<double> half_;     ///< where the line meets the rim, at -half and half along it [m]
};

}  // namespace spume::foam
