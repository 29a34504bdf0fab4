#include "fluid/marker_correction.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fluid/level_set.h"
#include "fluid/marker_sampling.h"

namespace spume::fluid {
namespace {

/// Flags the markers on the wrong side by more than their radius.
void flagEscaped(float dx, const DenseField<float>& phi, MarkerSign sign, MarkerSet& markers) {
  const FieldView field(phi);
  const float toCells = static_cast<float>(static_cast<int>(sign)) / dx;
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    MarkerValues values;
    sampleAtMarkers(field, markers, first, last, values);
    flagEscapedMarkers(values, toCells, first, last, markers);
  });
}

/// Flags looked at together: nearly all markers are on their side.
constexpr std::size_t kWord = 8;

bool noneEscaped(const std::uint8_t* flags) {
  std::uint64_t word;
  std::memcpy(&word, flags, sizeof word);
  return word == 0;
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

void MarkerCorrection::offerSphere(float dx, MarkerSign sign, float x, float y, float z, float radius,
                                   const DenseField<float>& phi) {
  const float low[3] = {std::floor(x), std::floor(y), std::floor(z)};
  const int base[3] = {static_cast<int>(low[0]), static_cast<int>(low[1]), static_cast<int>(low[2])};
  for (int c = 0; c < 8; ++c) {
    const int di = c >> 2, dj = (c >> 1) & 1, dk = c & 1;
    if (!phi.contains(base[0] + di, base[1] + dj, base[2] + dk)) continue;
    const float rx = low[0] + static_cast<float>(di) - x, ry = low[1] + static_cast<float>(dj) - y,
                rz = low[2] + static_cast<float>(dk) - z;
    const float sphere = dx * (radius - std::sqrt(rx * rx + ry * ry + rz * rz));
    const auto cell = static_cast<std::int32_t>(phi.index(base[0] + di, base[1] + dj, base[2] + dk));
    Offer& offer = offerAt(cell, phi.data()[cell]);
    if (sign == MarkerSign::positive)
      offer.plus = std::max(offer.plus, sphere);
    else
      offer.minus = std::min(offer.minus, -sphere);
  }
}

void MarkerCorrection::collect(float dx, MarkerSign sign, const MarkerSet& markers,
                               const DenseField<float>& phi) {
  const std::size_t count = markers.size();
  for (std::size_t word = 0; word < count; word += kWord) {
    const std::size_t end = std::min(count, word + kWord);
    if (end - word == kWord && noneEscaped(markers.escaped.data() + word)) continue;
    for (std::size_t n = word; n < end; ++n) {
      if (!markers.escaped[n]) continue;
      ++escapedCount_;
      offerSphere(dx, sign, markers.x[n] - 0.5f, markers.y[n] - 0.5f, markers.z[n] - 0.5f, markers.radius[n],
                  phi);
    }
  }
}

void MarkerCorrection::apply(float dx, MarkerSet& positive, MarkerSet& negative, DenseField<float>& phi) {
  if (slot_.size() != static_cast<std::size_t>(phi.count())) slot_.assign(phi.count(), -1);
  offers_.clear();
  escapedCount_ = 0;
  flagEscaped(dx, phi, MarkerSign::positive, positive);
  flagEscaped(dx, phi, MarkerSign::negative, negative);
  collect(dx, MarkerSign::positive, positive, phi);
  collect(dx, MarkerSign::negative, negative, phi);
  for (const Offer& offer : offers_) {
    phi.data()[offer.cell] = std::abs(offer.plus) <= std::abs(offer.minus) ? offer.plus : offer.minus;
    slot_[offer.cell] = -1;
  }
  fillGhostLayers(phi);
}

}  // namespace spume::fluid
