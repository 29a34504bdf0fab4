#include "foam/power_cells.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "foam/ball_checks.h"
#include "foam/cell_sums.h"
#include "foam/disc_lines.h"
#include "foam/edge_batch.h"
#include "foam/neighbour_planes.h"
#include "foam/overlap_pairs.h"
#include "foam/raw_buffer.h"

namespace spume::foam {

namespace {

using Vector = Eigen::Vector3d;

constexpr std::int32_t kBubbleGrain = 256;  ///< bubbles per parallel task
constexpr std::int32_t kAhead = 8;          ///< bubbles between what is worked on and what is fetched
constexpr double kNoFilm = -1;              ///< for the arc of a pair that has none

template <typename Body>
void forEachBubble(std::int32_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, count, kBubbleGrain), [&](const auto& range) {
    for (std::int32_t s = range.begin(); s < range.end(); ++s) body(s);
  });
}

/// What one bubble of a pair finds out for both, in a cache line.
struct alignas(64) PairFilm {
  FilmShape shape;
  double distance;           ///< of the centres [m]
  double height, farHeight;  ///< signed distance of the plane from the owner's centre, and the other's [m]

  bool exists() const { return shape.arc >= 0; }
};

}  // namespace

/// The passes of the local engine. Bubbles are worked on by rank; what the first pass learns of a pair is
/// kept by its number in OverlapPairs, where both bubbles find it. Only what goes out is numbered by (i, j).
struct PowerCells::Internals {
  struct Scratch {
    NeighbourPlanes around;
    DiscLines lines;                       ///< of the discs that one ball owns
    std::vector<std::int32_t> disc, face;  ///< their overlaps and their planes
    EdgeBatch edges;
  };
  /// An overlap of a bubble's row.
  struct Overlap {
    std::int32_t index;  ///< input index of the other bubble
    std::int32_t link;   ///< twice the number of the pair, odd for the owner
  };
  struct Row {
    std::int32_t overlaps, lower;  ///< how many; of lower input index
    std::int32_t bubbles;          ///< of them, the first: those with bubbles
    bool centreInside;             ///< no plane cuts the ball's centre away
  };

  OverlapPairs near;
  std::int32_t bubbles = 0;  ///< the balls from this input index on are cutters
  RawBuffer<RankedBall> balls;
  RawBuffer<Overlap> overlap;         ///< of each bubble from its first slot in OverlapPairs on
  RawBuffer<Row> rows;                ///< by rank
  RawBuffer<PairFilm> film;           ///< by number of the pair, of those that overlap
  RawBuffer<std::int32_t> bare;       ///< by input index: overlaps without film with this bubble as i
  RawBuffer<std::int32_t> listed;     ///< by number of the pair: its place in the topology
  RawBuffer<std::int32_t> firstPair;  ///< by input index: first overlap with this bubble as i
  RawBuffer<std::int32_t> firstFilm;  ///< by input index: first film with this bubble as i
  tbb::enumerable_thread_specific<Scratch> scratch;

  std::int32_t size() const { return near.size(); }
  const Overlap* row(std::int32_t s) const { return overlap.data() + near.rowStart()[s]; }

  void load(const std::vector<Vector>& position, const std::vector<double>& trueRadius,
            const std::vector<std::uint64_t>& id, std::size_t cutters);
  void hide();
  void cutDiscs();
  void fetchPairs(std::int32_t s) const;
  NeighbourPlanes::Candidates candidatesOf(std::int32_t s) const;
  void cutRow(std::int32_t s, Scratch& local);
  void noteRow(std::int32_t s, const NeighbourPlanes& around);
  void findDiscs(std::int32_t s, Scratch& local);
  void cutDisc(std::int32_t s, std::size_t disc, Scratch& local);
  PairFilm& filmOf(const NeighbourPlanes& around, std::int32_t k) { return film[around.link[k] / 2]; }
  void noteBare(std::int32_t s, const NeighbourPlanes& around, std::int32_t k);
  void numberPairs(FoamTopology& out);
  void measureCells(FoamTopology& out);
  void measureCell(std::int32_t s, FoamTopology& out) const;
  void listRow(std::int32_t s, FoamTopology& out);
  void listNeighbours(Neighbours& out) const;
};

void PowerCells::Internals::load(const std::vector<Vector>& position, const std::vector<double>& trueRadius,
                                 const std::vector<std::uint64_t>& id, std::size_t cutters) {
  near.update(position, trueRadius, cutters);
  bubbles = size() - static_cast<std::int32_t>(cutters);
  const auto n = static_cast<std::size_t>(size());
  balls.resize(n), rows.resize(n), bare.resize(n), firstPair.resize(n + 1), firstFilm.resize(n + 1);
  overlap.resize(near.slots()), film.resize(near.slots() / 2), listed.resize(near.slots() / 2);
  forEachBubble(size(), [&](std::int32_t s) {
    const std::int32_t i = near.order()[s];
    balls[s] = {position[i].x(), position[i].y(), position[i].z(), TieBrokenBall(trueRadius[i], id[i]), 1, i};
    bare[s] = 0;
  });
}

/// Finds the balls that lie inside another (model, "Foam geometry"): those are hidden, but of two that are
/// the same the first. Two balls of which none is hidden cross.
void PowerCells::Internals::hide() {
  for (const auto& [inner, outer] : near.nestings()) {
    RankedBall& a = balls[inner];
    const RankedBall& b = balls[outer];
    const double distance = (Vector(a.x, a.y, a.z) - Vector(b.x, b.y, b.z)).norm();
    const double spare = b.ball.radius - a.ball.radius;
    if (distance <= spare && (spare > 0 || b.index < a.index)) a.visible = 0;
  }
}

void PowerCells::Internals::cutDiscs() {
  tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, size(), kBubbleGrain), [&](const auto& range) {
    Scratch& local = scratch.local();
    for (std::int32_t s = range.begin(); s < range.end(); ++s)
      if (balls[s].index < bubbles) cutRow(s, local);
    local.edges.flush();
  });
}

/// Fetches what is kept of the pairs that a bubble farther on has with still later ones; those with earlier
/// ones have been fetched with these.
void PowerCells::Internals::fetchPairs(std::int32_t s) const {
  const std::int32_t ahead = std::min(s + kAhead, size() - 1);
  for (std::int32_t pair = near.firstPair()[ahead]; pair < near.firstPair()[ahead + 1]; ++pair)
    __builtin_prefetch(&film[pair], 1);
}

NeighbourPlanes::Candidates PowerCells::Internals::candidatesOf(std::int32_t s) const {
  const std::int32_t begin = near.rowStart()[s], upper = near.upperStart()[s], end = near.rowStart()[s + 1];
  std::int32_t cutters = end;
  while (cutters > upper && balls[near.candidate()[cutters - 1]].index >= bubbles) --cutters;
  return {near.candidate().data() + begin, near.pair().data() + begin, static_cast<std::size_t>(end - begin),
          static_cast<std::size_t>(upper - begin), static_cast<std::size_t>(cutters - begin)};
}

/// Finds the row of ball s, and cuts the discs that it owns, each by all planes that cut the ball.
void PowerCells::Internals::cutRow(std::int32_t s, Scratch& local) {
  NeighbourPlanes& around = local.around;
  around.find(balls, s, candidatesOf(s));
  fetchPairs(s);
  noteRow(s, around);
  findDiscs(s, local);
  local.lines.find(around.planes, local.face, balls[s].ball.radius);
  local.lines.scale();
  for (std::size_t disc = 0; disc < local.disc.size(); ++disc)
    if (local.lines.isLeft(disc))
      cutDisc(s, disc, local);
    else
      noteBare(s, around, local.disc[disc]);
}

/// Cuts a disc of ball s by the lines on it.
void PowerCells::Internals::cutDisc(std::int32_t s, std::size_t disc, Scratch& local) {
  const NeighbourPlanes& around = local.around;
  const std::int32_t k = local.disc[disc];
  const TieBrokenBall& ball = balls[s].ball;
  const std::int32_t p = around.planeOf[k];
  PairFilm& pair = filmOf(around, k);
  pair.height = around.planes.height[p], pair.farHeight = around.farHeight[p];
  const DiscBalls sides{ball.radius,      ball.radiusShift, pair.height, around.planes.heightShift[p],
                        around.radius[p], pair.farHeight};
  if (!local.edges.add(local.lines, disc, sides, pair.shape)) noteBare(s, around, k);
}

/// Keeps the row, and begins what is kept of the pairs that the ball owns.
void PowerCells::Internals::noteRow(std::int32_t s, const NeighbourPlanes& around) {
  const auto overlaps = static_cast<std::int32_t>(around.overlaps);
  const auto lower = static_cast<std::int32_t>(around.lower);
  std::int32_t withBubbles = overlaps;
  while (withBubbles > lower && around.index[withBubbles - 1] >= bubbles) --withBubbles;
  rows[s] = {overlaps, lower, withBubbles, around.centreInside};
  firstPair[balls[s].index + 1] = withBubbles - lower;
  Overlap* kept = overlap.data() + near.rowStart()[s];
  for (std::int32_t k = 0; k < overlaps; ++k) {
    kept[k] = {around.index[k], around.link[k]};
    if (around.link[k] % 2 != 0) filmOf(around, k).distance = around.distance[k];
  }
}

/// Lists the discs that ball s owns.
void PowerCells::Internals::findDiscs(std::int32_t s, Scratch& local) {
  const NeighbourPlanes& around = local.around;
  local.disc.clear(), local.face.clear();
  for (std::int32_t k = 0; k < rows[s].overlaps; ++k) {
    if (around.link[k] % 2 == 0) continue;
    if (const std::int32_t p = around.planeOf[k]; p >= 0)
      local.disc.push_back(k), local.face.push_back(p);
    else
      noteBare(s, around, k);
  }
}

/// Notes that overlap k of ball s has no film.
void PowerCells::Internals::noteBare(std::int32_t s, const NeighbourPlanes& around, std::int32_t k) {
  filmOf(around, k).shape.arc = kNoFilm;
  if (around.index[k] >= bubbles) return;
  const std::int32_t first = std::min(balls[s].index, around.index[k]);
  std::atomic_ref(bare[first]).fetch_add(1, std::memory_order_relaxed);
}

/// Numbers overlapping pairs and films by (i, j).
void PowerCells::Internals::numberPairs(FoamTopology& out) {
  firstPair[0] = firstFilm[0] = 0;
  for (std::int32_t i = 0; i < bubbles; ++i) {
    firstFilm[i + 1] = firstFilm[i] + firstPair[i + 1] - bare[i];
    firstPair[i + 1] += firstPair[i];
  }
  out.overlaps.resize(firstPair[bubbles]), out.films.resize(firstFilm[bubbles]);
}

void PowerCells::Internals::measureCells(FoamTopology& out) {
  for (auto* column : {&out.volume, &out.freeArea, &out.filmArea}) column->resize(bubbles);
  out.hidden.resize(bubbles);
  forEachBubble(size(), [&](std::int32_t s) {
    fetchPairs(s);
    if (balls[s].index >= bubbles) return;
    measureCell(s, out);
    listRow(s, out);
  });
}

void PowerCells::Internals::measureCell(std::int32_t s, FoamTopology& out) const {
  CellSums sums(balls[s].ball);
  sums.limit(rows[s].centreInside);
  for (std::int32_t k = 0; k < rows[s].overlaps; ++k) {
    const std::int32_t link = row(s)[k].link;
    const PairFilm& pair = film[link / 2];
    if (!pair.exists()) continue;
    const bool owned = link % 2;
    const double height = owned ? pair.height : pair.farHeight;
    const double shift = owned ? pair.shape.heightShift : -pair.shape.heightShift;
    const double solid = owned ? pair.shape.solidNear : pair.shape.solidFar;
    if (k < rows[s].bubbles)
      sums.addFilm(pair.shape, height, shift, solid);
    else
      sums.addFace(pair.shape, height, shift, solid);
  }
  const std::int32_t i = balls[s].index;
  out.hidden[i] = balls[s].visible == 0 || sums.hidden();
  out.volume[i] = out.hidden[i] ? 0 : sums.volume();
  out.freeArea[i] = out.hidden[i] ? 0 : sums.freeArea();
  out.filmArea[i] = sums.filmArea();
}

/// Writes out the pairs and films of which the bubble is the first.
void PowerCells::Internals::listRow(std::int32_t s, FoamTopology& out) {
  const std::int32_t i = balls[s].index;
  std::int32_t nextPair = firstPair[i], nextFilm = firstFilm[i];
  for (std::int32_t k = rows[s].lower; k < rows[s].bubbles; ++k) {
    const auto [j, link] = row(s)[k];
    const PairFilm& pair = film[link / 2];
    listed[link / 2] = nextPair;
    out.overlaps[nextPair++] = {i, j, pair.distance, pair.exists() ? nextFilm : -1};
    if (!pair.exists()) continue;
    const double height =
        link % 2 ? pair.height + pair.shape.heightShift : pair.farHeight - pair.shape.heightShift;
    out.films[nextFilm++] = {i, j, pair.distance, height, pair.shape.trueArea()};
  }
}

void PowerCells::Internals::listNeighbours(Neighbours& out) const {
  out.start.resize(static_cast<std::size_t>(bubbles) + 1);
  out.start[0] = 0;
  for (std::int32_t i = 0; i < bubbles; ++i) out.start[i + 1] = out.start[i] + rows[near.rank()[i]].bubbles;
  out.other.resize(out.start[bubbles]), out.pair.resize(out.start[bubbles]);
  forEachBubble(size(), [&](std::int32_t s) {
    const std::int32_t i = balls[s].index;
    if (i >= bubbles) return;
    for (std::int32_t k = 0; k < rows[s].bubbles; ++k) {
      const auto [other, link] = row(s)[k];
      out.other[out.start[i] + k] = other, out.pair[out.start[i] + k] = listed[link / 2];
    }
  });
}

PowerCells::PowerCells() : internals_(std::make_unique<Internals>()) {}
PowerCells::~PowerCells() = default;
PowerCells::PowerCells(PowerCells&&) noexcept = default;
PowerCells& PowerCells::operator=(PowerCells&&) noexcept = default;

void PowerCells::compute(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                         const std::vector<std::uint64_t>& id, FoamTopology& out, std::size_t cutters) {
  checkBalls("PowerCells", position, radius, id);
  internals_->load(position, radius, id, std::min(cutters, radius.size()));
  internals_->hide();
  internals_->cutDiscs();
  internals_->numberPairs(out);
  internals_->measureCells(out);
}

void PowerCells::listNeighbours(Neighbours& out) const { internals_->listNeighbours(out); }

}  // namespace spume::foam
