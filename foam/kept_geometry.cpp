#include "foam/kept_geometry.h"

#include <algorithm>
#include <utility>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Share of the rows that may have changed: from here on measuring them all costs no more.
constexpr double kFew = 0.05;

}  // namespace

void KeptGeometry::note(const BubbleStore& bubbles, const std::vector<NearWalls>& walls) {
  isKept_ = true, nextId_ = bubbles.nextId;
  id_ = bubbles.id, position_ = bubbles.position, radius_ = bubbles.radius, walls_ = walls;
  measurement_.begin(bubbles, walls);
}

bool KeptGeometry::renew(const BubbleStore& bubbles, const std::vector<NearWalls>& walls,
                         FoamTopology& topology, Neighbours& neighbours) {
  if (!std::exchange(isKept_, false) || !matchRows(bubbles)) return false;
  forEachIndex(id_.size(), [&](std::size_t former) {
    const std::int32_t row = rowOf_[former];
    if (row >= 0) isChanged_[row] = !isAsNoted(former, static_cast<std::size_t>(row), bubbles, walls);
  });
  renumber(topology, bubbles.size());
  changed_.clear();
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    if (isChanged_[i]) changed_.push_back(static_cast<std::int32_t>(i));
  if (static_cast<double>(changed_.size()) > kFew * static_cast<double>(bubbles.size())) return false;
  neighbours.build(bubbles.size(), topology.overlaps);
  if (changed_.empty()) return true;
  measurement_.renumber(rowOf_);
  measurement_.update(bubbles, walls, changed_, neighbours, topology);
  neighbours.build(bubbles.size(), topology.overlaps);
  return true;
}

/// Finds the rows of those noted; others have changed. False if they are in another order.
bool KeptGeometry::matchRows(const BubbleStore& bubbles) {
  rowOf_.assign(id_.size(), -1), isChanged_.assign(bubbles.size(), 1);
  std::size_t former = 0;
  for (std::size_t row = 0; row < bubbles.size(); ++row) {
    if (bubbles.id[row] >= nextId_) continue;
    while (former < id_.size() && id_[former] != bubbles.id[row]) ++former;
    if (former == id_.size()) return false;
    rowOf_[former++] = static_cast<std::int32_t>(row);
  }
  return true;
}

bool KeptGeometry::isAsNoted(std::size_t former, std::size_t row, const BubbleStore& bubbles,
                             const std::vector<NearWalls>& walls) const {
  static const NearWalls none;
  const double r = bubbles.radius[row];
  return r == radius_[former] && bubbles.position[row] == position_[former] &&
         cutAlike(r, walls_.empty() ? none : walls_[former], walls.empty() ? none : walls[row]);
}

/// Gives the topology the rows that there are now, new ones without neighbours.
void KeptGeometry::renumber(FoamTopology& topology, std::size_t bubbles) {
  const bool isAnyGone = std::find(rowOf_.begin(), rowOf_.end(), -1) != rowOf_.end();
  if (!isAnyGone && bubbles == id_.size()) return;
  const auto move = [&](auto& column) {
    const auto former = column;
    column.assign(bubbles, 0);
    for (std::size_t k = 0; k < former.size(); ++k)
      if (rowOf_[k] >= 0) column[rowOf_[k]] = former[k];
  };
  move(topology.volume), move(topology.freeArea), move(topology.filmArea), move(topology.hidden);
  if (isAnyGone) dropPairs(topology);
  const auto renumberPair = [&](auto& pair) { pair.i = rowOf_[pair.i], pair.j = rowOf_[pair.j]; };
  forEachIndex(topology.overlaps.size(), [&](std::size_t p) { renumberPair(topology.overlaps[p]); });
  forEachIndex(topology.films.size(), [&](std::size_t f) { renumberPair(topology.films[f]); });
}

/// Drops the pairs of those who are gone; those who have lost a neighbour have changed.
void KeptGeometry::dropPairs(FoamTopology& topology) {
  std::size_t pairs = 0, films = 0;
  for (const OverlapPair& pair : topology.overlaps) {
    const std::int32_t i = rowOf_[pair.i], j = rowOf_[pair.j];
    if (i >= 0 && j >= 0) {
      const std::int32_t film = pair.film;
      OverlapPair& kept = topology.overlaps[pairs++] = pair;
      if (film < 0) continue;
      kept.film = static_cast<std::int32_t>(films);
      topology.films[films++] = topology.films[film];
    } else {
      for (const std::int32_t left : {i, j})
        if (left >= 0) isChanged_[left] = 1;
    }
  }
  topology.overlaps.resize(pairs), topology.films.resize(films);
}

}  // namespace spume::foam
