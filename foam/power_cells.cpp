#include "foam/power_cells.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "foam/disc_clipper.h"
#include "foam/errors.h"
#include "foam/overlap_pairs.h"
#include "foam/tie_breaker.h"

namespace spume::foam {

namespace {

using Vector = Eigen::Vector3d;

constexpr std::int32_t kGrain = 256;  ///< bubbles per parallel task
constexpr double kRoundOffAngle =
    1e-12;  ///< solid angles below this are zero: rounding of a sum of up to 1000 films
/// Largest relative shift of a plane for which undoing the jitter is a small change: the error of first order
/// is its square. Only nearly coincident centres exceed it; there the jitter decides, as for any tie.
constexpr double kMaxRelativeShift = 1e-5;

template <typename Body>
void forEachBubble(std::int32_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::int32_t>(0, count, kGrain), [&](const auto& range) {
    for (std::int32_t s = range.begin(); s < range.end(); ++s) body(s);
  });
}

enum class Relation : std::uint8_t { apart, crossing, contained };

void validate(const std::vector<Vector>& position, const std::vector<double>& radius,
              const std::vector<std::uint64_t>& id) {
  if (radius.size() != position.size() || id.size() != position.size())
    throw InvalidParameter("PowerCells: " + std::to_string(position.size()) + " positions, " +
                           std::to_string(radius.size()) + " radii and " + std::to_string(id.size()) +
                           " ids; give as many of each");
  for (std::size_t i = 0; i < radius.size(); ++i)
    if (!(radius[i] > 0) || !std::isfinite(radius[i]) || !position[i].allFinite())
      throw InvalidParameter("PowerCells: bubble " + std::to_string(id[i]) + " has radius " +
                             std::to_string(radius[i]) + " m; it must be positive, and the position finite");
}

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
  std::vector<double> radius, radiusShift;  ///< with jitter; what undoing it adds [m]
  std::vector<double> weightShift;          ///< what undoing the jitter adds to r^2 [m^2]
  std::vector<std::uint8_t> hidden;
  std::vector<std::int32_t> crossings;   ///< number of balls whose sphere crosses the bubble's
  std::vector<Relation> relation;        ///< by slot
  std::vector<double> distance;          ///< by slot [m]
  std::vector<std::int32_t> pairOfSlot;  ///< by slot, -1 if apart
  std::vector<std::int32_t> firstPair;   ///< by input index: first overlap with this bubble as i
  std::vector<ClippedDisc> disc;         ///< by pair; near side = owner
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
  /// Signed distance of the radical plane from the centre of s, t being d away [m].
  double heightOf(std::int32_t s, std::int32_t t, double d) const {
    return (d + (radius[s] - radius[t]) * ((radius[s] + radius[t]) / d)) / 2;
  }
  /// What undoing the jitter adds to that height [m].
  double heightShiftOf(std::int32_t s, std::int32_t t, double d) const {
    const double shift = (weightShift[s] - weightShift[t]) / (2 * d);
    return std::abs(shift) < kMaxRelativeShift * std::min(radius[s], radius[t]) ? shift : 0;
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
  centre.resize(n), radius.resize(n), radiusShift.resize(n), weightShift.resize(n);
  hidden.resize(n), crossings.resize(n);
  forEachBubble(size(), [&](std::int32_t s) {
    const std::int32_t i = near.order()[s];
    centre[s] = position[i];
    radius[s] = tieBrokenRadius(trueRadius[i], id[i]);
    radiusShift[s] = trueRadius[i] - radius[s];
    weightShift[s] = radiusShift[s] * (trueRadius[i] + radius[s]);
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
    const double d = (centre[t] - centre[s]).norm(), gap = radius[t] - radius[s];
    distance[slot] = d;
    relation[slot] = d >= radius[s] + radius[t] ? Relation::apart
                     : d > std::abs(gap)        ? Relation::crossing
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
    disc[pairOfSlot[slot]] =
        local.clipper.clip(planes, k, {radius[s], radiusShift[s], radius[t], heightOf(t, s, distance[slot])});
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
      out.films[film] = {i, overlap.j, overlap.distance, height,
                         std::max(0.0, disc[pair].area + disc[pair].areaShift)};
      overlap.film = film++;
    }
  });
}

void PowerCells::Internals::measureCells(FoamTopology& out) const {
  for (auto* column : {&out.volume, &out.freeArea, &out.filmArea}) column->resize(size());
  out.hidden.resize(size());
  forEachBubble(size(), [&](std::int32_t s) { measureCell(s, out); });
}

/// Sums the films of one cell: S = r^2 (4 pi [all h >= 0] - sum sgn(h) W), V = (sum h A + r S)/3, then undoes
/// the jitter with dV/dw and the change of the rims (model, "Foam geometry").
void PowerCells::Internals::measureCell(std::int32_t s, FoamTopology& out) const {
  const double r = radius[s], dr = radiusShift[s];
  double solid = 0, pyramids = 0, volumeShift = 0, rimHeight = 0, rimShift = 0, films = 0;
  bool centreInside = true, anyFilm = false;
  for (std::int32_t slot = rowBegin(s); slot < rowEnd(s) && !hidden[s]; ++slot) {
    if (!cuts(slot)) continue;
    const std::int32_t t = near.candidate()[slot];
    const double h = heightOf(s, t, distance[slot]), dh = heightShiftOf(s, t, distance[slot]);
    centreInside &= h >= 0;
    const ClippedDisc& face = disc[pairOfSlot[slot]];
    if (face.empty) continue;
    anyFilm = true;
    const double w = owns(s, t) ? face.solidNear : face.solidFar;
    solid += h < 0 ? w : -w;
    pyramids += h * face.area;
    volumeShift += face.area * dh;
    rimHeight += face.arc * h;
    rimShift += face.arc * dh;
    films += std::max(0.0, face.area + face.areaShift);
  }
  solid += centreInside ? 4 * std::numbers::pi : 0;
  if (solid < kRoundOffAngle) solid = 0;
  const std::int32_t i = near.order()[s];
  const double free = hidden[s] ? 0 : r * r * solid;
  const double freeShift = (2 * free / r - rimHeight) * dr + r * rimShift;
  const double volume = (pyramids + r * free) / 3 + volumeShift + free * dr;
  out.hidden[i] = hidden[s] || (!anyFilm && free == 0);
  out.volume[i] = out.hidden[i] ? 0 : std::max(0.0, volume);
  out.freeArea[i] = free > 0 ? std::max(0.0, free + freeShift) : 0;
  out.filmArea[i] = films;
}

PowerCells::PowerCells() : internals_(std::make_unique<Internals>()) {}
PowerCells::~PowerCells() = default;
PowerCells::PowerCells(PowerCells&&) noexcept = default;
PowerCells& PowerCells::operator=(PowerCells&&) noexcept = default;

void PowerCells::compute(const std::vector<Eigen::Vector3d>& position, const std::vector<double>& radius,
                         const std::vector<std::uint64_t>& id, FoamTopology& out) {
  validate(position, radius, id);
  internals_->load(position, radius, id);
  internals_->relate();
  internals_->listOverlaps(out);
  internals_->clipDiscs();
  internals_->listFilms(out);
  internals_->measureCells(out);
}

}  // namespace spume::foam
