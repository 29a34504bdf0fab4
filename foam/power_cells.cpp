#include "foam/power_cells.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
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

constexpr std::int32_t kBubbleGrain = 256;  ///< bubbles per parallel task, and per list of films

template <typename Body>
void forEachBubble(std::int32_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, count, kBubbleGrain), [&](const auto& range) {
    for (std::int32_t s = range.begin(); s < range.end(); ++s) body(s);
  });
}

/// Where one value stands in a list that holds it once; without a branch, as lists are short.
std::int32_t placeOf(std::int32_t value, const std::int32_t* list, std::int32_t count) {
  std::int32_t place = 0;
  for (std::int32_t k = 0; k < count; ++k) place += list[k] == value ? k : 0;
  return place;
}

}  // namespace

/// The passes of the local engine. Columns are by rank or by the slots of OverlapPairs, so that every pass
/// walks through memory; only what the last one writes is numbered by (i, j).
struct PowerCells::Internals {
  struct Scratch {
    NeighbourDistances distances;
    NeighbourPlanes around;
    std::vector<std::int32_t> row, cutting, place;
    std::vector<DiscLines> lines;        ///< of the discs of one ball that are not gone yet
    std::vector<std::int32_t> lineDisc;  ///< place in `cutting` of each
    EdgeBatch edges;
  };

  OverlapPairs near;
  RankedBalls balls;
  RawBuffer<std::uint8_t> hidden;
  RawBuffer<std::int32_t> overlap;  ///< by slot: ranks that overlap now, from each row's beginning on
  RawBuffer<std::int32_t> overlaps, lowerOverlaps;  ///< how many there are; of lower input index
  RawBuffer<std::int32_t> firstOwn;                 ///< in `film`, of each bubble's discs
  RawBuffer<FilmShape> film;          ///< of every overlap, in the order of owners; near is the owner's side
  RawBuffer<std::int32_t> filmOf;     ///< by slot: twice the place in `film`, odd for its owner, or -1
  RawBuffer<std::int32_t> firstPair;  ///< by input index: first overlap with this bubble as i
  RawBuffer<std::int32_t> firstFilm;  ///< by input index: first film with this bubble as i
  tbb::enumerable_thread_specific<Scratch> scratch;

  std::int32_t size() const { return near.size(); }
  std::int32_t rowStart(std::int32_t s) const { return near.rowStart()[s]; }
  const std::int32_t* row(std::int32_t s) const { return overlap.data() + rowStart(s); }

  void load(const std::vector<Vector>& position, const std::vector<double>& trueRadius,
            const std::vector<std::uint64_t>& id);
  void relate();
  void relateRow(std::int32_t s, Scratch& local);
  bool isContained(std::int32_t s, std::int32_t t) const;
  void clipDiscs();
  void clipRow(std::int32_t s, Scratch& local);
  void findLines(std::int32_t s, Scratch& local);
  bool owns(std::int32_t s, std::int32_t k) const;
  void note(std::int32_t s, std::int32_t k, std::int32_t place);
  void numberPairs(FoamTopology& out);
  void measureCells(FoamTopology& out);
  void measureCell(std::int32_t s, const NeighbourPlanes& around, FoamTopology& out) const;
  void listRow(std::int32_t s, const NeighbourPlanes& around, FoamTopology& out) const;

  template <typename Body>
  void forEachRow(const Body& body) {
    tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, size(), kBubbleGrain), [&](const auto& range) {
      Scratch& local = scratch.local();
      for (std::int32_t s = range.begin(); s < range.end(); ++s) body(s, local);
    });
  }
};

void PowerCells::Internals::load(const std::vector<Vector>& position, const std::vector<double>& trueRadius,
                                 const std::vector<std::uint64_t>& id) {
  near.update(position, trueRadius);
  balls.resize(position.size());
  forEachBubble(size(), [&](std::int32_t s) {
    const std::int32_t i = near.order()[s];
    const TieBrokenBall ball(trueRadius[i], id[i]);
    balls.place[s] = {position[i].x(), position[i].y(), position[i].z(), ball.radius};
    balls.radiusShift[s] = ball.radiusShift, balls.weightShift[s] = ball.weightShift;
  });
}

/// Finds which candidates overlap now, and which balls lie inside another (model, "Foam geometry"): those are
/// hidden. Two balls of which none is hidden cross.
void PowerCells::Internals::relate() {
  const auto n = static_cast<std::size_t>(size());
  hidden.resize(n), overlaps.resize(n), lowerOverlaps.resize(n), firstOwn.resize(n + 1);
  overlap.resize(near.candidate().size()), filmOf.resize(near.candidate().size());
  forEachRow([&](std::int32_t s, Scratch& local) { relateRow(s, local); });
  firstOwn[0] = 0;
  for (std::size_t s = 0; s < n; ++s) firstOwn[s + 1] += firstOwn[s];
  film.resize(firstOwn[n]);
}

void PowerCells::Internals::relateRow(std::int32_t s, Scratch& local) {
  NeighbourDistances& to = local.distances;
  const std::int32_t* candidate = near.candidate().data() + rowStart(s);
  const auto lower = static_cast<std::size_t>(near.upperStart()[s] - rowStart(s));
  to.measure(balls, s, candidate, static_cast<std::size_t>(rowStart(s + 1) - rowStart(s)));
  local.row.resize(to.count + kLanes);  // closing gaps writes whole blocks
  const double radius = balls.place[s].radius;
  std::size_t found = 0, foundLower = 0;
  std::int32_t own = 0;
  hidden[s] = 0;
  for (std::size_t k = 0; k < to.count; k += kLanes) {
    const Lanes distance = loadLanes(&to.distance[k]), other = loadLanes(&to.radius[k]);
    const std::uint32_t touching = bitsOf(distance < radius + other) & lanesBelow(to.count - k);
    const std::uint32_t below = k < lower ? lanesBelow(lower - k) : 0;
    for (std::uint32_t left = bitsOf(distance <= other - radius) & touching; left != 0; left &= left - 1)
      hidden[s] |= isContained(s, candidate[k + std::countr_zero(left)]);
    foundLower += std::popcount(touching & below);
    own += std::popcount(touching & (bitsOf(radius < other) | (bitsOf(radius == other) & ~below)));
    found += storeSelected(touching, candidate + k, &local.row[found]);
  }
  std::copy_n(local.row.begin(), found, overlap.data() + rowStart(s));
  overlaps[s] = static_cast<std::int32_t>(found), lowerOverlaps[s] = static_cast<std::int32_t>(foundLower);
  firstOwn[s + 1] = own;
}

/// Whether ball s, no larger than t and within it, is hidden: of two that are the same the first stays.
bool PowerCells::Internals::isContained(std::int32_t s, std::int32_t t) const {
  return balls.place[t].radius > balls.place[s].radius || near.order()[t] < near.order()[s];
}

/// The smaller ball, which has fewer neighbours, clips the disc of a pair; of two that are the same the
/// first.
bool PowerCells::Internals::owns(std::int32_t s, std::int32_t k) const {
  const double own = balls.place[s].radius, other = balls.place[row(s)[k]].radius;
  return own < other || (own == other && k >= lowerOverlaps[s]);
}

void PowerCells::Internals::clipDiscs() {
  tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, size(), kBubbleGrain), [&](const auto& range) {
    Scratch& local = scratch.local();
    for (std::int32_t s = range.begin(); s < range.end(); ++s)
      if (firstOwn[s] < firstOwn[s + 1]) clipRow(s, local);
    local.edges.flush();
  });
}

/// Clips the discs that ball s owns, each by all planes that cut the ball.
void PowerCells::Internals::clipRow(std::int32_t s, Scratch& local) {
  local.cutting.clear(), local.place.clear();
  for (std::int32_t k = 0; k < overlaps[s]; ++k)
    if (const std::int32_t t = row(s)[k]; !hidden[s] && !hidden[t])
      local.cutting.push_back(t), local.place.push_back(k);
    else if (owns(s, k))
      note(s, k, -1);
  local.around.find(balls, s, local.cutting.data(), local.cutting.size());
  findLines(s, local);
  for (std::size_t disc = 0; disc < local.lineDisc.size(); ++disc) local.lines[disc].scale();
  std::int32_t next = firstOwn[s];
  for (std::size_t disc = 0; disc < local.lineDisc.size(); ++disc) {
    const std::int32_t p = local.lineDisc[disc];
    const bool any = local.edges.add(
        local.lines[disc],
        {balls.place[s].radius, balls.radiusShift[s], local.around.planes.height[p],
         local.around.planes.heightShift[p], local.around.to.radius[p], local.around.farHeight[p]},
        film[next]);
    note(s, local.place[p], any ? next++ : -1);
  }
}

/// Finds the lines on the discs that ball s owns.
void PowerCells::Internals::findLines(std::int32_t s, Scratch& local) {
  local.lineDisc.clear();
  for (std::size_t p = 0; p < local.cutting.size(); ++p) {
    if (!owns(s, local.place[p])) continue;
    const std::size_t disc = local.lineDisc.size();
    if (local.lines.size() == disc) local.lines.emplace_back();
    if (local.lines[disc].find(local.around.planes, p, balls.place[s].radius))
      local.lineDisc.push_back(static_cast<std::int32_t>(p));
    else
      note(s, local.place[p], -1);
  }
}

/// Tells both bubbles of the pair in slot k of ball s's row where its film is.
void PowerCells::Internals::note(std::int32_t s, std::int32_t k, std::int32_t place) {
  const std::int32_t t = row(s)[k], there = rowStart(t) + placeOf(s, row(t), overlaps[t]);
  filmOf[rowStart(s) + k] = place < 0 ? -1 : 2 * place + 1;
  filmOf[there] = place < 0 ? -1 : 2 * place;
}

/// Numbers overlapping pairs and films by (i, j).
void PowerCells::Internals::numberPairs(FoamTopology& out) {
  firstPair.resize(static_cast<std::size_t>(size()) + 1);
  firstFilm.resize(static_cast<std::size_t>(size()) + 1);
  firstPair[0] = firstFilm[0] = 0;
  forEachBubble(size(), [&](std::int32_t s) {
    std::int32_t films = 0;
    for (std::int32_t k = lowerOverlaps[s]; k < overlaps[s]; ++k) films += filmOf[rowStart(s) + k] >= 0;
    const std::int32_t i = near.order()[s];
    firstPair[i + 1] = overlaps[s] - lowerOverlaps[s], firstFilm[i + 1] = films;
  });
  for (std::int32_t i = 0; i < size(); ++i)
    firstPair[i + 1] += firstPair[i], firstFilm[i + 1] += firstFilm[i];
  out.overlaps.resize(firstPair[size()]), out.films.resize(firstFilm[size()]);
}

void PowerCells::Internals::measureCells(FoamTopology& out) {
  for (auto* column : {&out.volume, &out.freeArea, &out.filmArea}) column->resize(size());
  out.hidden.resize(size());
  forEachRow([&](std::int32_t s, Scratch& local) {
    local.around.find(balls, s, row(s), static_cast<std::size_t>(overlaps[s]));
    measureCell(s, local.around, out);
    listRow(s, local.around, out);
  });
}

void PowerCells::Internals::measureCell(std::int32_t s, const NeighbourPlanes& around,
                                        FoamTopology& out) const {
  CellSums sums(balls.ball(s));
  for (std::int32_t k = 0; k < overlaps[s] && !hidden[s]; ++k) {
    if (hidden[row(s)[k]]) continue;
    const double height = around.planes.height[k];
    sums.addPlane(height);
    const std::int32_t place = filmOf[rowStart(s) + k];
    if (place < 0) continue;
    const FilmShape& shape = film[place / 2];
    sums.addFilm(shape, height, around.planes.heightShift[k], place % 2 ? shape.solidNear : shape.solidFar);
  }
  const std::int32_t i = near.order()[s];
  out.hidden[i] = hidden[s] || sums.hidden();
  out.volume[i] = out.hidden[i] ? 0 : sums.volume();
  out.freeArea[i] = out.hidden[i] ? 0 : sums.freeArea();
  out.filmArea[i] = sums.filmArea();
}

/// Writes out the pairs and films of which the bubble is the first.
void PowerCells::Internals::listRow(std::int32_t s, const NeighbourPlanes& around, FoamTopology& out) const {
  const std::int32_t i = near.order()[s];
  std::int32_t nextPair = firstPair[i], nextFilm = firstFilm[i];
  for (std::int32_t k = lowerOverlaps[s]; k < overlaps[s]; ++k) {
    const std::int32_t j = near.order()[row(s)[k]], place = filmOf[rowStart(s) + k];
    const double distance = around.to.distance[k];
    out.overlaps[nextPair++] = {i, j, distance, place < 0 ? -1 : nextFilm};
    if (place >= 0)
      out.films[nextFilm++] = {i, j, distance, around.planes.height[k] + around.planes.heightShift[k],
                               film[place / 2].trueArea()};
  }
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
  internals_->clipDiscs();
  internals_->numberPairs(out);
  internals_->measureCells(out);
}

}  // namespace spume::foam
