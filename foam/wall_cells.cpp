#include "foam/wall_cells.h"

#include <algorithm>
#include <cmath>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

constexpr std::uint64_t kPlanesPerBubble = 4;  // at least as many as NearWalls knows

}  // namespace

bool isAnyCutByWall(const std::vector<double>& radius, const Eigen::VectorXd& psi) {
  for (std::size_t i = 0; i < radius.size(); ++i)
    if (psi[static_cast<Eigen::Index>(i)] < kCutByWall * radius[i]) return true;
  return false;
}

void WallCells::listCut(const BubbleStore& bubbles, const std::vector<NearWalls>& walls) {
  isCut_.resize(walls.size()), cut_.clear();
  forEachIndex(walls.size(), [&](std::size_t i) {
    isCut_[i] = 0;
    for (int k = 0; k < walls[i].count; ++k)
      if (walls[i].wall[k].psi < kCutByWall * bubbles.radius[i]) isCut_[i] = 1;
  });
  for (std::size_t i = 0; i < walls.size(); ++i)
    if (isCut_[i]) cut_.push_back(i);
}

void WallCells::addPlanes(const BubbleStore& bubbles, const std::vector<NearWalls>& walls) {
  for (const std::size_t i : cut_)
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
  listCut(bubbles, walls);
  addPlanes(bubbles, walls);
  cells_.compute(position_, radius_, id_, out, position_.size() - bubbles.size());
  for (const std::size_t i : cut_)
    for (int k = 0; k < walls[i].count; ++k)
      if (walls[i].wall[k].psi <= -kCutByWall * bubbles.radius[i]) out.volume[i] = out.freeArea[i] = 0;
}

}  // namespace spume::foam
