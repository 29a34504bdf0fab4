#include "fluid/kinks.h"

#include <algorithm>
#include <cmath>

#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

/// Second over first difference at a kink: a sphere of radius 2 cells.
constexpr float kKink = 0.5f;

/// First and second differences along one axis, as magnitudes.
struct Bend {
  float first, second;
};
inline Bend bendAlong(const float* p, std::ptrdiff_t s) {
  const float plus = p[s] - p[0], minus = p[0] - p[-s];
  return {std::max(std::abs(plus), std::abs(minus)), std::abs(plus - minus)};
}

/// One row, on its own so that nothing the loop reads can alias the bytes it writes.
void markRow(const float* __restrict p, std::uint8_t* __restrict out, std::ptrdiff_t si, std::ptrdiff_t sj,
             int count) {
  for (int k = 0; k < count; ++k) {
    const Bend x = bendAlong(p + k, si), y = bendAlong(p + k, sj), z = bendAlong(p + k, 1);
    const float first = std::max(x.first, std::max(y.first, z.first));
    const float second = std::max(x.second, std::max(y.second, z.second));
    out[k] = second > kKink * first ? 1 : 0;
  }
}

}  // namespace

void markKinks(const DenseField<float>& phi, DenseField<std::uint8_t>& kinks) {
  const Eigen::Vector3i n = phi.size();
  tbb::parallel_for(-1, n.x() + 1, [&](int i) {
    for (int j = -1; j <= n.y(); ++j)
      markRow(&phi(i, j, -1), &kinks(i, j, -1), phi.stride(0), phi.stride(1), n.z() + 2);
  });
}

}  // namespace spume::fluid
