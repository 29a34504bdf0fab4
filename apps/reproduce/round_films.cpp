#include "apps/reproduce/round_films.h"

#include <algorithm>
#include <numbers>

#include "foam/film_forces.h"
#include "foam/surroundings.h"
#include "foam/wall_cells.h"

namespace spume::apps {

RoundFilms::RoundFilms(const foam::BubbleStore& bubbles, const foam::LiquidSampler& liquid) {
  foam::Surroundings around;
  around.sample(liquid, bubbles.positions());
  std::vector<foam::NearWalls> walls;
  foam::findNearWalls(liquid, around, bubbles, bubbles.radius, walls);
  foam::FoamTopology topology;
  foam::WallCells().compute(bubbles, walls, topology);
  foam::Neighbours neighbours;
  neighbours.build(bubbles.size(), topology.overlaps);

  const std::vector<double> tension(bubbles.size(), 1.0);  // pressures over it are lengths^-1
  std::vector<double> wetness(bubbles.size());
  std::vector<char> fixed(bubbles.size());
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    wetness[i] = std::max(0.0, bubbles.wetness[i]);
    fixed[i] = bubbles.clamped[i] || topology.hidden[i];
  }
  foam::FilmForces forces;
  forces.compute(bubbles, topology, neighbours, walls, tension, wetness, fixed);

  foam::FilmOutlines outlines(bubbles, topology, neighbours, walls);
  foam::FilmOutline outline;
  for (const foam::Film& film : topology.films) {
    outlines.trace(film, outline);
    double rim = outline.arc * outline.discRadius;
    for (const foam::FilmEdge& edge : outline.edges) rim += edge.length;
    const double jump = forces.pressure()[film.i] - forces.pressure()[film.j];
    if (rim > 0) lean_[{film.i, film.j}] = jump * film.area / rim * 180 / std::numbers::pi;
  }
}

double RoundFilms::lean(std::int32_t bubble, std::int32_t other) const {
  const auto found = lean_.find(std::minmax(bubble, other));
  if (found == lean_.end()) return 0;
  return bubble < other ? found->second : -found->second;
}

PlateauAngles RoundFilms::angles(const PlateauAngles& measured) const {
  PlateauAngles round = measured;
  for (std::size_t border = 0; border < measured.bordersCells.size(); ++border)
    for (int a = 0; a < 3; ++a) {
      const auto& cells = measured.bordersCells[border];
      round.films[3 * border + a] += lean(cells[a], cells[(a + 1) % 3]) + lean(cells[a], cells[(a + 2) % 3]);
    }
  return round;
}

}  // namespace spume::apps
