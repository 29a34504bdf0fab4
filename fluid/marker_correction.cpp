#include "fluid/marker_correction.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

MarkerCorrection::Offer& MarkerCorrection::offerAt(std::int32_t cell, float phi) {
  std::int32_t& slot = slot_[cell];
  if (slot < 0) {
    slot = static_cast<std::int32_t>(offers_.size());
    offers_.push_back({cell, phi, phi});
  }
  return offers_[slot];
}

void MarkerCorrection::collect(float dx, MarkerSign sign, const MarkerSet& markers,
                               const DenseField<float>& phi) {
  for (std::size_t n = 0; n < markers.size(); ++n) {
    if (!markers.escaped[n]) continue;
    ++escapedCount_;
    const Eigen::Vector3f centre(markers.x[n] - 0.5f, markers.y[n] - 0.5f, markers.z[n] - 0.5f);
    const Eigen::Vector3i base = centre.array().floor().cast<int>();
    for (int c = 0; c < 8; ++c) {
      const Eigen::Vector3i corner = base + Eigen::Vector3i(c >> 2, (c >> 1) & 1, c & 1);
      if (!phi.contains(corner.x(), corner.y(), corner.z())) continue;
      const float sphere = dx * (markers.radius[n] - (corner.cast<float>() - centre).norm());
      const auto cell = static_cast<std::int32_t>(phi.index(corner.x(), corner.y(), corner.z()));
      Offer& offer = offerAt(cell, phi(corner));
      if (sign == MarkerSign::positive)
        offer.plus = std::max(offer.plus, sphere);
      else
        offer.minus = std::min(offer.minus, -sphere);
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
