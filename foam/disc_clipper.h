#pragma once

#include <cstddef>
#include <vector>

#include "foam/cell_sums.h"
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

/// The ball whose disc is clipped, and where the ball on the other side stands.
struct DiscBalls {
  double radius, radiusShift;   ///< of the owner; what undoing the jitter adds to it [m]
  double farRadius, farHeight;  ///< of the other bubble; signed distance of the plane from its centre [m]
};

/// Clips discs by planes and integrates what is left over its edges (performance, "Foam geometry"). Holds
/// scratch memory; one per thread.
class DiscClipper {
 public:
  /// What the other planes leave of plane `face`'s disc. O(m^2) in the number m of planes that cut it.
  FilmShape clip(const CuttingPlanes& planes, std::size_t face, const DiscBalls& balls);

  /// Whether the other planes leave anything of the disc of plane `face` in a ball of that radius [m]: clip()
  /// without its integrals.
  bool leavesAny(const CuttingPlanes& planes, std::size_t face, double radius);

 private:
  /// Lines in which the other planes meet the disc's plane, and the piece of each that bounds the film; once
  /// clipped, only those that have one.
  struct Lines {
    std::size_t count = 0;
    std::vector<double> ux, uy;  ///< unit normals in the plane
    std::vector<double> offset;  ///< D, signed distance from the disc's centre [m]
    std::vector<double> slope2;  ///< squared sine of the angle between the planes [-]
    std::vector<double> shift;   ///< what undoing the jitter adds to D [m]
    std::vector<double> half;    ///< where the line meets the rim, at -half and half along it [m]
    std::vector<double> t1, t2;  ///< ends of the edge along the line [m]; t2 > t1 if anything is left

    void reserve(std::size_t lines);
  };

  bool findLines(const CuttingPlanes& planes, std::size_t face, double discRadius2);
  void scaleLines(double discRadius2);
  bool clipLines(double discRadius2);
  void keepEdges();
  double spannedAngle() const;
  void integrate(double height, double heightShift, double discRadius2, const DiscBalls& balls,
                 FilmShape& out) const;

  Lines lines_;
  bool centreInside_ = true;  ///< no line cuts the disc's centre away
  bool closed_ = false;       ///< nothing is left of the rim
};

}  // namespace spume::foam
