#pragma once

#include <Eigen/Core>
#include <vector>

#include "foam/cell_sums.h"

namespace spume::foam {

/// The face of a power diagram between two sites as the global engine finds it: a convex polygon, of which
/// the part inside a disc (radical plane inside the balls) is the film. Extended precision, as corners may
/// lie far outside the disc.
class FilmPolygon {
 public:
  using Real = long double;
  using Point = Eigen::Matrix<Real, 3, 1>;

  /// The disc of balls `near` and `far`, whose centres are `apart` from each other, as a vector from near to
  /// far [m].
  FilmPolygon(const TieBrokenBall& near, const TieBrokenBall& far, const Point& apart);

  /// Adds a corner, relative to the near centre [m]. The edge from it to the next corner lies in the plane of
  /// the third site `edgeSite`, given relative to the near centre; `edgeHeightShift` undoes the jitter of
  /// that site's plane [m].
  void addCorner(const Point& corner, const Point& edgeSite, double edgeHeightShift);

  /// Integrates over polygon and disc; the corners may run either way round. `empty` stays as it is.
  FilmShape integrate() const;

 private:
  using Point2 = Eigen::Matrix<Real, 2, 1>;
  struct Edge {
    Point2 corner;
    Real shiftOfLine;  ///< what undoing the jitter adds to the line's distance from the disc's centre [m]
  };
  struct Sums {
    Real triangles = 0, rim = 0, shifts = 0, solidNear = 0, solidFar = 0;
  };

  void addEdge(const Point2& a, const Point2& b, Real shift, Sums& sums) const;
  void addInside(const Point2& a, const Point2& b, Real shift, Sums& sums) const;
  void addOutside(const Point2& a, const Point2& b, Sums& sums) const;

  TieBrokenBall near_, far_;
  Point u_, v_, normal_;
  Real height_, farHeight_, discRadius2_, heightShift_;
  std::vector<Edge> edges_;
};

}  // namespace spume::foam
