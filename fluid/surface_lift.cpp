#include "fluid/surface_lift.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "fluid/level_set.h"
#include "fluid/marker_sampling.h"

namespace spume::fluid {
namespace {

/// Passes in which the liquid that comes up spreads over the surface: by about 1.3 cells in all.
constexpr int kPasses = 8;
/// Largest lift of a sub-step [dx]. What is left is up to volume control.
constexpr float kHighest = 0.5f;
/// Lifts below this are left to volume control [dx], and those below a tenth of the least radius of a marker
/// leave the markers where they are.
constexpr float kLeast = 0.004f, kLeastMove = 0.01f;
/// How far from the surface phi and markers move along [cells]: the markers' band and a cell.
constexpr int kReach = 4;
/// Steps of at most a cell on the way to the surface.
constexpr int kMostSteps = 2 * kLevelSetBand;
/// phi has no direction below this slope, a crest between two surfaces.
constexpr float kLeastSlope = 0.3f;
/// Share of each of 26 neighbours in a pass.
constexpr float kShare = 1.0f / 27;

template <typename Visit>
void forEachNeighbour(const Eigen::Vector3i& c, const Visit& visit) {
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k)
        if (i != 0 || j != 0 || k != 0) visit(Eigen::Vector3i(c + Eigen::Vector3i(i, j, k)));
}

}  // namespace

/// Liquid cells whose middle is within a cell of the surface: one for each dx^2 of it, whatever its slope.
bool SurfaceLift::isSurface(const Eigen::Vector3i& c) const {
  const float value = (*phi_)(c);
  return value < 0 && value >= -static_cast<float>(grid_.dx) && solids_->cellFraction(c) > 0;
}

/// The surface cell above a cell, up the slope of phi; the last one reached if the way ends before.
Eigen::Vector3i SurfaceLift::comesUpAt(const Eigen::Vector3i& start) const {
  const FieldView view(*phi_);
  const float dx = static_cast<float>(grid_.dx);
  const Eigen::Vector3f top = grid_.cells.cast<float>();
  Eigen::Vector3i cell = start;
  Eigen::Vector3f x = start.cast<float>() + Eigen::Vector3f::Constant(0.5f);
  for (int n = 0; n < kMostSteps && !isSurface(cell); ++n) {
    const ValueAndGradient f = sampleOnSide(*phi_, view, solids_->sides, cell, x);
    const Eigen::Vector3f slope = Eigen::Vector3f(f.gx, f.gy, f.gz) / dx;
    if (slope.norm() < kLeastSlope) break;
    const float way = std::clamp(-f.value / dx - 0.5f, -1.0f, 1.0f);
    const Eigen::Vector3f to = (x + way * slope.normalized()).cwiseMax(0).cwiseMin(top);
    const Walk walk = walkThroughFaces(*solids_, cell, x, to);
    cell = walk.cell;
    x = walk.at;
  }
  return cell;
}

bool SurfaceLift::addSpot(const Eigen::Vector3i& c, float lift) {
  std::int32_t& spot = spotAt_(c);
  if (spot >= 0) return false;
  spot = static_cast<std::int32_t>(spots_.size());
  spots_.push_back({c, lift});
  return true;
}

/// Lists the surface cells at which crowded liquid comes up, each with its volume.
void SurfaceLift::bringUp(const std::vector<CrowdedCell>& crowded) {
  places_.resize(crowded.size());
  tbb::parallel_for(std::size_t{0}, crowded.size(),
                    [&](std::size_t n) { places_[n] = comesUpAt(crowded[n].cell); });
  for (std::size_t n = 0; n < crowded.size(); ++n) {
    if (!isSurface(places_[n])) continue;
    if (!addSpot(places_[n], crowded[n].volume)) spots_[spotAt_(places_[n])].lift += crowded[n].volume;
  }
}

/// Adds the surface cells around, as far as liquid spreads.
void SurfaceLift::widen() {
  std::size_t begin = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::size_t end = spots_.size();
    for (; begin < end; ++begin) {
      const Eigen::Vector3i cell = spots_[begin].cell;
      forEachNeighbour(cell, [&](const Eigen::Vector3i& n) {
        if (phi_->contains(n.x(), n.y(), n.z()) && isSurface(n) && solids_->sides.sees(cell, n))
          addSpot(n, 0);
      });
    }
  }
}

/// Spreads the volumes over the surface, without loss, and keeps what is worth a move.
void SurfaceLift::spread() {
  links_.resize(spots_.size());
  tbb::parallel_for(std::size_t{0}, spots_.size(), [&](std::size_t n) {
    links_[n].count = 0;
    const Eigen::Vector3i cell = spots_[n].cell;
    forEachNeighbour(cell, [&](const Eigen::Vector3i& c) {
      const std::int32_t other = spotAt_(c);
      if (other >= 0 && solids_->sides.sees(cell, c) && solids_->sides.sees(c, cell))
        links_[n].spot[links_[n].count++] = other;
    });
  });
  spreadTo_.resize(spots_.size());
  for (int pass = 0; pass < kPasses; ++pass) {
    tbb::parallel_for(std::size_t{0}, spots_.size(), [&](std::size_t n) {
      float sum = 0;
      for (int m = 0; m < links_[n].count; ++m) sum += spots_[links_[n].spot[m]].lift - spots_[n].lift;
      spreadTo_[n] = spots_[n].lift + kShare * sum;
    });
    for (std::size_t n = 0; n < spots_.size(); ++n) spots_[n].lift = spreadTo_[n];
  }
  std::size_t kept = 0;
  for (const Spot& spot : spots_) {
    const bool moves = std::abs(spot.lift) >= kLeast;
    spotAt_(spot.cell) = moves ? static_cast<std::int32_t>(kept) : -1;
    if (moves) spots_[kept++] = {spot.cell, std::clamp(spot.lift, -kHighest, kHighest)};
  }
  spots_.resize(kept);
}

/// Whether the way from a cell to its neighbour leads away from the surface, on either side.
bool SurfaceLift::leadsAway(const Eigen::Vector3i& c, const Eigen::Vector3i& n) const {
  const float dx = static_cast<float>(grid_.dx), from = (*phi_)(c), to = (*phi_)(n);
  if (std::abs(to) >= (kReach + 1) * dx || isSurface(n)) return false;
  const bool outward = from >= -dx && to >= std::max(0.0f, from + kLeastSlope * dx);
  const bool inward = from < 0 && to < from - kLeastSlope * dx;
  return outward || inward;
}

/// Continues the lift on both sides of the surface, layer by layer through open faces.
void SurfaceLift::deepen() {
  std::size_t begin = 0;
  for (int layer = 0; layer < kReach; ++layer) {
    const std::size_t end = spots_.size();
    const auto forEachOpen = [&](const Eigen::Vector3i& c, const auto& visit) {
      for (int a = 0; a < 3; ++a)
        for (const int side : {0, 1}) {
          const Eigen::Vector3i face = c + side * Eigen::Vector3i::Unit(a);
          if (solids_->open[a](face) > 0)
            visit(Eigen::Vector3i(c + (2 * side - 1) * Eigen::Vector3i::Unit(a)));
        }
    };
    for (; begin < end; ++begin) {
      const Eigen::Vector3i cell = spots_[begin].cell;
      forEachOpen(cell, [&](const Eigen::Vector3i& n) {
        if (phi_->contains(n.x(), n.y(), n.z()) && leadsAway(cell, n)) addSpot(n, 0);
      });
    }
    tbb::parallel_for(end, spots_.size(), [&](std::size_t n) {
      float sum = 0;
      int known = 0;
      forEachOpen(spots_[n].cell, [&](const Eigen::Vector3i& c) {
        const std::int32_t spot = spotAt_(c);
        if (spot < 0 || spot >= static_cast<std::int32_t>(end)) return;
        sum += spots_[spot].lift;
        ++known;
      });
      spots_[n].lift = sum / static_cast<float>(known);
    });
  }
}

/// Moves every marker by the lift of its cell along the normal.
void SurfaceLift::moveMarkers(MarkerSet& markers) const {
  const FieldView view(*phi_);
  const float dx = static_cast<float>(grid_.dx);
  const Eigen::Vector3f top = grid_.cells.cast<float>();
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    MarkerCells cells;
    findMarkerCells(spotAt_, markers, first, last, cells);
    for (std::size_t n = first; n < last; ++n) {
      const std::int32_t spot = spotAt_.data()[cells[n - first]];
      if (spot < 0 || std::abs(spots_[spot].lift) < kLeastMove) continue;
      const Eigen::Vector3i& cell = spots_[spot].cell;
      const Eigen::Vector3f x(markers.x[n], markers.y[n], markers.z[n]);
      const ValueAndGradient f = sampleOnSide(*phi_, view, solids_->sides, cell, x);
      const Eigen::Vector3f slope = Eigen::Vector3f(f.gx, f.gy, f.gz) / dx;
      if (slope.norm() < kLeastSlope) continue;
      const Eigen::Vector3f to = (x + spots_[spot].lift * slope.normalized()).cwiseMax(0).cwiseMin(top);
      const bool stays = (to.array() >= cell.array().cast<float>()).all() &&
                         (to.array() < (cell.array() + 1).cast<float>()).all();
      const Eigen::Vector3f at = stays ? to : walkThroughFaces(*solids_, cell, x, to).at;
      markers.x[n] = at.x(), markers.y[n] = at.y(), markers.z[n] = at.z();
    }
  });
}

void SurfaceLift::apply(const std::vector<CrowdedCell>& crowded, const SolidBoundary& solids,
                        DenseField<float>& phi, MarkerSet& positive, MarkerSet& negative) {
  if (crowded.empty()) return;
  phi_ = &phi;
  solids_ = &solids;
  bringUp(crowded);
  widen();
  spread();
  deepen();
  moveMarkers(positive);
  moveMarkers(negative);
  const float dx = static_cast<float>(grid_.dx);
  for (const Spot& spot : spots_) {
    phi(spot.cell) -= dx * spot.lift;
    spotAt_(spot.cell) = -1;
  }
  spots_.clear();
  fillGhostLayers(phi);
}

}  // namespace spume::fluid
