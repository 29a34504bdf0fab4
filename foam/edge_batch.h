#pragma once

#include <cstddef>
#include <vector>

#include "foam/cell_sums.h"
#include "foam/disc_lines.h"

namespace spume::foam {

/// The ball whose disc is measured, and where the ball on the other side stands.
struct DiscBalls {
  double radius, radiusShift;  ///< of the owner; what undoing the jitter adds to it [m]
  double height,
      heightShift;  ///< signed distance of the plane from the owner's centre, and the same for it [m]
  double farRadius, farHeight;  ///< of the other bubble; signed distance of the plane from its centre [m]
};

/// Integrates what is left of clipped discs over their edges: those of many discs together, so that the lanes
/// are full, then the sums of each (performance, "Foam geometry"). Holds scratch memory; one per thread.
class EdgeBatch {
 public:
  /// Clips a disc, its lines scaled, and takes it into the batch unless nothing is left of it: false then.
  /// `film` is written at flush() at the latest.
  bool add(const DiscLines& lines, std::size_t disc, const DiscBalls& balls, FilmShape& film);
  /// Fills the films of all discs since the last time.
  void flush();

 private:
  struct Disc {
    DiscBalls balls;
    double discRadius2;  ///< [m^2]
    std::size_t end;     ///< of its edges
    bool centreInside, closed;
    FilmShape* film;
  };
  /// Over the edges of one disc.
  struct Sums {
    double triangles = 0, shifts = 0, near = 0, far = 0, spanned = 0;
  };

  void noteHeights(std::size_t begin, const DiscBalls& balls);
  void integrateEdges();
  Sums sumOf(std::size_t begin, std::size_t end) const;

  std::vector<Disc> discs_;
  FilmEdges edges_;
  std::vector<double> nearHeight_, farHeight_;  ///< of each edge's plane from either centre, without sign [m]
  std::vector<double> triangle_;                ///< D length [m^2]
  std::vector<double> areaShift_;               ///< shift length [m^2]
  std::vector<double> spanned_;                 ///< angle at the disc's centre, with the sign of D
  /// How far the solid angle of the triangle from the disc's centre to the edge, seen from either ball's,
  /// falls short of the angle the edge spans there; with the sign of D.
  std::vector<double> nearSolid_, farSolid_;
};

}  // namespace spume::foam
