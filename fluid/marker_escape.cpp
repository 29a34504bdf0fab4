#include "fluid/marker_escape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fluid/marker_chunks.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Depth at which the receiving liquid is sampled [cells]: below the layer that moves with the surface, and
/// still inside a jet of 8 cells diameter.
constexpr float kBodyDepth = 3;
/// Markers higher than this above the surface meet no liquid yet [cells]; all pass through here before they
/// sink.
constexpr float kMeetingHeight = 2;

/// Speed of the air at a marker relative to the liquid it would sink into [m/s].
float meetingSpeed(const MacView& wind, const Eigen::Vector3f& top, const ValueAndGradient& f, float dx,
                   float x, float y, float z) {
  const float slope = std::sqrt(f.gx * f.gx + f.gy * f.gy + f.gz * f.gz);
  const float down = (f.value / dx + kBodyDepth) / std::max(slope, 1e-3f * dx);
  const auto inside = [](float value, float limit) { return std::clamp(value, 0.0f, limit); };
  const Velocity3f air = sampleVelocity(wind, x, y, z);
  const Velocity3f body = sampleVelocity(wind, inside(x - down * f.gx, top.x()),
                                         inside(y - down * f.gy, top.y()), inside(z - down * f.gz, top.z()));
  return std::hypot(air.x - body.x, air.y - body.y, air.z - body.z);
}

}  // namespace

double MarkerEscape::refreshGas(const MarkerScene& scene, const DenseField<float>& phi, MarkerSet& positive) {
  return shares_.refresh(scene, phi, MarkerSign::positive, positive);
}

void MarkerEscape::refreshSpeed(const MarkerScene& scene, const DenseField<float>& phi,
                                const MacVelocity& velocity, double dt, MarkerSet& positive) {
  const FieldView field(phi);
  const MacView wind(velocity);
  const Eigen::Vector3f top = scene.grid.cells.cast<float>();
  const float dx = static_cast<float>(scene.grid.dx);
  const float decay = static_cast<float>(std::exp(-dt / scene.params.speedMemory));
  forEachMarkerChunk(positive.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      positive.speed[n] *= decay;
      const float x = positive.x[n], y = positive.y[n], z = positive.z[n];
      const ValueAndGradient f = sampleCentredGradient(field, x, y, z);
      if (f.value <= 0 || f.value > kMeetingHeight * dx) continue;
      positive.speed[n] = std::max(positive.speed[n], meetingSpeed(wind, top, f, dx, x, y, z));
    }
  });
}

void MarkerEscape::releaseEscaped(const MarkerScene& scene, const DenseField<float>& phi,
                                  const MacVelocity& velocity, MarkerSet& positive,
                                  std::vector<EscapedMarker>& escaped) {
  const FieldView field(phi);
  const MacView wind(velocity);
  const float depth = static_cast<float>(scene.params.escapeDepth), dx = static_cast<float>(scene.grid.dx);
  const std::size_t before = escaped.size();
  for (std::size_t n = 0; n < positive.size(); ++n) {
    const float x = positive.x[n], y = positive.y[n], z = positive.z[n];
    const float under = -sampleCentred(field, x, y, z) / dx;
    if (under <= std::max(depth, positive.radius[n])) continue;
    const Velocity3f u = sampleVelocity(wind, x, y, z);
    escaped.push_back({scene.grid.toWorld({x, y, z}), {u.x, u.y, u.z}, positive.gas[n], positive.speed[n]});
    positive.x[n] = std::numeric_limits<float>::quiet_NaN();
  }
  if (escaped.size() > before) sorter_.compact(positive);
}

}  // namespace spume::fluid
