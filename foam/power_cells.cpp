#include "foam/power_cells.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "foam/ball_checks.h"
#include "foam/cell_sums.h"
#include "foam/disc_clipper.h"
#include "foam/overlap_pairs.h"

namespace spume::foam {

namespace {

using Vector = Eigen::Vector3d;

constexpr std::int32_t kGrain = 256;  ///< bubbles per parallel task

template <typename Body>
void forEachBubble(std::int32_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, count, kGrain), [&](const auto& range) {
    for (std::int32_t s = range.begin(); s < range.end(); ++s) body(s);
  });
}

enum class Relation : std::uint8_t { apart, crossing, contained };

}  // namespace

/// The passes of the local engine. Columns over bubbles are by rank, columns over pairs by the order of
/// FoamTopology::overlaps, which is sorted.
struct PowerCells::Internals {
  struct Scratch {
    CuttingPlanes planes;
    std::vector<std::int32_t> slot;  ///< of the overlap behind each plane
    DiscClipper clipper;
  };

  OverlapPairs near;
  std::vector<Vector> centre;
  std::vector<TieBrokenBall> ball;
  std::vector<std::uint8_t> hidden;
  std::vector<std::int32_t> crossings;   ///< number of balls whose sphere crosses the bubble's
  std::vector<Relation> relation;        ///< by slot
  std::vector<double> distance;          ///< by slot [m]
  std::vector<std::int32_t> pairOfSlot;  ///< by slot, -1 if apart
  std::vector<std::int32_t> firstPair;   ///< by input index: first overlap with this bubble as i
  std::vector<FilmShape> disc;           ///< by pair; near side = owner
  std::vector<std::int32_t> filmCount;   ///< by input index, then summed
  tbb::enumerable_thread_specific<Scratch> scratch;

  std::int32_t size() const { return near.size(); }
  std::int32_t rowBegin(std::int32_t s) const { return near.rowStart()[s]; }
  std::int32_t rowEnd(std::int32_t s) const { return near.rowStart()[s + 1]; }
  bool cuts(std::int32_t slot) const {
    return relation[slot] == Relation::crossing && !hidden[near.candidate()[slot]];
  }
  bool owns(std::int32_t s, std::int32_t t) const {
    return crossings[s] != crossings[t] ? crossings[s] < crossings[t] : near.order()[s] < near.order()[t];
  }
  double heightOf(std::int32_t s, std::int32_t t, double d) const {
    return radicalHeight(ball[s], ball[t], d);
  }
  double heightShiftOf(std::int32_t s, std::int32_t t, double d) const {
    return radicalHeightShift(ball[s], ball[t], d);
  }

  void load(const std::vector<Vector>& position, const std::vector<double>& trueRadius,
            const std::vector<std::uint64_t>& id);
  void relate();
  void relateRow(std::int32_t s);
  void listOverlaps(FoamTopology& out);
  void clipDiscs();
  void clipRow(std::int32_t s, Scratch& local);
  void listFilms(FoamTopology& out);
  void measureCells(FoamTopology& out) const;
  void measureCell(std::int32_t s, FoamTopology& out) const;
};

void PowerCells::Internals::load(const std::vector<Vector>& position, const std::vector<double>& trueRadius,
                                 const std::vector<std::uint64_t>& id) {
  near.update(position, trueRadius);
  const std::size_t n = position.size();
  centre.resize(n), ball.resize(n), hidden.resize(n), crossings.resize(n);
  forEachBubble(size(), [&](std::int32_t s) {
    const std::int32_t i = near.order()[s];
    centre[s] = position[i];
    ball[s] = {trueRadius[i], id[i]};
  });
}

/// Finds which candidates overlap now, and which balls lie inside another (model, "Foam geometry"): those are
/// hidden.
void PowerCells::Internals::relate() {
  const std::size_t slots = near.candidate().size();
  relation.resize(slots), distance.resize(slots), pairOfSlot.resize(slots);
  forEachBubble(size(), [&](std::int32_t s) { relateRow(s); });
}

void PowerCells::Internals::relateRow(std::int32_t s) {
  hidden[s] = 0;
  crossings[s] = 0;
  for (std::int32_t slot = rowBegin(s); slot < rowEnd(s); ++slot) {
    const std::int32_t t = near.candidate()[slot];
    const double d = (centre[t] - centre[s]).norm(), gap = ball[t].radius - ball[s].radius;
    distance[slot] = d;
    relation[slot] = d >= ball[s].radius + ball[t].radius ? Relation::apart
                     : d > std::abs(gap)                  ? Relation::crossing
                                                          : Relation::contained;
    crossings[s] += relation[slot] == Relation::crossing;
    if (relation[slot] == Relation::contained)
      hidden[s] |= gap > 0 || (gap == 0 && near.order()[t] < near.order()[s]);
  }
}

/// Numbers the overlapping pairs by (i, j) and writes them out.
void PowerCells::Internals::listOverlaps(FoamTopology& out) {
  firstPair.assign(static_cast<std::size_t>(size()) + 1, 0);
  const auto isUpper = [&](std::int32_t i, std::int32_t slot) {
    return relation[slot] != Relation::apart && near.order()[near.candidate()[slot]] > i;
  };
  forEachBubble(size(), [&](std::int32_t i) {
    const std::int32_t s = near.rank()[i];
    for (std::int32_t slot = rowBegin(s); slot < rowEnd(s); ++slot) firstPair[i + 1] += isUpper(i, slot);
  });
  for (std::int32_t i = 0; i < size(); ++i) firstPair[i + 1] += firstPair[i];
  out.overlaps.resize(firstPair.back());
  disc.resize(firstPair.back());
  forEachBubble(size(), [&](std::int32_t i) {
    std::int32_t pair = firstPair[i];
    for (std::int32_t slot = rowBegin(near.rank()[i]); slot < rowEnd(near.rank()[i]); ++slot) {
      if (!isUpper(i, slot)) continue;
      out.overlaps[pair] = {i, near.order()[near.candidate()[slot]], distance[slot], -1};
      disc[pair].empty = true;
      pairOfSlot[slot] = pairOfSlot[near.mirror()[slot]] = pair++;
    }
  });
}

void PowerCells::Internals::clipDiscs() {
  tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, size(), kGrain), [&](const auto& range) {
    Scratch& local = scratch.local();
    for (std::int32_t s = range.begin(); s < range.end(); ++s)
      if (!hidden[s]) clipRow(s, local);
  });
}

/// Gathers the planes that cut ball s and clips the discs it owns.
void PowerCells::Internals::clipRow(std::int32_t s, Scratch& local) {
  local.slot.clear();
  bool ownsAny = false;
  for (std::int32_t slot = rowBegin(s); slot < rowEnd(s); ++slot)
    if (cuts(slot)) {
      local.slot.push_back(slot);
      ownsAny |= owns(s, near.candidate()[slot]);
    }
  if (!ownsAny) return;
  CuttingPlanes& planes = local.planes;
  planes.resize(local.slot.size());
  for (std::size_t k = 0; k < planes.count; ++k) {
    const std::int32_t t = near.candidate()[local.slot[k]];
    const double d = distance[local.slot[k]];
    const Vector normal = (centre[t] - centre[s]) / d;
    planes.nx[k] = normal.x(), planes.ny[k] = normal.y(), planes.nz[k] = normal.z();
    planes.height[k] = heightOf(s, t, d);
    planes.heightShift[k] = heightShiftOf(s, t, d);
  }
  for (std::size_t k = 0; k < planes.count; ++k) {
    const std::int32_t slot = local.slot[k], t = near.candidate()[slot];
    if (!owns(s, t)) continue;
    disc[pairOfSlot[slot]] = local.clipper.clip(
        planes, k, {ball[s].radius, ball[s].radiusShift, ball[t].radius, heightOf(t, s, distance[slot])});
  }
}

/// Numbers the discs that are left by (i, j) and writes them out.
void PowerCells::Internals::listFilms(FoamTopology& out) {
  filmCount.assign(static_cast<std::size_t>(size()) + 1, 0);
  forEachBubble(size(), [&](std::int32_t i) {
    for (std::int32_t pair = firstPair[i]; pair < firstPair[i + 1]; ++pair)
      filmCount[i + 1] += !disc[pair].empty;
  });
  for (std::int32_t i = 0; i < size(); ++i) filmCount[i + 1] += filmCount[i];
  out.films.resize(filmCount.back());
  forEachBubble(size(), [&](std::int32_t i) {
    std::int32_t film = filmCount[i];
    for (std::int32_t pair = firstPair[i]; pair < firstPair[i + 1]; ++pair) {
      OverlapPair& overlap = out.overlaps[pair];
      if (disc[pair].empty) continue;
      const std::int32_t s = near.rank()[i], t = near.rank()[overlap.j];
      const double height = heightOf(s, t, overlap.distance) + heightShiftOf(s, t, overlap.distance);
      out.films[film] = {i, overlap.j, overlap.distance, height, disc[pair].trueArea()};
      overlap.film = film++;
    }
  });
}

void PowerCells::Internals::measureCells(FoamTopology& out) const {
  for (auto* column : {&out.volume, &out.freeArea, &out.filmArea}) column->resize(size());
  out.hidden.resize(size());
  forEachBubble(size(), [&](std::int32_t s) { measureCell(s, out); });
}

void PowerCells::Internals::measureCell(std::int32_t s, FoamTopology& out) const {
  CellSums sums(ball[s]);
  for (std::int32_t slot = rowBegin(s); slot < rowEnd(s) && !hidden[s]; ++slot) {
    if (!cuts(slot)) continue;
    const std::int32_t t = near.candidate()[slot];
    const double height = heightOf(s, t, distance[slot]);
    sums.addPlane(height);
    const FilmShape& film = disc[pairOfSlot[slot]];
    if (!film.empty)
      sums.addFilm(film, height, heightShiftOf(s, t, distance[slot]),
                   owns(s, t) ? film.solidNear : film.solidFar);
  }
  const std::int32_t i = near.order()[s];
  out.hidden[i] = hidden[s] || sums.hidden();
  out.volume[i] = out.hidden[i] ? 0 : sums.volume();
  out.freeArea[i] = out.hidden[i] ? 0 : sums.freeArea();
  out.filmArea[i] = sums.filmArea();
}

PowerCells::PowerCells() : internals_(std::make_unique<Internals>()) {}
PowerCells::~PowerCells() = default;
PowerCells::PowerCells(PowerCells&&) noexcept = default;
PowerCells& PowerCells::operator=(PowerCells&&) noexcept = default;

void PowerCells::compute(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                         const std::vector<std::uint64_t>& id, FoamTopology& out) {
  checkBalls("PowerCells", position, radius, id);
  internals_->load(position, radius, id);
  internals_->relate();
  internals_->listOverlaps(out);
  internals_->clipDiscs();
  internals_->listFilms(out);
  internals_->measureCells(out);
}

}  // namespace spume::foam
