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

constexpr std::int32_t kBubbleGrain = 256;  ///< bubbles per parallel task

template <typename Body>
void forEachBubble(std::int32_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, count, kBubbleGrain), [&](const auto& range) {
    for (std::int32_t s = range.begin(); s < range.end(); ++s) body(s);
  });
}

enum class Relation : std::uint8_t { apart, crossing, contained };

/// Where the radical plane of a pair stands, seen from one of the two.
struct PlanePlace {
  double distance;     ///< between the centres [m]
  double height;       ///< signed distance of the plane from the centre [m]
  double heightShift;  ///< what undoing the jitter adds to it [m]
};

/// A film as one of its two cells needs it.
struct FilmSide {
  bool empty = true;
  double area = 0, areaShift = 0, arc = 0, solid = 0;  ///< as in FilmShape

  FilmSide() = default;
  FilmSide(const FilmShape& film, double solidFromHere)
      : empty(film.empty), area(film.area), areaShift(film.areaShift), arc(film.arc), solid(solidFromHere) {}
  FilmShape shape() const { return {empty, area, areaShift, arc, solid, 0}; }
};

}  // namespace

/// The passes of the local engine. Columns over bubbles are by rank, columns over pairs by the slots of
/// OverlapPairs, so that every pass but the last walks through memory; that one numbers pairs by (i, j).
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
  std::vector<std::int32_t> crossings;  ///< number of balls whose sphere crosses the bubble's
  std::vector<Relation> relation;       ///< by slot
  std::vector<PlanePlace> plane;        ///< by slot; undefined for pairs apart
  std::vector<FilmSide> film;           ///< by slot
  std::vector<std::int32_t> firstPair;  ///< by input index: first overlap with this bubble as i
  std::vector<std::int32_t> firstFilm;  ///< by input index: first film with this bubble as i
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
  /// Whether the slot, of the row of input index i, is where an overlapping pair is listed.
  bool isUpper(std::int32_t i, std::int32_t slot) const {
    return relation[slot] != Relation::apart && near.order()[near.candidate()[slot]] > i;
  }

  void load(const std::vector<Vector>& position, const std::vector<double>& trueRadius,
            const std::vector<std::uint64_t>& id);
  void relate();
  void relateRow(std::int32_t s);
  void clipDiscs();
  void clipRow(std::int32_t s, Scratch& local);
  void gatherPlanes(std::int32_t s, Scratch& local) const;
  void measureCells(FoamTopology& out) const;
  void measureCell(std::int32_t s, FoamTopology& out) const;
  void listPairs(FoamTopology& out);
  void listRow(std::int32_t i, FoamTopology& out) const;
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

/// Finds which candidates overlap now and where their planes are, and which balls lie inside another (model,
/// "Foam geometry"): those are hidden.
void PowerCells::Internals::relate() {
  const std::size_t slots = near.candidate().size();
  relation.resize(slots), plane.resize(slots), film.resize(slots);
  forEachBubble(size(), [&](std::int32_t s) { relateRow(s); });
}

void PowerCells::Internals::relateRow(std::int32_t s) {
  hidden[s] = 0;
  crossings[s] = 0;
  for (std::int32_t slot = rowBegin(s); slot < rowEnd(s); ++slot) {
    const std::int32_t t = near.candidate()[slot];
    const double d = (centre[t] - centre[s]).norm(), gap = ball[t].radius - ball[s].radius;
    relation[slot] = d >= ball[s].radius + ball[t].radius ? Relation::apart
                     : d > std::abs(gap)                  ? Relation::crossing
                                                          : Relation::contained;
    plane[slot] = {d, radicalHeight(ball[s], ball[t], d), radicalHeightShift(ball[s], ball[t], d)};
    film[slot].empty = true;
    crossings[s] += relation[slot] == Relation::crossing;
    if (relation[slot] == Relation::contained)
      hidden[s] |= gap > 0 || (gap == 0 && near.order()[t] < near.order()[s]);
  }
}

void PowerCells::Internals::clipDiscs() {
  tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, size(), kBubbleGrain), [&](const auto& range) {
    Scratch& local = scratch.local();
    for (std::int32_t s = range.begin(); s < range.end(); ++s)
      if (!hidden[s]) clipRow(s, local);
  });
}

/// Clips the discs that ball s owns, each by all planes that cut the ball.
void PowerCells::Internals::clipRow(std::int32_t s, Scratch& local) {
  local.slot.clear();
  bool ownsAny = false;
  for (std::int32_t slot = rowBegin(s); slot < rowEnd(s); ++slot)
    if (cuts(slot)) {
      local.slot.push_back(slot);
      ownsAny |= owns(s, near.candidate()[slot]);
    }
  if (!ownsAny) return;
  gatherPlanes(s, local);
  for (std::size_t k = 0; k < local.planes.count; ++k) {
    const std::int32_t slot = local.slot[k], t = near.candidate()[slot], there = near.mirror()[slot];
    if (!owns(s, t)) continue;
    const FilmShape shape = local.clipper.clip(
        local.planes, k, {ball[s].radius, ball[s].radiusShift, ball[t].radius, plane[there].height});
    film[slot] = {shape, shape.solidNear}, film[there] = {shape, shape.solidFar};
  }
}

void PowerCells::Internals::gatherPlanes(std::int32_t s, Scratch& local) const {
  CuttingPlanes& planes = local.planes;
  planes.resize(local.slot.size());
  for (std::size_t k = 0; k < planes.count; ++k) {
    const std::int32_t slot = local.slot[k];
    const Vector normal = (centre[near.candidate()[slot]] - centre[s]) / plane[slot].distance;
    planes.nx[k] = normal.x(), planes.ny[k] = normal.y(), planes.nz[k] = normal.z();
    planes.height[k] = plane[slot].height, planes.heightShift[k] = plane[slot].heightShift;
  }
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
    const PlanePlace& place = plane[slot];
    sums.addPlane(place.height);
    if (!film[slot].empty)
      sums.addFilm(film[slot].shape(), place.height, place.heightShift, film[slot].solid);
  }
  const std::int32_t i = near.order()[s];
  out.hidden[i] = hidden[s] || sums.hidden();
  out.volume[i] = out.hidden[i] ? 0 : sums.volume();
  out.freeArea[i] = out.hidden[i] ? 0 : sums.freeArea();
  out.filmArea[i] = sums.filmArea();
}

/// Numbers overlapping pairs and films by (i, j) and writes them out.
void PowerCells::Internals::listPairs(FoamTopology& out) {
  firstPair.assign(static_cast<std::size_t>(size()) + 1, 0), firstFilm = firstPair;
  forEachBubble(size(), [&](std::int32_t i) {
    const std::int32_t s = near.rank()[i];
    std::int32_t pairs = 0, films = 0;
    for (std::int32_t slot = rowBegin(s); slot < rowEnd(s); ++slot)
      if (isUpper(i, slot)) ++pairs, films += !film[slot].empty;
    firstPair[i + 1] = pairs, firstFilm[i + 1] = films;
  });
  for (std::int32_t i = 0; i < size(); ++i)
    firstPair[i + 1] += firstPair[i], firstFilm[i + 1] += firstFilm[i];
  out.overlaps.resize(firstPair.back()), out.films.resize(firstFilm.back());
  forEachBubble(size(), [&](std::int32_t i) { listRow(i, out); });
}

void PowerCells::Internals::listRow(std::int32_t i, FoamTopology& out) const {
  std::int32_t nextPair = firstPair[i], nextFilm = firstFilm[i];
  const std::int32_t s = near.rank()[i];
  for (std::int32_t slot = rowBegin(s); slot < rowEnd(s); ++slot) {
    if (!isUpper(i, slot)) continue;
    const std::int32_t j = near.order()[near.candidate()[slot]];
    const PlanePlace& place = plane[slot];
    out.overlaps[nextPair++] = {i, j, place.distance, film[slot].empty ? -1 : nextFilm};
    if (!film[slot].empty)
      out.films[nextFilm++] = {i, j, place.distance, place.height + place.heightShift,
                               film[slot].shape().trueArea()};
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
  internals_->measureCells(out);
  internals_->listPairs(out);
}

}  // namespace spume::foam
