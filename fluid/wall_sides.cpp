#include "fluid/wall_sides.h"

#include <algorithm>
#include <cmath>

#include "fluid/parallel.h"
#include "fluid/sampling.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {
namespace {

/// A walk ends this far before a closed face [cells]: inside its cell by more than a float's round-off.
constexpr float kInset = 1e-3f;
/// Faces a walk may meet: more than any sub-step crosses.
constexpr int kMostFaces = 64;

bool isInside(const SolidBoundary& solids, const Eigen::Vector3i& c) {
  return solids.psi.contains(c.x(), c.y(), c.z());
}

/// The face of a cell on one side.
Eigen::Vector3i faceOf(const Eigen::Vector3i& c, int axis, int side) {
  return side > 0 ? c + Eigen::Vector3i::Unit(axis) : c;
}

bool letsThrough(const SolidBoundary& solids, int axis, const Eigen::Vector3i& face) {
  return solids.open[axis](face) > 0 || solids.prescribed[axis](face) != 0;
}

/// Offsets within CellReach::kRadius, nearest first.
std::vector<Eigen::Vector3i> offsetsByDistance() {
  std::vector<Eigen::Vector3i> offsets;
  constexpr int r = CellReach::kRadius;
  for (int i = -r; i <= r; ++i)
    for (int j = -r; j <= r; ++j)
      for (int k = -r; k <= r; ++k) offsets.emplace_back(i, j, k);
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
  return offsets;
}

const std::vector<Eigen::Vector3i> kOffsets = offsetsByDistance();

Eigen::Vector3i offsetInBlock(int n) { return {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1}; }

/// True if a cell behind a wall is within two cells: elsewhere there are no sides to tell apart.
bool solidNearby(const SolidBoundary& solids, const Eigen::Vector3i& c) {
  constexpr int r = CellReach::kRadius;
  // psi changes by no more than the distance, here to a corner of the block.
  if (solids.nodePsi(c) > (r + 1) * std::sqrt(3.0f) * solids.cellEdge) return false;
  const Eigen::Vector3i low = (c.array() - r).max(0);
  const Eigen::Vector3i high = (c.array() + r).min(solids.psi.size().array() - 1);
  for (int i = low.x(); i <= high.x(); ++i)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int k = low.z(); k <= high.z(); ++k)
        if (solids.psi(i, j, k) <= 0) return true;
  return false;
}

/// Fills the numbers of a level that are not seen with the mean of those that are, nearer ones counting more.
/// Values that are all the same stay so to the bit.
void fillLevel(const std::array<int, 9>& level, WallSides::Guard seen, WallSides::Block& block) {
  for (const int n : level) {
    if (seen >> n & 1) continue;
    const Eigen::Vector3i at = offsetInBlock(n);
    float first = 0, sum = 0, weights = 0;
    for (const int m : level) {
      if (!(seen >> m & 1)) continue;
      if (weights == 0) first = block[m];
      const float weight = 1 / static_cast<float>((offsetInBlock(m) - at).squaredNorm());
      sum += weight * (block[m] - first);
      weights += weight;
    }
    block[n] = first + sum / weights;
  }
}

}  // namespace

CellReach::CellReach(const DenseField<std::uint8_t>& openings, const Eigen::Vector3i& centre,
                     const Eigen::Vector3i& start) {
  const std::uint8_t* field = &openings(centre);
  const std::ptrdiff_t si = openings.stride(0), sj = openings.stride(1);
  constexpr int kStep[3] = {kEdge * kEdge, kEdge, 1};
  std::array<std::uint8_t, kCells> queue;
  int head = 0, tail = 0;
  const auto enter = [&](int n) {
    if (!reached_[n]) reached_[n] = true, queue[tail++] = static_cast<std::uint8_t>(n);
  };
  enter(number(start - centre));
  while (head < tail) {
    const int n = queue[head++];
    const int place[3] = {n / kStep[0] - kRadius, n / kStep[1] % kEdge - kRadius, n % kEdge - kRadius};
    const std::uint8_t open = field[place[0] * si + place[1] * sj + place[2]];
    for (int a = 0; a < 3; ++a) {
      if (open >> (2 * a) & 1 && place[a] > -kRadius) enter(n - kStep[a]);
      if (open >> (2 * a + 1) & 1 && place[a] < kRadius) enter(n + kStep[a]);
    }
  }
}

/// The openings of the cells near solids; far from them nothing asks.
void WallSides::findOpenings(const SolidBoundary& solids) {
  const Eigen::Vector3i& cells = solids.psi.size();
  if (openings_.size() != cells) {
    openings_ = DenseField<std::uint8_t>(cells);
    home_ = DenseField<std::int8_t>(cells, -1);
    guard_ = DenseField<Guard>(cells);
  }
  forEachCell(cells, [&](int i, int j, int k) {
    const Eigen::Vector3i c(i, j, k);
    std::uint8_t open = 0;
    for (int a = 0; a < 3; ++a)
      for (const int side : {-1, 1}) {
        const bool inside = isInside(solids, c + side * Eigen::Vector3i::Unit(a));
        if (inside && letsThrough(solids, a, faceOf(c, a, side))) open |= 1 << (2 * a + (side > 0));
      }
    openings_(c) = open;
  });
}

void WallSides::findHomes(const SolidBoundary& solids) {
  forEachCell(solids.psi.size(), [&](int i, int j, int k) {
    std::int8_t& home = home_(i, j, k);
    home = openings_(i, j, k) ? 0 : -1;
    for (std::size_t n = 0; home < 0 && n < kOffsets.size(); ++n) {
      const Eigen::Vector3i c = Eigen::Vector3i(i, j, k) + kOffsets[n];
      if (isInside(solids, c) && openings_(c)) home = static_cast<std::int8_t>(n);
    }
  });
}

bool WallSides::home(const Eigen::Vector3i& c, Eigen::Vector3i& cell) const {
  if (home_(c) < 0) return false;
  cell = c + kOffsets[home_(c)];
  return true;
}

/// The guard of one cell without the reach of steps.
WallSides::Guard WallSides::guardOf(const Eigen::Vector3i& c) const {
  const CellReach reach(openings_, c, c);
  Guard guard = kSeen | kByWall;
  for (const Eigen::Vector3i& d : kOffsets) {
    const Eigen::Vector3i n = c + d;
    if (reach.reaches(d) || !openings_.contains(n.x(), n.y(), n.z())) continue;
    Eigen::Vector3i own;
    if (home(n, own) && CellReach::covers(own - c) && reach.reaches(own - c)) continue;
    guard |= kNear;
    if (d.cwiseAbs().maxCoeff() > 1) continue;
    guard |= kBeside;
    guard &= ~(1u << ((d.x() + 1) * 9 + (d.y() + 1) * 3 + d.z() + 1));
  }
  return guard;
}

void WallSides::find(const SolidBoundary& solids) {
  byWall_.clear();
  thin_ = false;
  const Eigen::Vector3i& cells = solids.cellFraction.size();
  findOpenings(solids);
  findHomes(solids);
  guard_.fill(0);
  forEachCell(cells, [&](int i, int j, int k) {
    if (openings_(i, j, k) && solidNearby(solids, {i, j, k})) guard_(i, j, k) = guardOf({i, j, k});
  });
  for (int i = 0; i < cells.x(); ++i)
    for (int j = 0; j < cells.y(); ++j)
      for (int k = 0; k < cells.z(); ++k)
        if (guard_(i, j, k)) {
          byWall_.emplace_back(i, j, k);
          thin_ = thin_ || guard_(i, j, k) & kNear;
        }
  if (thin_) markReach();
}

void WallSides::markReach() {
  const Eigen::Vector3i last = guard_.size() - Eigen::Vector3i::Ones();
  for (const Eigen::Vector3i& c : byWall_) {
    if (!(guard_(c) & kNear)) continue;
    const Eigen::Vector3i low = (c.array() - walkReach).max(0);
    const Eigen::Vector3i high = (c.array() + walkReach).min(last.array());
    for (int i = low.x(); i <= high.x(); ++i)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int k = low.z(); k <= high.z(); ++k) guard_(i, j, k) |= kInReach;
  }
}

bool WallSides::sees(const Eigen::Vector3i& c, const Eigen::Vector3i& n) const {
  const Guard g = guard(c);
  const Eigen::Vector3i d = n - c + Eigen::Vector3i::Ones();
  return !(g & kBeside) || (g >> (d.x() * 9 + d.y() * 3 + d.z()) & 1);
}

WallSides::Block WallSides::read(const DenseField<float>& field, const Eigen::Vector3i& c) const {
  Block block;
  for (int n = 0; n < 27; ++n) block[n] = field(c + offsetInBlock(n));
  const Guard seen = guard(c);
  if (!(seen & kBeside)) return block;
  const auto level = [this](int up) {
    std::array<int, 9> numbers;
    int count = 0;
    for (int n = 0; n < 27; ++n)
      if (offsetInBlock(n)[upAxis] == up) numbers[count++] = n;
    return numbers;
  };
  const auto anySeen = [seen](const std::array<int, 9>& numbers) {
    return std::any_of(numbers.begin(), numbers.end(), [seen](int n) { return seen >> n & 1; });
  };
  const std::array<int, 9> middle = level(0), below = level(-1), above = level(1);
  fillLevel(middle, seen, block);
  const bool low = anySeen(below), high = anySeen(above);
  if (low) fillLevel(below, seen, block);
  if (high) fillLevel(above, seen, block);
  for (int n = 0; n < 9; ++n) {  // a level behind the wall continues the two before it
    if (!low) block[below[n]] = high ? 2 * block[middle[n]] - block[above[n]] : block[middle[n]];
    if (!high) block[above[n]] = low ? 2 * block[middle[n]] - block[below[n]] : block[middle[n]];
  }
  return block;
}

WallSides::Sample WallSides::sample(const Block& block, const Eigen::Vector3f& offset) {
  const Eigen::Vector3f at = offset.cwiseMax(-1.0f).cwiseMin(1.0f) + Eigen::Vector3f::Ones();
  const Eigen::Vector3i base = at.cast<int>().cwiseMin(1);
  const Eigen::Vector3f t = at - base.cast<float>();
  const float* p = &block[base.x() * 9 + base.y() * 3 + base.z()];
  const float c00 = lerp(p[0], p[1], t.z()), c01 = lerp(p[3], p[4], t.z());
  const float c10 = lerp(p[9], p[10], t.z()), c11 = lerp(p[12], p[13], t.z());
  const float c0 = lerp(c00, c01, t.y()), c1 = lerp(c10, c11, t.y());
  const float d0 = lerp(p[1] - p[0], p[4] - p[3], t.y()), d1 = lerp(p[10] - p[9], p[13] - p[12], t.y());
  return {lerp(c0, c1, t.x()), {c1 - c0, lerp(c01 - c00, c11 - c10, t.x()), lerp(d0, d1, t.x())}};
}

float WallSides::valueIn(const DenseField<float>& field, const Eigen::Vector3i& c,
                         const Eigen::Vector3f& x) const {
  return sample(read(field, c), x - c.cast<float>() - Eigen::Vector3f::Constant(0.5f)).value;
}

Walk walkThroughFaces(const SolidBoundary& solids, const Eigen::Vector3i& cell, const Eigen::Vector3f& from,
                      const Eigen::Vector3f& to) {
  Walk walk{cell, to};
  Eigen::Vector3f start = from;
  for (int face = 0; face < kMostFaces; ++face) {
    int axis = -1, side = 0;
    float nearest = 2;
    for (int a = 0; a < 3; ++a) {
      const float low = static_cast<float>(walk.cell[a]), move = walk.at[a] - start[a];
      const bool leaves = walk.at[a] < low || walk.at[a] > low + 1;
      if (!leaves || move == 0) continue;
      const float when = ((move > 0 ? low + 1 : low) - start[a]) / move;
      if (when < nearest) nearest = when, axis = a, side = move > 0 ? 1 : -1;
    }
    if (axis < 0) break;
    const Eigen::Vector3i next = walk.cell + side * Eigen::Vector3i::Unit(axis);
    if (isInside(solids, next) && letsThrough(solids, axis, faceOf(walk.cell, axis, side))) {
      walk.cell = next;
      continue;
    }
    const float edge = static_cast<float>(walk.cell[axis] + (side > 0));
    start = start + std::clamp(nearest, 0.0f, 1.0f) * (walk.at - start);
    walk.at[axis] = edge - static_cast<float>(side) * kInset;
    start[axis] = walk.at[axis];
    walk.stopped[axis] = true;
  }
  return walk;
}

}  // namespace spume::fluid
