#include "fluid/specks.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <utility>

#include "fluid/liquid_measures.h"
#include "fluid/marker_sampling.h"

namespace spume::fluid {
namespace {

constexpr std::ptrdiff_t kLargestSpeck = 3;  // [cells]
constexpr float kBarelyWet = 0.1f;           // depth of the cells' centres at most [cells]
constexpr float kDry = 1;  // phi left behind [cells]: no part of such a cell counts as liquid

using SpeckCells = std::vector<std::pair<std::int32_t, Eigen::Vector3i>>;  // body and cell

/// The cells of all bodies that are small enough, by body.
SpeckCells cellsOfSmallBodies(const LiquidBodies& bodies) {
  SpeckCells cells;
  bodies.forEachRun([&](std::int32_t body, int i, int j, int begin, int end) {
    if (bodies.bodies[body].cells > kLargestSpeck) return;
    for (int k = begin; k < end; ++k) cells.emplace_back(body, Eigen::Vector3i(i, j, k));
  });
  std::stable_sort(cells.begin(), cells.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return cells;
}

/// Clears the flag of every body that a marker lies in.
void keepThoseWithMarkers(const LiquidBodies& bodies, const MarkerSet& negative,
                          std::vector<std::uint8_t>& isSpeck) {
  const std::int32_t* label = bodies.label.data();
  forEachMarkerChunk(negative.size(), [&](std::size_t first, std::size_t last) {
    MarkerCells cells;
    findMarkerCells(bodies.label, negative, first, last, cells);
    for (std::size_t m = 0; m < last - first; ++m) {
      const std::int32_t body = label[cells[m]];
      if (body < 0) continue;
      // Only ever cleared: any order gives the same.
      const std::atomic_ref<std::uint8_t> speck(isSpeck[body]);
      if (speck.load(std::memory_order_relaxed)) speck.store(0, std::memory_order_relaxed);
    }
  });
}

}  // namespace

std::vector<Drop> releaseSpecks(const GridSpec& grid, const LiquidBodies& bodies, const MacVelocity& velocity,
                                const MarkerSet& negative, DenseField<float>& phi) {
  const auto isSmall = [](const LiquidBody& body) { return body.cells <= kLargestSpeck; };
  if (std::none_of(bodies.bodies.begin(), bodies.bodies.end(), isSmall)) return {};
  const SpeckCells cells = cellsOfSmallBodies(bodies);
  std::vector<std::uint8_t> isSpeck(bodies.bodies.size(), 0);
  for (const auto& [body, cell] : cells) isSpeck[body] = 1;
  const float depth = kBarelyWet * static_cast<float>(grid.dx);
  for (const auto& [body, cell] : cells)
    if (phi(cell) < -depth) isSpeck[body] = 0;
  if (std::none_of(isSpeck.begin(), isSpeck.end(), [](auto flag) { return flag != 0; })) return {};
  keepThoseWithMarkers(bodies, negative, isSpeck);

  std::vector<Drop> drops;
  std::int32_t last = -1;
  for (const auto& [body, cell] : cells) {
    if (!isSpeck[body]) continue;
    const LiquidBody& whole = bodies.bodies[body];
    if (body != last) drops.push_back({whole.centroid, Eigen::Vector3d::Zero(), whole.volume});
    drops.back().velocity += cellVelocity(velocity, cell) / static_cast<double>(whole.cells);
    phi(cell) = kDry * static_cast<float>(grid.dx);
    last = body;
  }
  return drops;
}

}  // namespace spume::fluid
