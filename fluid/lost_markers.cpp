#include "fluid/lost_markers.h"

#include "fluid/marker_sampling.h"

namespace spume::fluid {
namespace {

/// Markers of a chunk beyond the surface by more than `depth` and their own radius [cells]: 1, else 0.
/// Stands alone so that nothing it reads can alias what it writes.
[[gnu::noinline]] int flagLost(float toDepth, float depth, int count, const float* __restrict phi,
                               const float* __restrict radius, std::int32_t* __restrict lost) {
  int sum = 0;
  for (int n = 0; n < count; ++n) {
    lost[n] = toDepth * phi[n] > larger(depth, radius[n]) ? 1 : 0;
    sum += lost[n];
  }
  return sum;
}

}  // namespace

void LostMarkers::find(const MarkerScene& scene, const DenseField<float>& phi, MarkerSign sign, double depth,
                       MarkerSet& markers) {
  const float toDepth = static_cast<float>(-static_cast<int>(sign) / scene.grid.dx);
  lost_.resize((markers.size() + kMarkerChunk - 1) / kMarkerChunk);
  forEachMarkerChunk(markers.size(), [&](std::size_t first, std::size_t last) {
    MarkerValues value;
    MarkerCells flags;
    const int count = static_cast<int>(last - first);
    sampleAtMarkers(phi, scene.solids.sides, markers, first, last, value);
    flagEscapedMarkers(value, -toDepth, first, last, markers);
    std::vector<std::int32_t>& list = lost_[first / kMarkerChunk];
    list.clear();
    if (flagLost(toDepth, static_cast<float>(depth), count, value.data(), markers.radius.data() + first,
                 flags.data()) == 0)
      return;
    for (int n = 0; n < count; ++n)
      if (flags[n]) list.push_back(static_cast<std::int32_t>(first) + n);
  });
}

}  // namespace spume::fluid
