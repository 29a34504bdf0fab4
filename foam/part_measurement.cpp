#include "foam/part_measurement.h"

#include <atomic>
#include <utility>

#include "foam/parallel.h"

namespace spume::foam {
namespace {

/// Rows of a parallel task: a question to boxes takes up to a microsecond.
constexpr std::size_t kPiece = 64;

template <typename Body>
void forEachPiece(std::size_t n, const Body& body) {
  if (n <= kPiece) {
    for (std::size_t k = 0; k < n; ++k) body(k);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, kPiece), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) body(k);
  });
}

/// Several threads may mark the same row with the same mark.
void mark(std::uint8_t& row, std::uint8_t as) { std::atomic_ref(row).store(as, std::memory_order_relaxed); }
bool isMarked(std::uint8_t& row, std::uint8_t as) {
  return std::atomic_ref(row).load(std::memory_order_relaxed) == as;
}

}  // namespace

void PartMeasurement::renumber(const std::vector<std::int32_t>& rowOf) {
  for (std::int32_t& owner : planes_.owner) owner = rowOf[owner];
}

void PartMeasurement::update(const BubbleStore& bubbles, const std::vector<NearWalls>& walls,
                             const std::vector<std::int32_t>& changed, const Neighbours& neighbours,
                             FoamTopology& topology) {
  planesNow_.list(bubbles, walls);
  balls_.build(bubbles.position, bubbles.radius);
  planeBalls_.build(planesNow_.position, planesNow_.radius);
  markWhole(bubbles, changed, neighbours);
  markCutting(bubbles, neighbours);
  gather(bubbles, walls);
  cells_.compute(bubbles_, walls_, topology_);
  replacer_.putBack(topology_, rows_, whole_, topology);
  std::swap(planes_, planesNow_);
}

void PartMeasurement::markWhole(const BubbleStore& bubbles, const std::vector<std::int32_t>& changed,
                                const Neighbours& neighbours) {
  part_.assign(bubbles.size(), elsewhere), isChanged_.assign(bubbles.size(), 0);
  forEachPiece(changed.size(), [&](std::size_t k) {
    const std::int32_t i = changed[k];
    isChanged_[i] = 1;
    mark(part_[i], whole);
    for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e)
      mark(part_[neighbours.other[e]], whole);
    balls_.visitMeeting(bubbles.position[i], bubbles.radius[i],
                        [&](std::size_t j) { mark(part_[j], whole); });
  });
  markMetByPlanes(planes_), markMetByPlanes(planesNow_);
}

/// The cells that planes of changed rows cut, or have cut.
void PartMeasurement::markMetByPlanes(const WallPlanes& planes) {
  forEachPiece(planes.owner.size(), [&](std::size_t p) {
    if (const std::int32_t i = planes.owner[p]; i >= 0 && !isChanged_[i]) return;
    balls_.visitMeeting(planes.position[p], planes.radius[p], [&](std::size_t j) { mark(part_[j], whole); });
  });
}

void PartMeasurement::markCutting(const BubbleStore& bubbles, const Neighbours& neighbours) {
  rows_.clear();
  for (std::size_t i = 0; i < part_.size(); ++i)
    if (part_[i] == whole) rows_.push_back(static_cast<std::int32_t>(i));
  const auto add = [&](std::int32_t j) {
    if (!isMarked(part_[j], whole)) mark(part_[j], cutting);
  };
  forEachPiece(rows_.size(), [&](std::size_t k) {
    const std::int32_t i = rows_[k];
    for (std::int32_t e = neighbours.start[i]; e < neighbours.start[i + 1]; ++e) add(neighbours.other[e]);
    planeBalls_.visitMeeting(bubbles.position[i], bubbles.radius[i],
                             [&](std::size_t p) { add(planesNow_.owner[p]); });
  });
}

void PartMeasurement::gather(const BubbleStore& bubbles, const std::vector<NearWalls>& walls) {
  rows_.clear(), whole_.clear(), walls_.clear();
  bubbles_.position.clear(), bubbles_.radius.clear(), bubbles_.id.clear();
  for (std::size_t i = 0; i < part_.size(); ++i) {
    if (part_[i] == elsewhere) continue;
    rows_.push_back(static_cast<std::int32_t>(i)), whole_.push_back(part_[i] == whole);
    bubbles_.position.push_back(bubbles.position[i]), bubbles_.radius.push_back(bubbles.radius[i]);
    bubbles_.id.push_back(bubbles.id[i]);
    if (!walls.empty()) walls_.push_back(walls[i]);
  }
}

}  // namespace spume::foam
