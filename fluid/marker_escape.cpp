#include "fluid/marker_escape.h"

#include <tbb/parallel_for.h>

#include <limits>

#include "fluid/impact_speed.h"
#include "fluid/sampling.h"

namespace spume::fluid {

double MarkerEscape::refreshGas(const MarkerScene& scene, const DenseField<float>& phi, MarkerSet& positive) {
  return shares_.refreshAir(scene, phi, positive);
}

void MarkerEscape::releaseEscaped(const MarkerScene& scene, const DenseField<float>& phi,
                                  const MacVelocity& velocity, MarkerSet& positive,
                                  std::vector<EscapedMarker>& escaped) {
  const MacView wind(velocity);
  const auto release = [&](std::int32_t n) {
    const float x = positive.x[n], y = positive.y[n], z = positive.z[n];
    const Velocity3f u = sampleVelocity(wind, x, y, z);
    escaped.push_back({scene.grid.toWorld({x, y, z}), {u.x, u.y, u.z}, positive.gas[n], 0});
    positive.x[n] = std::numeric_limits<float>::quiet_NaN();
  };
  const std::size_t before = escaped.size();
  lost_.forEach(scene, phi, MarkerSign::positive, scene.params.escapeDepth, positive, release);
  if (escaped.size() == before) return;
  sorter_.compact(positive);
  tbb::parallel_for(before, escaped.size(), [&](std::size_t n) {
    escaped[n].speed = impactSpeed(scene, phi, velocity, escaped[n].position);
  });
}

}  // namespace spume::fluid
