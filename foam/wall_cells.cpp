#include "foam/wall_cells.h"

#include <algorithm>
#include <cmath>

namespace spume::foam {
namespace {

constexpr std::uint64_t kPlanesPerBubble = 4;  // at least as many as NearWalls knows

/// Takes the balls behind planes out of a topology again: those from index `bubbles` on.
void dropPlanes(std::size_t bubbles, FoamTopology& out) {
  const auto count = static_cast<std::int32_t>(bubbles);
  std::vector<std::int32_t> place(out.films.size(), -1);
  std::size_t films = 0, overlaps = 0;
  for (std::size_t f = 0; f < out.films.size(); ++f) {
    const Film& film = out.films[f];
    if (film.j < count) {
      place[f] = static_cast<std::int32_t>(films);
      out.films[films++] = film;
    } else if (film.i < count) {
      out.filmArea[film.i] -= film.area;
    }
  }
  for (const OverlapPair& pair : out.overlaps) {
    if (pair.j >= count) continue;
    OverlapPair& kept = out.overlaps[overlaps++] = pair;
    if (kept.film >= 0) kept.film = place[kept.film];
  }
  out.films.resize(films), out.overlaps.resize(overlaps);
  for (auto* column : {&out.volume, &out.freeArea, &out.filmArea}) column->resize(bubbles);
  out.hidden.resize(bubbles);
}

}  // namespace

bool isAnyCutByWall(const std::vector<double>& radius, const Eigen::VectorXd& psi) {
  for (std::size_t i = 0; i < radius.size(); ++i)
    if (psi[static_cast<Eigen::Index>(i)] < kCutByWall * radius[i]) return true;
  return false;
}

void WallCells::addPlanes(const BubbleStore& bubbles, const std::vector<NearWalls>& walls) {
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (int k = 0; k < walls[i].count; ++k) {
      const double r = bubbles.radius[i], psi = walls[i].wall[k].psi;
      if (std::abs(psi) >= kCutByWall * r) continue;
      position_.push_back(bubbles.position[i] - r * walls[i].wall[k].away.normalized());
      radius_.push_back(std::sqrt(2 * r * (r - psi)));
      id_.push_back(~(kPlanesPerBubble * bubbles.id[i] + k));  // breaks ties as an id of its own
    }
}

void WallCells::compute(const BubbleStore& bubbles, const std::vector<NearWalls>& walls, FoamTopology& out) {
  position_ = bubbles.position, radius_ = bubbles.radius, id_ = bubbles.id;
  addPlanes(bubbles, walls);
  cells_.compute(position_, radius_, id_, out);
  if (position_.size() > bubbles.size()) dropPlanes(bubbles.size(), out);
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (int k = 0; k < walls[i].count; ++k)
      if (walls[i].wall[k].psi <= -kCutByWall * bubbles.radius[i]) out.volume[i] = out.freeArea[i] = 0;
}

}  // namespace spume::foam
