#include "fluid/level_set_repair.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "fluid/parallel.h"
#include "fluid/upwind_gradient.h"

namespace spume::fluid {
namespace {

using Eigen::Vector3i;

constexpr float kLeastAllowed = 0.501f, kMostAllowed = 1.499f;  // squared gradient: 0.5..1.5 less round-off
constexpr float kLeastWanted = 0.6f, kMostWanted = 1.4f;        // with room for what the neighbours do next
constexpr int kMoves = 48;  // moves tried: from -24 to 23 times 1/24 voxel
constexpr int kMovesPerVoxel = 24;
constexpr int kMendingPasses = 4;    // mending one voxel may break its neighbour; 3 passes are usual
constexpr int kPasses = 60;          // those left, finer than the grid, are mended with their neighbours
constexpr int kSmoothingPeriod = 4;  // and every fourth time smoothed, where that has come to an end,
constexpr int kWideningPeriod = 16;  // farther and farther round them
constexpr int kWidth = 2 * kUpwindReach + 1;

/// How far a squared gradient is outside the wanted range.
float strainOf(float gradient) {
  return std::max(std::max(0.0f, kLeastWanted - gradient), gradient - kMostWanted);
}

/// The values along the three axes through a voxel, its own in the middle of each [voxels].
struct Cross {
  float line[3][kWidth];
  float squaredGradient() const {
    return upwindSquare(line[0]) + upwindSquare(line[1]) + upwindSquare(line[2]);
  }
  /// Whether the surface lies between the voxel and one of its neighbours.
  bool isCrossed() const {
    const float own = line[0][kUpwindReach];
    bool crossed = false;
    for (const auto& v : line)
      crossed |= partedBy(own, v[kUpwindReach - 1]) | partedBy(own, v[kUpwindReach + 1]);
    return crossed;
  }
  static bool partedBy(float own, float other) { return own > 0 ? other < 0 : other > 0; }
};

/// strain += that of the voxel of `cross` for each value of the one `offset` away along an axis.
[[gnu::noinline]] void addStrains(const Cross& cross, int axis, int offset, const float* __restrict values,
                                  float* __restrict strain) {
  const float others = upwindSquare(cross.line[(axis + 1) % 3]) + upwindSquare(cross.line[(axis + 2) % 3]);
  const int slot = kUpwindReach + offset;
  Cross base = cross;  // whether the surface crosses elsewhere
  base.line[axis][slot] = cross.line[axis][kUpwindReach];
  const bool crossedElsewhere = base.isCrossed();
  const bool near = offset == 1 || offset == -1;
  if (!near && !crossedElsewhere) return;
  const float own = cross.line[axis][kUpwindReach];
  for (int n = 0; n < kMoves; ++n) {
    float v[kWidth];
    for (int m = 0; m < kWidth; ++m) v[m] = m == slot ? values[n] : cross.line[axis][m];
    const bool crossed = crossedElsewhere | (near & Cross::partedBy(own, values[n]));
    const float s = strainOf(others + upwindSquare(v));
    strain[n] += crossed ? s : 0.0f;
  }
}

/// Squared gradient of a voxel for each value of its own.
[[gnu::noinline]] void gradientsOf(const Cross& cross, const float* __restrict values,
                                   float* __restrict gradient) {
  for (int n = 0; n < kMoves; ++n) gradient[n] = 0;
  for (const auto& line : cross.line)
    for (int n = 0; n < kMoves; ++n) {
      float v[kWidth];
      for (int m = 0; m < kWidth; ++m) v[m] = m == kUpwindReach ? values[n] : line[m];
      gradient[n] += upwindSquare(v);
    }
}

/// The level set under repair, in voxels.
class Repair {
 public:
  Repair(const DenseField<float>& phi, double dx, float band)
      : value_(phi), active_(phi.size(), 0), limit_(static_cast<float>(band / dx)) {
    const float perDx = static_cast<float>(1 / dx);
    for (std::ptrdiff_t n = 0; n < value_.count(); ++n) value_.data()[n] *= perDx;
    forEachCell(phi.size(), [&](int i, int j, int k) { active_(i, j, k) = std::abs(phi(i, j, k)) < band; });
  }

  float value(const Vector3i& voxel) const { return value_(voxel); }

  std::vector<Vector3i> offenders() const {
    const int rows = value_.size().x();
    std::vector<std::vector<Vector3i>> found(rows);
    tbb::parallel_for(0, rows, [&](int i) {
      for (int j = 0; j < value_.size().y(); ++j)
        for (int k = 0; k < value_.size().z(); ++k)
          if (offends({i, j, k})) found[i].emplace_back(i, j, k);
    });
    std::vector<Vector3i> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  /// The offenders among `suspects` and the voxels whose differences use one of them, in order.
  std::vector<Vector3i> offendersNear(const std::vector<Vector3i>& suspects) const {
    std::vector<Vector3i> near;
    for (const Vector3i& voxel : suspects)
      forEachReader(voxel, [&](const Vector3i& reader, int, int) { near.push_back(reader); });
    const auto comesBefore = [](const Vector3i& a, const Vector3i& b) {
      return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    };
    std::sort(near.begin(), near.end(), comesBefore);
    near.erase(std::unique(near.begin(), near.end()), near.end());
    std::erase_if(near, [&](const Vector3i& voxel) { return !offends(voxel); });
    return near;
  }

  /// Moves a voxel to the nearest value that suits its neighbours, of the same sign if there is one.
  void mend(const Vector3i& voxel) {
    if (!offends(voxel)) return;  // a neighbour's change has mended it
    float values[kMoves], gradient[kMoves];
    const float own = listValues(voxel, values);
    gradientsOf(crossAt(voxel), values, gradient);
    int best = -1;
    const auto cost = [&](int n) {
      return std::abs(values[n] - own) + ((values[n] < 0) == (own < 0) ? 0.0f : 2.0f);
    };
    for (int n = 0; n < kMoves; ++n)
      if (gradient[n] >= kLeastWanted && gradient[n] <= kMostWanted && (best < 0 || cost(n) < cost(best)))
        best = n;
    if (best >= 0) value_(voxel) = values[best];
    changed_.push_back(voxel);
  }

  /// Of all moves of a voxel or one of its neighbours, makes the one that leaves the least strain round it.
  void mendJointly(const Vector3i& voxel) {
    if (!offends(voxel)) return;
    Move best = bestMove(voxel);
    for (int a = 0; a < 3; ++a)
      for (int side : {1, -1}) {
        const Move move = bestMove(voxel + side * Vector3i::Unit(a));
        if (move.gain > best.gain) best = move;
      }
    value_(best.voxel) = best.value;
    changed_.push_back(best.voxel);
  }

  /// Moves the voxels up to `reach` steps away half way to the mean of their neighbours.
  void smoothAround(const Vector3i& voxel, int reach) {
    for (int i = -reach; i <= reach; ++i)
      for (int j = -reach; j <= reach; ++j)
        for (int k = -reach; k <= reach; ++k)
          if (std::abs(i) + std::abs(j) + std::abs(k) <= reach) smooth(voxel + Vector3i(i, j, k));
  }

  /// Voxels tried or changed since the last call.
  std::vector<Vector3i> takeChanged() { return std::exchange(changed_, {}); }

 private:
  struct Move {
    Vector3i voxel;
    float value;  // the voxel's new phi [voxels]
    float gain;   // of strain, 0: none found
  };

  bool isActive(const Vector3i& v) const { return active_.contains(v.x(), v.y(), v.z()) && active_(v) != 0; }

  Cross crossAt(const Vector3i& voxel) const {
    Cross cross;
    const float* centre = &value_(voxel);
    for (int a = 0; a < 3; ++a)
      for (int m = 0; m < kWidth; ++m) cross.line[a][m] = centre[(m - kUpwindReach) * value_.stride(a)];
    return cross;
  }

  bool offends(const Vector3i& voxel) const {
    if (!isActive(voxel) || !isCrossed(voxel)) return false;
    const float gradient = crossAt(voxel).squaredGradient();
    return !(gradient >= kLeastAllowed && gradient <= kMostAllowed);
  }
  bool isCrossed(const Vector3i& voxel) const {
    const float* v = &value_(voxel);
    for (int a = 0; a < 3; ++a) {
      const auto step = value_.stride(a);
      if (Cross::partedBy(*v, v[step]) || Cross::partedBy(*v, v[-step])) return true;
    }
    return false;
  }

  /// Calls body(reader, axis, offset) for all active voxels whose differences use `voxel`, which lies
  /// `offset` from the reader along the axis.
  template <typename Body>
  void forEachReader(const Vector3i& voxel, const Body& body) const {
    if (isActive(voxel)) body(voxel, 0, 0);
    for (int a = 0; a < 3; ++a)
      for (int offset = -kUpwindReach; offset <= kUpwindReach; ++offset) {
        const Vector3i reader = voxel - offset * Vector3i::Unit(a);
        if (offset != 0 && isActive(reader)) body(reader, a, offset);
      }
  }

  /// The values tried for a voxel; returns its own.
  float listValues(const Vector3i& voxel, float* values) const {
    const float own = value_(voxel);
    for (int n = 0; n < kMoves; ++n)
      values[n] = std::clamp(own + static_cast<float>(n - kMoves / 2) / kMovesPerVoxel, -limit_, limit_);
    return own;
  }

  Move bestMove(const Vector3i& voxel) const {
    const float own = value_(voxel);
    Move best{voxel, own, 0};
    if (!isActive(voxel)) return best;
    float values[kMoves], strain[kMoves] = {}, gradient[kMoves];
    listValues(voxel, values);
    const Cross here = crossAt(voxel);
    gradientsOf(here, values, gradient);
    for (int n = 0; n < kMoves; ++n) {
      Cross moved = here;
      for (auto& line : moved.line) line[kUpwindReach] = values[n];
      strain[n] = moved.isCrossed() ? strainOf(gradient[n]) : 0.0f;
    }
    forEachReader(voxel, [&](const Vector3i& reader, int axis, int offset) {
      if (offset != 0) addStrains(crossAt(reader), axis, offset, values, strain);
    });
    const float before = strain[kMoves / 2];
    for (int n = 0; n < kMoves; ++n)
      if (before - strain[n] > best.gain) best = {voxel, values[n], before - strain[n]};
    return best;
  }

  void smooth(const Vector3i& voxel) {
    if (!isActive(voxel)) return;
    const float* v = &value_(voxel);
    float sum = 0;
    for (int a = 0; a < 3; ++a) sum += v[value_.stride(a)] + v[-value_.stride(a)];
    value_(voxel) = 0.5f * *v + sum / 12;
    changed_.push_back(voxel);
  }

  DenseField<float> value_;
  DenseField<std::uint8_t> active_;
  float limit_;
  std::vector<Vector3i> changed_;
};

}  // namespace

std::size_t repairLevelSet(DenseField<float>& phi, double dx, float band) {
  Repair repair(phi, dx, band);
  std::vector<Vector3i> offenders = repair.offenders(), touched;
  for (int pass = 0; pass < kPasses && !offenders.empty(); ++pass) {
    for (const Vector3i& voxel : offenders) {
      if (pass < kMendingPasses) {
        repair.mend(voxel);
      } else if ((pass - kMendingPasses) % kSmoothingPeriod < kSmoothingPeriod - 1) {
        repair.mendJointly(voxel);
      } else {
        repair.smoothAround(voxel, 1 + pass / kWideningPeriod);
      }
    }
    std::vector<Vector3i> suspects = repair.takeChanged();
    touched.insert(touched.end(), suspects.begin(), suspects.end());
    suspects.insert(suspects.end(), offenders.begin(), offenders.end());
    offenders = repair.offendersNear(suspects);
  }
  for (const Vector3i& voxel : touched)
    phi(voxel) = std::clamp(static_cast<float>(repair.value(voxel) * dx), -band, band);
  return offenders.size();
}

}  // namespace spume::fluid
