#include "fluid/marker_escape.h"

#include <cmath>
#include <limits>

#include "fluid/marker_sampling.h"

namespace spume::fluid {
namespace {

/// Depth at which the receiving liquid is sampled [cells]: below the layer that moves with the surface, and
/// still inside a jet of 8 cells diameter.
constexpr float kBodyDepth = 3;
/// Markers higher than this above the surface meet no liquid yet [cells]; all pass through here before they
/// sink.
constexpr float kMeetingHeight = 2;

/// Speed of the air at a marker relative to the liquid it would sink into [m/s].
inline float meetingSpeed(const MacView& wind, const Eigen::Vector3f& top, const ValueAndGradient& f,
                          float dx, float x, float y, float z) {
  const float slope = std::sqrt(f.gx * f.gx + f.gy * f.gy + f.gz * f.gz);
  const float down = (f.value / dx + kBodyDepth) / larger(slope, 1e-3f * dx);
  const Velocity3f air = sampleInnerVelocity(wind, x, y, z);
  const Velocity3f body =
      sampleInnerVelocity(wind, keptInside(x - down * f.gx, top.x()), keptInside(y - down * f.gy, top.y()),
                          keptInside(z - down * f.gz, top.z()));
  const float u = air.x - body.x, v = air.y - body.y, w = air.z - body.z;
  return std::sqrt(u * u + v * v + w * w);
}

/// Markers of a chunk picked out, so that the loop over them vectorises.
struct Picked {
  int count = 0;
  MarkerCells index;  ///< within the chunk
  MarkerValues x, y, z, speed;
};

/// Picks the markers whose phi says that they are about to meet the liquid.
[[gnu::noinline]] void pickMeeting(const MarkerSet& markers, std::size_t first, std::size_t last,
                                   const MarkerValues& phi, float highest, Picked& picked) {
  picked.count = 0;
  for (std::size_t n = first; n < last; ++n) {
    const float value = phi[n - first];
    picked.index[picked.count] = static_cast<std::int32_t>(n - first);
    picked.count += (value > 0) & (value <= highest) ? 1 : 0;
  }
  for (int m = 0; m < picked.count; ++m) {
    const std::size_t n = first + picked.index[m];
    picked.x[m] = markers.x[n], picked.y[m] = markers.y[n], picked.z[m] = markers.z[n];
  }
}

/// Stands alone so that nothing it reads can alias what it writes.
[[gnu::noinline]] void meetingSpeeds(const FieldView& phi, const MacView& wind, const Eigen::Vector3f& top,
                                     float dx, int count, const float* __restrict x,
                                     const float* __restrict y, const float* __restrict z,
                                     float* __restrict speed) {
  for (int n = 0; n < count; ++n)
    speed[n] =
        meetingSpeed(wind, top, sampleInnerCentredGradient(phi, x[n], y[n], z[n]), dx, x[n], y[n], z[n]);
}

/// Markers of a chunk deeper under the surface than `depth` and their own radius [cells]: 1, else 0.
[[gnu::noinline]] int findLeaving(float toDepth, float depth, int count, const float* __restrict phi,
                                  const float* __restrict radius, std::int32_t* __restrict leaving) {
  int sum = 0;
  for (int n = 0; n < count; ++n) {
    leaving[n] = toDepth * phi[n] > larger(depth, radius[n]) ? 1 : 0;
    sum += leaving[n];
  }
  return sum;
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
    MarkerValues value;
    Picked near;
    sampleAtMarkers(field, positive, first, last, value);
    pickMeeting(positive, first, last, value, kMeetingHeight * dx, near);
    meetingSpeeds(field, wind, top, dx, near.count, near.x.data(), near.y.data(), near.z.data(),
                  near.speed.data());
    for (std::size_t n = first; n < last; ++n) positive.speed[n] *= decay;
    for (int m = 0; m < near.count; ++m) {
      float& speed = positive.speed[first + near.index[m]];
      speed = larger(speed, near.speed[m]);
    }
  });
}

void MarkerEscape::releaseEscaped(const MarkerScene& scene, const DenseField<float>& phi,
                                  const MacVelocity& velocity, MarkerSet& positive,
                                  std::vector<EscapedMarker>& escaped) {
  const FieldView field(phi);
  const MacView wind(velocity);
  const float depth = static_cast<float>(scene.params.escapeDepth);
  const float toDepth = static_cast<float>(-1 / scene.grid.dx);
  leaving_.resize((positive.size() + kMarkerChunk - 1) / kMarkerChunk);
  forEachMarkerChunk(positive.size(), [&](std::size_t first, std::size_t last) {
    MarkerValues value;
    MarkerCells leaves;
    const int count = static_cast<int>(last - first);
    sampleAtMarkers(field, positive, first, last, value);
    std::vector<std::int32_t>& list = leaving_[first / kMarkerChunk];
    list.clear();
    if (findLeaving(toDepth, depth, count, value.data(), positive.radius.data() + first, leaves.data()) == 0)
      return;
    for (int n = 0; n < count; ++n)
      if (leaves[n]) list.push_back(static_cast<std::int32_t>(first) + n);
  });
  const std::size_t before = escaped.size();
  for (const std::vector<std::int32_t>& list : leaving_)
    for (const std::int32_t n : list) {
      const float x = positive.x[n], y = positive.y[n], z = positive.z[n];
      const Velocity3f u = sampleVelocity(wind, x, y, z);
      escaped.push_back({scene.grid.toWorld({x, y, z}), {u.x, u.y, u.z}, positive.gas[n], positive.speed[n]});
      positive.x[n] = std::numeric_limits<float>::quiet_NaN();
    }
  if (escaped.size() > before) sorter_.compact(positive);
}

}  // namespace spume::fluid
