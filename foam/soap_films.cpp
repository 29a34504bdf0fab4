#include "foam/soap_films.h"

#include "foam/near_walls.h"
#include "foam/neighbours.h"
#include "foam/surroundings.h"
#include "foam/wall_cells.h"

namespace spume::foam {
namespace {

SoapFilms filmsBetween(const BubbleStore& bubbles, const std::vector<NearWalls>& walls, int segments,
                       const FilmRelaxationSettings& settings) {
  FoamTopology topology;
  WallCells cells;
  cells.compute(bubbles, walls, topology);
  Neighbours neighbours;
  cells.listNeighbours(topology, neighbours);
  SoapFilms films{meshFilms(bubbles, topology, neighbours, walls, segments), {}};
  films.report = relaxFilms(topology.volume, settings, films.network);
  return films;
}

}  // namespace

SoapFilms soapFilms(const BubbleStore& bubbles, const LiquidSampler& liquid, int segments,
                    const FilmRelaxationSettings& settings) {
  Surroundings around;
  around.sample(liquid, bubbles.positions());
  std::vector<NearWalls> walls;
  if (isAnyCutByWall(bubbles.radius, around.psi))
    findNearWalls(liquid, around, bubbles, bubbles.radius, walls);
  return filmsBetween(bubbles, walls, segments, settings);
}

SoapFilms soapFilms(const BubbleStore& bubbles, int segments, const FilmRelaxationSettings& settings) {
  return filmsBetween(bubbles, {}, segments, settings);
}

}  // namespace spume::foam
