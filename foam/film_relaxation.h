#pragma once

#include <vector>

#include "foam/film_network.h"

namespace spume::foam {

/// When films count as relaxed; looked at every 20 steps of the descent.
struct FilmRelaxationSettings {
  double areaTolerance = 3e-5;    ///< change of the films' area since the last look, over it
  double volumeTolerance = 5e-3;  ///< largest change of a cell's volume, over it
  int mostSteps = 200;            ///< of the descent; then the films stay as they are
};

struct FilmRelaxationReport {
  int steps = 0;
  double areaBefore = 0, areaAfter = 0;  ///< of all films, each counted once [m^2]
  double worstVolume = 0;                ///< largest change of a cell's volume, over it [-]
  double pull = 0;               ///< mean of what is unbalanced at a node, over tension times a mean edge [-]
  std::vector<double> pressure;  ///< of each bubble over the films' tension [1/m], up to a constant
};

/// Gives films the shape of soap films: the least area at which every cell keeps its volume [Plateau]. Films
/// bulge as the pressures of their cells demand, and meet at 120 degrees but for the size of the triangles.
/// The rims of free surfaces stay where they are and films at walls slide along them. Neighbours stay
/// neighbours: a border that would vanish shrinks to a point. All films have the same tension. `volume` of
/// the cells [m^3]. The same bits for any number of threads.
FilmRelaxationReport relaxFilms(const std::vector<double>& volume, const FilmRelaxationSettings& settings,
                                FilmNetwork& network);

}  // namespace spume::foam
