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
  cells_.compute(position_, radius_, id_, out, planes_.owner.size());
  for (const std::int32_t i : planes_.behind) out.volume[i] = out.freeArea[i] = 0;
}

}  // namespace spume::foam
