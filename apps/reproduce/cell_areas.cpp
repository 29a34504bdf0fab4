#include "apps/reproduce/cell_areas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/reproduce/disc_cells.h"
#include "foam/volume_newton.h"

namespace spume::apps {
namespace {

/// As in the foam's own correction: the derivatives hold no further, and need be no finer.
constexpr double kLargestGrowth = 0.25, kNewtonTolerance = 1e-3;

}  // namespace

void CellAreas::measure(const std::vector<Overlap>& overlaps, const std::vector<double>& radius) {
  const auto discs = static_cast<std::int32_t>(area_.size());
  cells_.overlaps.clear(), cells_.films.clear(), edge_.clear();
  cells_.volume.resize(area_.size()), cells_.freeArea.resize(area_.size());
  std::vector<CuttingLine> lines;
  DiscCell cell;
  for (std::int32_t i = 0; i < discs; ++i) {
    lines.clear();
    for (std::size_t k = edge_.size(); k < overlaps.size() && overlaps[k].i == i; ++k) {
      const auto& [self, j, apart, d] = overlaps[k];
      const double height = (d + (radius[i] - radius[j]) * (radius[i] + radius[j]) / d) / 2;
      lines.push_back({-apart.head<2>() / d, height});
    }
    cutDisc(radius[i], lines, cell);
    cells_.volume[i] = cell.area, cells_.freeArea[i] = cell.rim;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const Overlap& overlap = overlaps[edge_.size()];
      edge_.push_back(cell.edge[k]);
      if (i > overlap.j || !(cell.edge[k] > 0)) continue;
      const auto film = static_cast<std::int32_t>(cells_.films.size());
      cells_.overlaps.push_back({i, overlap.j, overlap.distance, film});
      cells_.films.push_back({i, overlap.j, overlap.distance, lines[k].height, cell.edge[k]});
    }
  }
}

double CellAreas::worst() const {
  double worst = 0;
  for (std::size_t i = 0; i < area_.size(); ++i)
    worst = std::max(worst, std::abs(cells_.volume[i] / area_[i] - 1));
  return worst;
}

void CellAreas::improve(std::vector<double>& radius) const {
  const std::size_t discs = area_.size();
  const std::vector<double> before(radius.begin(), radius.begin() + static_cast<std::ptrdiff_t>(discs));
  std::vector<double> missing(discs), change;
  for (std::size_t i = 0; i < discs; ++i) missing[i] = area_[i] - cells_.volume[i];
  foam::Neighbours neighbours;
  neighbours.build(discs, cells_.overlaps);
  foam::solveWeightChanges(cells_, neighbours, before, missing, std::vector<char>(discs, 0), kNewtonTolerance,
                           change);
  for (std::size_t i = 0; i < discs; ++i) {
    const double wanted = std::sqrt(std::max(before[i] * before[i] + change[i], 0.0));
    const double least = std::sqrt(area_[i] / std::numbers::pi);
    radius[i] = std::max(least, std::min(wanted, before[i] * (1 + kLargestGrowth)));
  }
}

}  // namespace spume::apps
