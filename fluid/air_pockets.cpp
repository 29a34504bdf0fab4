#include "fluid/air_pockets.h"

#include <algorithm>
#include <numeric>

#include "fluid/disjoint_sets.h"
#include "fluid/level_set.h"
#include "fluid/liquid_measures.h"

namespace spume::fluid {
namespace {

/// Thickness below which liquid between two bodies of air is a film the grid cannot hold [dx].
constexpr float kThinnestFilm = 1;

bool isSmall(const AirPocket& pocket) {
  return pocket.cells.size() <= static_cast<std::size_t>(kLargestFilledPocket);
}

/// Level to give a filled cell: the mean of its liquid neighbours', or one cell deep if all belong to the
/// pocket [m].
float levelOfNeighbours(const GridSpec& grid, const WallSides& sides, const DenseField<float>& phi,
                        const Eigen::Vector3i& c) {
  double sum = 0;
  int count = 0;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      const Eigen::Vector3i n = c + side * Eigen::Vector3i::Unit(a);
      if (!phi.contains(n.x(), n.y(), n.z()) || phi(n) >= 0 || !sides.sees(c, n)) continue;
      sum += phi(n);
      ++count;
    }
  return static_cast<float>(count > 0 ? sum / count : -grid.dx);
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
  const std::vector<Eigen::Vector3i>& cells = pocket.pocket.cells;
  const double before = liquidAround(grid, boundary, cells, phi);
  for (const Eigen::Vector3i& c : cells) {
    pocket.velocity += cellVelocity(velocity, c) / static_cast<double>(cells.size());
    phi(c) = levelOfNeighbours(grid, boundary.sides, phi, c);
  }
  pocket.pocket.gas = std::max(0.0, liquidAround(grid, boundary, cells, phi) - before);
}

/// Air of a liquid cell that the surface cuts belongs to its neighbour highest above the surface.
bool ownsAirOf(const WallSides& sides, const DenseField<float>& phi, const Eigen::Vector3i& owner,
               const Eigen::Vector3i& liquid) {
  Eigen::Vector3i best = liquid;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      const Eigen::Vector3i n = liquid + side * Eigen::Vector3i::Unit(a);
      const bool air = phi.contains(n.x(), n.y(), n.z()) && phi(n) >= 0 && sides.sees(liquid, n);
      if (air && phi(n) > phi(best)) best = n;
    }
  return best == owner;
}

}  // namespace

void AirPockets::find(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& boundary,
                      std::span<const Eigen::Vector3i> vents) {
  const int components = connected_.label(
      grid.cells, [&](int i, int j, int k) { return phi(i, j, k) >= 0 && boundary.hasOpenFace(i, j, k); },
      [&](int axis, int i, int j, int k) { return boundary.open[axis](i, j, k) > 0; }, label_);
  joinAcrossFilms(grid, phi, boundary, components);
  count_.assign(components, 0);
  connected_.forEachRun(
      grid.cells, [&](std::int32_t n, int, int, int begin, int end) { count_[joined_[n]] += end - begin; });
  findOutside(grid, boundary, vents);
  collect(grid);
  for (AirPocket& pocket : pockets_) measure(grid, phi, boundary, pocket);
}

/// Bodies of air that meet at one thin liquid cell count as one: the film between them has burst. Held apart
/// they would press on it with their difference over a small part of a cell, and blow it away at any speed.
void AirPockets::joinAcrossFilms(const GridSpec& grid, const DenseField<float>& phi,
                                 const SolidBoundary& boundary, int components) {
  joined_.resize(components);
  std::iota(joined_.begin(), joined_.end(), 0);
  if (components < 2) return;
  const float deepest = -0.5f * kThinnestFilm * static_cast<float>(grid.dx);
  links_.resize(grid.cells.x());
  tbb::parallel_for(0, grid.cells.x(), [&](int i) {
    links_[i].clear();
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k)
        if (phi(i, j, k) < 0 && phi(i, j, k) > deepest) linkAirBeside(boundary, {i, j, k}, links_[i]);
  });
  DisjointSets sets(components);
  for (const Links& links : links_)
    for (const auto& [a, b] : links) sets.unite(a, b);
  for (std::int32_t n = 0; n < components; ++n) joined_[n] = static_cast<std::int32_t>(sets.of(n));
}

/// Appends the pairs of components that a liquid cell touches, each with the first it finds.
void AirPockets::linkAirBeside(const SolidBoundary& boundary, const Eigen::Vector3i& c, Links& links) const {
  std::int32_t first = -1;
  for (int a = 0; a < 3; ++a)
    for (int side : {-1, 1}) {
      const Eigen::Vector3i step = Eigen::Vector3i::Unit(a), n = c + side * step;
      const std::int32_t other = label_(n);
      if (other < 0 || other == first || !(boundary.open[a](side > 0 ? n : c) > 0)) continue;
      if (first < 0)
        first = other;
      else
        links.emplace_back(first, other);
    }
}

void AirPockets::findOutside(const GridSpec& grid, const SolidBoundary& boundary,
                             std::span<const Eigen::Vector3i> vents) {
  outside_.assign(count_.size(), 0);
  bool sealed = true;
  for (const Eigen::Vector3i& c : vents)
    if (label_(c) >= 0) outside_[joined_[label_(c)]] = 1;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, d = (a + 2) % 3;
    Eigen::Vector3i c, face;
    for (const bool high : {false, true}) {
      if (boundary.walls.closed[2 * a + high]) continue;
      for (c[b] = 0; c[b] < grid.cells[b]; ++c[b])
        for (c[d] = 0; c[d] < grid.cells[d]; ++c[d]) {
          c[a] = high ? grid.cells[a] - 1 : 0;
          face = high ? c + Eigen::Vector3i::Unit(a) : c;
          if (label_(c) < 0 || !(boundary.open[a](face) > 0)) continue;
          outside_[joined_[label_(c)]] = 1;
          sealed = false;
        }
    }
  }
  if (sealed && !count_.empty())
    outside_[std::max_element(count_.begin(), count_.end()) - count_.begin()] = 1;
}

/// Makes the pockets from the components that are not outside, and numbers the labels anew.
void AirPockets::collect(const GridSpec& grid) {
  pockets_.clear();
  std::vector<std::int32_t> number(count_.size(), -1);
  for (std::size_t n = 0; n < count_.size(); ++n) {
    if (outside_[joined_[n]]) continue;
    if (joined_[n] != static_cast<std::int32_t>(n)) {
      number[n] = number[joined_[n]];
      continue;
    }
    number[n] = static_cast<std::int32_t>(pockets_.size());
    pockets_.emplace_back().cells.reserve(count_[n]);
  }
  connected_.forEachRun(grid.cells, [&](std::int32_t n, int i, int j, int begin, int end) {
    std::fill(&label_(i, j, begin), &label_(i, j, begin) + (end - begin), number[n]);
    if (number[n] < 0) return;
    for (int k = begin; k < end; ++k) pockets_[number[n]].cells.emplace_back(i, j, k);
  });
}

void AirPockets::measure(const GridSpec& grid, const DenseField<float>& phi, const SolidBoundary& boundary,
                         AirPocket& pocket) const {
  const float dx = static_cast<float>(grid.dx);
  const auto air = [&](const Eigen::Vector3i& c) {
    return (1 - liquidFractionOfCell(phi, dx, c.x(), c.y(), c.z())) * boundary.cellFraction(c);
  };
  for (const Eigen::Vector3i& c : pocket.cells) {
    pocket.gas += air(c);
    pocket.centroid += grid.cellCentre(c.x(), c.y(), c.z());
    for (int a = 0; a < 3; ++a)
      for (int side : {-1, 1}) {
        const Eigen::Vector3i n = c + side * Eigen::Vector3i::Unit(a);
        const bool liquid = phi.contains(n.x(), n.y(), n.z()) && phi(n) < 0;
        if (liquid && ownsAirOf(boundary.sides, phi, c, n)) pocket.gas += air(n);
      }
  }
  pocket.gas *= grid.cellVolume();
  pocket.centroid /= static_cast<double>(pocket.cells.size());
}

std::vector<FilledPocket> AirPockets::fillSmall(const GridSpec& grid, const SolidBoundary& boundary,
                                                const MacVelocity& velocity, DenseField<float>& phi) {
  std::vector<FilledPocket> filled;
  for (const AirPocket& pocket : pockets_)
    if (isSmall(pocket)) filled.push_back({pocket, Eigen::Vector3d::Zero()});
  for (FilledPocket& pocket : filled) fill(grid, boundary, velocity, pocket, phi);
  if (!filled.empty()) dropSmall();
  return filled;
}

void AirPockets::dropSmall() {
  std::size_t kept = 0;
  for (std::size_t n = 0; n < pockets_.size(); ++n) {
    const std::int32_t number = isSmall(pockets_[n]) ? -1 : static_cast<std::int32_t>(kept);
    for (const Eigen::Vector3i& c : pockets_[n].cells) label_(c) = number;
    if (number < 0) continue;
    if (kept != n) pockets_[kept] = std::move(pockets_[n]);
    ++kept;
  }
  pockets_.resize(kept);
}

}  // namespace spume::fluid
