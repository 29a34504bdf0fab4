#include "fluid/air_pockets.h"

#include <algorithm>

#include "fluid/level_set.h"

namespace spume::fluid {
namespace {

bool reachesOutside(const SolidBoundary& boundary, const Eigen::Vector3i& cells, const Eigen::Vector3i& c) {
  for (int a = 0; a < 3; ++a) {
    if (c[a] == 0 && boundary.open[a](c) > 0) return true;
    if (c[a] + 1 == cells[a] && boundary.open[a](c + Eigen::Vector3i::Unit(a)) > 0) return true;
  }
  return false;
}

/// Level to give a filled cell: the mean of its liquid neighbours', or one cell deep if all belong to the
/// pocket [m].
float levelOfNeighbours(const GridSpec& grid, const DenseField<float>& phi, const Eigen::Vector3i& c) {
  double sum = 0;
  int count = 0;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      const Eigen::Vector3i n = c + side * Eigen::Vector3i::Unit(a);
      if (!phi.contains(n.x(), n.y(), n.z()) || phi(n) >= 0) continue;
      sum += phi(n);
      ++count;
    }
  return static_cast<float>(count > 0 ? sum / count : -grid.dx);
}

Eigen::Vector3d cellVelocity(const MacVelocity& velocity, const Eigen::Vector3i& c) {
  Eigen::Vector3d u;
  for (int a = 0; a < 3; ++a) u[a] = 0.5 * (velocity[a](c) + velocity[a](c + Eigen::Vector3i::Unit(a)));
  return u;
}

/// Liquid in the cells within one of the pocket's, each counted once [m^3].
double liquidAround(const GridSpec& grid, const SolidBoundary& boundary,
                    const std::vector<Eigen::Vector3i>& cells, const DenseField<float>& phi) {
  const auto near = [&](const Eigen::Vector3i& c) {
    return std::any_of(cells.begin(), cells.end(),
                       [&](const auto& p) { return (p - c).cwiseAbs().maxCoeff() <= 1; });
  };
  Eigen::Vector3i low = cells.front(), high = cells.front();
  for (const Eigen::Vector3i& c : cells) low = low.cwiseMin(c), high = high.cwiseMax(c);
  low = (low.array() - 1).max(0);
  high = (high.array() + 1).min(grid.cells.array() - 1);
  double sum = 0;
  for (int i = low.x(); i <= high.x(); ++i)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int k = low.z(); k <= high.z(); ++k)
        if (near({i, j, k}))
          sum += liquidFractionOfCell(phi, static_cast<float>(grid.dx), i, j, k) *
                 boundary.cellFraction(i, j, k);
  return sum * grid.cellVolume();
}

/// Fills one pocket; its gas is the volume that turned into liquid.
void fill(const GridSpec& grid, const SolidBoundary& boundary, const MacVelocity& velocity,
          FilledPocket& pocket, DenseField<float>& phi) {
  const double before = liquidAround(grid, boundary, pocket.cells, phi);
  for (const Eigen::Vector3i& c : pocket.cells) {
    pocket.velocity += cellVelocity(velocity, c) / pocket.pocket.cells;
    phi(c) = levelOfNeighbours(grid, phi, c);
  }
  pocket.pocket.gas = std::max(0.0, liquidAround(grid, boundary, pocket.cells, phi) - before);
}

}  // namespace

void AirPockets::find(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& boundary) {
  const int count = connected_.label(
      grid.cells, [&](int i, int j, int k) { return phi(i, j, k) >= 0 && boundary.hasOpenFace(i, j, k); },
      [&](int axis, int i, int j, int k) { return boundary.open[axis](i, j, k) > 0; }, label_);
  pockets_.assign(count, AirPocket{});
  outside_.assign(count, 0);
  forEachMember(grid, [&](std::int32_t n, const Eigen::Vector3i& c) {
    AirPocket& pocket = pockets_[n];
    ++pocket.cells;
    const float wet = liquidFractionOfCell(phi, static_cast<float>(grid.dx), c.x(), c.y(), c.z());
    pocket.gas += (1 - wet) * boundary.cellFraction(c);
    pocket.centroid += grid.cellCentre(c.x(), c.y(), c.z());
    if (reachesOutside(boundary, grid.cells, c)) outside_[n] = 1;
  });
  for (AirPocket& pocket : pockets_) {
    pocket.gas *= grid.cellVolume();
    pocket.centroid /= pocket.cells;
  }
  dropOpenAir(grid);
}

template <typename Body>
void AirPockets::forEachMember(const GridSpec& grid, const Body& body) {
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k)
        if (label_(i, j, k) >= 0) body(label_(i, j, k), Eigen::Vector3i(i, j, k));
}

/// Renumbers the pockets without those that reach the outside.
void AirPockets::dropOpenAir(const GridSpec& grid) {
  std::vector<std::int32_t> number(pockets_.size(), -1);
  std::size_t kept = 0;
  for (std::size_t n = 0; n < pockets_.size(); ++n) {
    if (outside_[n]) continue;
    number[n] = static_cast<std::int32_t>(kept);
    pockets_[kept++] = pockets_[n];
  }
  pockets_.resize(kept);
  forEachMember(grid, [&](std::int32_t n, const Eigen::Vector3i& c) { label_(c) = number[n]; });
}

std::vector<FilledPocket> AirPockets::fillSmall(const GridSpec& grid, const SolidBoundary& boundary,
                                                const MacVelocity& velocity, DenseField<float>& phi) {
  std::vector<FilledPocket> filled;
  std::vector<std::int32_t> number(pockets_.size(), -1);
  const bool sealed = std::find(outside_.begin(), outside_.end(), 1) == outside_.end();
  const auto headspace = std::max_element(pockets_.begin(), pockets_.end(),
                                          [](const auto& a, const auto& b) { return a.cells < b.cells; });
  for (auto pocket = pockets_.begin(); pocket != pockets_.end(); ++pocket) {
    if (pocket->cells > kLargestFilledPocket || (sealed && pocket == headspace)) continue;
    number[pocket - pockets_.begin()] = static_cast<std::int32_t>(filled.size());
    filled.push_back({*pocket, Eigen::Vector3d::Zero(), {}});
  }
  if (filled.empty()) return filled;
  forEachMember(grid, [&](std::int32_t n, const Eigen::Vector3i& c) {
    if (number[n] >= 0) filled[number[n]].cells.push_back(c);
  });
  for (FilledPocket& pocket : filled) fill(grid, boundary, velocity, pocket, phi);
  return filled;
}

}  // namespace spume::fluid
