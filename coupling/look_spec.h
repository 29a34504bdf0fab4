#pragma once

#include <Eigen/Core>

namespace spume::coupling {

enum class Backdrop { light, dark };
enum class BoxLook { glass, none };
enum class FilmLook { plane, curved };
enum class SolidLook { automatic, glass, matte };

/// How pictures of a scene look. Nothing here changes the motion.
struct LookSpec {
  /// What is left of white light after `colourDepth` of the liquid, linear RGB, 0.001 to 1 [-]: faintly blue
  /// water. Coke: (0.30, 0.07, 0.012) after 0.02 m.
  Eigen::Vector3d liquidColour{0.62, 0.86, 0.92};
  double colourDepth = 0.1;  ///< [m], 1e-4 to 100
  Backdrop backdrop = Backdrop::light;
  BoxLook box = BoxLook::glass;             ///< the closed walls of the domain: panes, or not drawn
  double glassThickness = 0;                ///< of the panes [m], 0 to 1; 0: a fortieth of the longest edge
  SolidLook solids = SolidLook::automatic;  ///< automatic: hollow ones are glass, the others matte
  /// Thinnest and thickest film [m], 1e-9 to 1e-5: soap films show colours between 0.1 and 0.8 um.
  double filmThin = 100e-9, filmThick = 800e-9;
  /// Of pictures by `render`: the planes that cut the cells, or soap films (foam/soap_films.h).
  FilmLook films = FilmLook::plane;
  double filmDrainage = 2;     ///< time a film takes to thin to 1/e of its excess thickness [s], 1e-3 to 1e6
  double plateauBorder = 0.1;  ///< width of the rounding where films meet, over the bubble's radius, 0 to 0.5
};

}  // namespace spume::coupling
