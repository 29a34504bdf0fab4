#include "fluid/marker_correction.h"

#include <algorithm>
#include <cmath>

#include "fluid/level_set.h"
#include "fluid/marker_sampling.h"

namespace spume::fluid {
namespace {

/// Flags the markers on the wrong side by more than their radius.
void flagMarkers(float dx, const WallSides& sides, MarkerSign sign, const DenseField<float>& phi,
                 MarkerSet& markers) {
  const float toCells = static_cast<float>(static_cast<int>(sign)) / dx;
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    MarkerValues values;
    sampleAtMarkers(phi, sides, markers, first, last, values);
    flagEscapedMarkers(values, toCells, first, last, markers);
  });
}

}  // namespace

MarkerCorrection::Offer& MarkerCorrection::offerAt(std::int32_t cell, float phi) {
  std::int32_t& slot = slot_[cell];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(offers_.size());
    offers_.push_back({cell, phi, phi});
  }
  return offers_[slot];
}

/// Values of the sphere around (x, y, z) [index units] at the cell centres around it.
void MarkerCorrection::addSphere(float dx, const WallSides& sides, float x, float y, float z, float radius,
                                 const DenseField<float>& phi, std::vector<Value>& values) {
  const Eigen::Vector3i home = Eigen::Vector3f(x + 0.5f, y + 0.5f, z + 0.5f)
                                   .cast<int>()
                                   .cwiseMin(phi.size() - Eigen::Vector3i::Ones());
  const float low[3] = {std::floor(x), std::floor(y), std::floor(z)};
  const int base[3] = {static_cast<int>(low[0]), static_cast<int>(low[1]), static_cast<int>(low[2])};
  for (int c = 0; c < 8; ++c) {
    const int di = c >> 2, dj = (c >> 1) & 1, dk = c & 1;
    const Eigen::Vector3i centre(base[0] + di, base[1] + dj, base[2] + dk);
    if (!phi.contains(centre.x(), centre.y(), centre.z()) || !sides.sees(home, centre)) continue;
    const float rx = low[0] + static_cast<float>(di) - x, ry = low[1] + static_cast<float>(dj) - y,
                rz = low[2] + static_cast<float>(dk) - z;
    const auto cell = static_cast<std::int32_t>(phi.index(centre.x(), centre.y(), centre.z()));
    values.push_back({cell, dx * (radius - std::sqrt(rx * rx + ry * ry + rz * rz))});
  }
}

/// Lists the values of the spheres of the markers that are flagged as escaped.
void MarkerCorrection::listSpheres(float dx, const WallSides& sides, const DenseField<float>& phi,
                                   const MarkerSet& markers) {
  chunks_.resize((markers.size() + kMarkerChunk - 1) / kMarkerChunk);
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    Chunk& chunk = chunks_[first / kMarkerChunk];
    chunk.escaped = 0;
    chunk.values.clear();
    forEachEscaped(markers, first, last, [&](std::size_t n) {
      ++chunk.escaped;
      addSphere(dx, sides, markers.x[n] - 0.5f, markers.y[n] - 0.5f, markers.z[n] - 0.5f, markers.radius[n],
                phi, chunk.values);
    });
  });
}

/// Keeps the best of the values found last at every cell.
void MarkerCorrection::collect(MarkerSign sign, const DenseField<float>& phi) {
  for (const Chunk& chunk : chunks_) {
    escapedCount_ += chunk.escaped;
    for (const Value& sphere : chunk.values) {
      Offer& offer = offerAt(sphere.cell, phi.data()[sphere.cell]);
      if (sign == MarkerSign::positive)
        offer.plus = std::max(offer.plus, sphere.value);
      else
        offer.minus = std::min(offer.minus, -sphere.value);
    }
  }
}

void MarkerCorrection::apply(float dx, const WallSides& sides, MarkerSet& positive, MarkerSet& negative,
                             DenseField<float>& phi, bool flagsStand) {
  if (slot_.size() != static_cast<std::size_t>(phi.count())) slot_.assign(phi.count(), -1);
  offers_.clear();
  escapedCount_ = 0;
  for (const MarkerSign sign : {MarkerSign::positive, MarkerSign::negative}) {
    MarkerSet& markers = sign == MarkerSign::positive ? positive : negative;
    if (!flagsStand) flagMarkers(dx, sides, sign, phi, markers);
    listSpheres(dx, sides, phi, markers);
    collect(sign, phi);
  }
  for (const Offer& offer : offers_) {
    phi.data()[offer.cell] = std::abs(offer.plus) <= std::abs(offer.minus) ? offer.plus : offer.minus;
    slot_[offer.cell] = -1;
  }
  fillGhostLayers(phi);
}

}  // namespace spume::fluid
