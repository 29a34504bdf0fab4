#include "foam/wall_cells.h"

#include <algorithm>
#include <cmath>

#include "foam/parallel.h"
#include "foam/power_diagram.h"

namespace spume::foam {
namespace {

constexpr std::uint64_t kPlanesPerBubble = 4;  // at least as many as NearWalls knows

/// Leaves out the balls from row `bubbles` on, which stand for planes, and their faces, which are no films.
void leaveOutPlanes(std::size_t bubbles, FoamTopology& topology) {
  const auto isOfBubbles = [&](const auto& pair) { return static_cast<std::size_t>(pair.j) < bubbles; };
  std::vector<std::int32_t> place(topology.films.size(), -1);
  std::vector<Film> films;
  for (std::size_t f = 0; f < topology.films.size(); ++f)
    if (isOfBubbles(topology.films[f])) {
      place[f] = static_cast<std::int32_t>(films.size());
      films.push_back(topology.films[f]);
    }
  topology.films.swap(films);
  std::erase_if(topology.overlaps, [&](const OverlapPair& pair) { return !isOfBubbles(pair); });
  for (OverlapPair& pair : topology.overlaps)
    if (pair.film >= 0) pair.film = place[pair.film];
  for (auto* column : {&topology.volume, &topology.freeArea}) column->resize(bubbles);
  topology.hidden.resize(bubbles), topology.filmArea.assign(bubbles, 0);
  for (const Film& film : topology.films)
    for (const std::int32_t i : {film.i, film.j}) topology.filmArea[i] += film.area;
}

}  // namespace

bool isAnyCutByWall(const std::vector<double>& radius, const Eigen::VectorXd& psi) {
  for (std::size_t i = 0; i < radius.size(); ++i)
    if (psi[static_cast<Eigen::Index>(i)] < kCutByWall * radius[i]) return true;
  return false;
}

bool cutAlike(double radius, const NearWalls& a, const NearWalls& b) {
  const auto isCutBy = [&](const NearWalls& walls, int k) {
    return k < walls.count && walls.wall[k].psi < kCutByWall * radius;
  };
  for (int k = 0; k < std::max(a.count, b.count); ++k) {
    if (isCutBy(a, k) != isCutBy(b, k)) return false;
    if (isCutBy(a, k) && (a.wall[k].psi != b.wall[k].psi || a.wall[k].away != b.wall[k].away)) return false;
  }
  return true;
}

void WallPlanes::list(const BubbleStore& bubbles, const std::vector<NearWalls>& walls) {
  owner.clear(), position.clear(), radius.clear(), id.clear(), behind.clear();
  isCut_.resize(walls.size());
  forEachIndex(walls.size(), [&](std::size_t i) {
    isCut_[i] = 0;
    for (int k = 0; k < walls[i].count; ++k)
      if (walls[i].wall[k].psi < kCutByWall * bubbles.radius[i]) isCut_[i] = 1;
  });
  for (std::size_t i = 0; i < walls.size(); ++i)
    if (isCut_[i]) add(bubbles, walls[i], i);
}

void WallPlanes::add(const BubbleStore& bubbles, const NearWalls& walls, std::size_t i) {
  bool isBehind = false;
  for (int k = 0; k < walls.count; ++k) {
    const double r = bubbles.radius[i], psi = walls.wall[k].psi;
    isBehind = isBehind || psi <= -kCutByWall * r;
    if (std::abs(psi) >= kCutByWall * r) continue;
    owner.push_back(static_cast<std::int32_t>(i));
    position.push_back(bubbles.position[i] - r * walls.wall[k].away.normalized());
    radius.push_back(std::sqrt(2 * r * (r - psi)));
    id.push_back(~(kPlanesPerBubble * bubbles.id[i] + k));
  }
  if (isBehind) behind.push_back(static_cast<std::int32_t>(i));
}

void WallCells::compute(const BubbleStore& bubbles, const std::vector<NearWalls>& walls, FoamTopology& out) {
  planes_.list(bubbles, walls);
  const auto join = [](auto& all, const auto& ofBubbles, const auto& ofPlanes) {
    all = ofBubbles;
    all.insert(all.end(), ofPlanes.begin(), ofPlanes.end());
  };
  join(position_, bubbles.position, planes_.position), join(radius_, bubbles.radius, planes_.radius);
  join(id_, bubbles.id, planes_.id);
  if (engine_ == Connectivity::local) {
    cells_.compute(position_, radius_, id_, out, planes_.owner.size());
  } else {
    PowerDiagram().compute(position_, radius_, id_, out);
    leaveOutPlanes(bubbles.size(), out);
  }
  for (const std::int32_t i : planes_.behind) out.volume[i] = out.freeArea[i] = 0;
}

void WallCells::listNeighbours(const FoamTopology& topology, Neighbours& out) const {
  if (engine_ == Connectivity::local)
    cells_.listNeighbours(out);
  else
    out.build(topology.volume.size(), topology.overlaps);
}

}  // namespace spume::foam
