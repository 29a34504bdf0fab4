#include "fluid/marker_sampling.h"

namespace spume::fluid {
namespace {

// The loops stand alone, not inlined, so that nothing they read can alias what they write: they vectorise
// into gathers.

[[gnu::noinline]] void sampleColumn(const FieldView& f, int count, const float* __restrict x,
                                    const float* __restrict y, const float* __restrict z,
                                    float* __restrict value) {
  for (int n = 0; n < count; ++n) value[n] = sampleInner(f, x[n] - 0.5f, y[n] - 0.5f, z[n] - 0.5f);
}

int cellAlong(float x, int cells) {
  const int i = static_cast<int>(x);
  return i < cells ? i : cells - 1;
}

void cellColumn(const Eigen::Vector3i& size, int strideI, int strideJ, int count, const float* __restrict x,
                const float* __restrict y, const float* __restrict z, std::int32_t* __restrict cell) {
  const int nx = size.x(), ny = size.y(), nz = size.z();
  for (int n = 0; n < count; ++n)
    cell[n] = (cellAlong(x[n], nx) + kGhost) * strideI + (cellAlong(y[n], ny) + kGhost) * strideJ +
              cellAlong(z[n], nz) + kGhost;
}

void flagColumn(float toSide, int count, const float* __restrict value, const float* __restrict radius,
                std::uint8_t* __restrict escaped) {
  for (int n = 0; n < count; ++n) escaped[n] = toSide * value[n] < -radius[n] ? 1 : 0;
}

}  // namespace

void sampleAtMarkers(const FieldView& field, const MarkerSet& markers, std::size_t first, std::size_t last,
                     MarkerValues& values) {
  sampleColumn(field, static_cast<int>(last - first), markers.x.data() + first, markers.y.data() + first,
               markers.z.data() + first, values.data());
}

void sampleAtMarkers(const DenseField<float>& phi, const WallSides& sides, const MarkerSet& markers,
                     std::size_t first, std::size_t last, MarkerValues& values) {
  sampleAtMarkers(FieldView(phi), markers, first, last, values);
  if (!sides.any()) return;
  MarkerCells cells;
  findMarkerCells(phi, markers, first, last, cells);
  for (std::size_t n = first; n < last; ++n) {
    if (!(sides.guardAt(cells[n - first]) & WallSides::kBeside)) continue;
    const Eigen::Vector3f x(markers.x[n], markers.y[n], markers.z[n]);
    const Eigen::Vector3i cell = x.cast<int>().cwiseMin(phi.size() - Eigen::Vector3i::Ones());
    values[n - first] = sides.valueIn(phi, cell, x);
  }
}

ValueAndGradient sampleOnSide(const DenseField<float>& phi, const FieldView& view, const WallSides& sides,
                              const Eigen::Vector3i& c, const Eigen::Vector3f& x) {
  if (!(sides.guard(c) & WallSides::kBeside)) return sampleCentredGradient(view, x.x(), x.y(), x.z());
  const Eigen::Vector3f offset = x - c.cast<float>() - Eigen::Vector3f::Constant(0.5f);
  const WallSides::Sample f = WallSides::sample(sides.read(phi, c), offset);
  return {f.value, f.gradient.x(), f.gradient.y(), f.gradient.z()};
}

template <typename T>
void findMarkerCells(const DenseField<T>& field, const MarkerSet& markers, std::size_t first,
                     std::size_t last, MarkerCells& cells) {
  cellColumn(field.size(), static_cast<int>(field.stride(0)), static_cast<int>(field.stride(1)),
             static_cast<int>(last - first), markers.x.data() + first, markers.y.data() + first,
             markers.z.data() + first, cells.data());
}
template void findMarkerCells(const DenseField<float>&, const MarkerSet&, std::size_t, std::size_t,
                              MarkerCells&);
template void findMarkerCells(const DenseField<std::int32_t>&, const MarkerSet&, std::size_t, std::size_t,
                              MarkerCells&);

void flagEscapedMarkers(const MarkerValues& values, float toSide, std::size_t first, std::size_t last,
                        MarkerSet& markers) {
  flagColumn(toSide, static_cast<int>(last - first), values.data(), markers.radius.data() + first,
             markers.escaped.data() + first);
}

}  // namespace spume::fluid
