#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "foam/radical_plane.h"

namespace spume::foam {

/// A film as its two cells need it: a radical plane's disc, cut by all other planes. What undoes the jitter
/// is 1e-9 of what it is added to: single precision is plenty.
struct FilmShape {
  double area = 0;        ///< with the tie-breaking jitter [m^2]
  double arc = 0;         ///< angle of the disc's rim that is left, seen from the disc's centre, 0..2 pi
  double solidNear = 0;   ///< solid angle from the centre of the bubble the height is measured from, 0..2 pi
  double solidFar = 0;    ///< the same from the other bubble's centre
  float areaShift = 0;    ///< what undoing the jitter adds to the area, to first order [m^2]
  float heightShift = 0;  ///< and to the height of the plane [m]

  double trueArea() const { return std::max(0.0, area + areaShift); }
};

/// Adds up one restricted power cell from the planes around it:
/// S = r^2 (4 pi [all h >= 0] - sum sgn(h) W), V = (sum h A + r S)/3 (model, "Foam geometry"), sgn(0) = +1.
/// The jitter is undone to first order: dV by dV/dw, and dS by the rims, each of which moves with its plane.
class CellSums {
 public:
  explicit CellSums(const TieBrokenBall& ball) : ball_(ball) {}

  /// A plane that limits the cell, with or without a film, at signed height h from the centre [m].
  void addPlane(double height) { limit(height >= 0); }
  /// Several planes at once: whether none of them cuts the centre away.
  void limit(bool centreInside) { centreInside_ = centreInside_ && centreInside; }

  /// The film in that plane; `solid` is its solid angle from this centre, `heightShift` undoes the jitter of
  /// h.
  void addFilm(const FilmShape& film, double height, double heightShift, double solid) {
    addFace(film, height, heightShift, solid);
    films_ += film.trueArea();
  }
  /// As a film, but it is none: a wall.
  void addFace(const FilmShape& film, double height, double heightShift, double solid) {
    anyFace_ = true;
    solid_ += height < 0 ? solid : -solid;
    pyramids_ += height * film.area;
    volumeShift_ += film.area * heightShift;
    rimHeight_ += film.arc * height;
    rimShift_ += film.arc * heightShift;
  }

  bool hidden() const { return !anyFace_ && freeSolid() == 0; }
  double filmArea() const { return films_; }
  double freeArea() const {
    const double r = ball_.radius, dr = ball_.radiusShift, free = r * r * freeSolid();
    return free > 0 ? std::max(0.0, free + (2 * free / r - rimHeight_) * dr + r * rimShift_) : 0;
  }
  double volume() const {
    const double r = ball_.radius, free = r * r * freeSolid();
    const double jittered = (pyramids_ + r * free) / 3;
    return hidden() ? 0 : std::max(0.0, jittered + volumeShift_ + free * ball_.radiusShift);
  }

 private:
  /// Solid angles below this are zero: rounding of a sum of up to 1000 films.
  static constexpr double kRoundOffAngle = 1e-12;

  double freeSolid() const {
    const double solid = solid_ + (centreInside_ ? 4 * std::numbers::pi : 0);
    return solid < kRoundOffAngle ? 0 : solid;
  }

  TieBrokenBall ball_;
  bool centreInside_ = true, anyFace_ = false;
  double solid_ = 0, pyramids_ = 0, volumeShift_ = 0, rimHeight_ = 0, rimShift_ = 0, films_ = 0;
};

}  // namespace spume::foam
