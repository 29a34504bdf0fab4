#include "fluid/level_set_repair.h"

#include <openvdb/math/Stencils.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace spume::fluid {
namespace {

using Stencil = openvdb::math::WenoStencil<openvdb::FloatGrid>;
using openvdb::Coord;

constexpr float kLeastAllowed = 0.5f, kMostAllowed = 1.5f;  // squared gradient: OpenVDB's limits
constexpr float kLeastWanted = 0.6f, kMostWanted = 1.4f;    // with room for what the neighbours do next
constexpr int kTries = 20;  // a voxel moves by at most kTries / kTriesPerVoxel
constexpr int kTriesPerVoxel = 20;
constexpr int kStencilReach = 3;     // voxels a WENO stencil reads along each axis
constexpr int kMendingPasses = 4;    // mending one voxel may break its neighbour; 3 passes are usual
constexpr int kPasses = 60;          // those left, finer than the grid, are mended with their neighbours
constexpr int kSmoothingPeriod = 4;  // and every fourth time smoothed, where that has come to an end

const Coord kSteps[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

bool offends(Stencil& stencil) {
  if (!stencil.zeroCrossing()) return false;
  const float gradient = stencil.normSqGrad();
  return !(gradient >= kLeastAllowed && gradient <= kMostAllowed);
}

/// How far the squared gradient is outside the wanted range, 0 where nothing is asked of it.
float strainAt(Stencil& stencil) {
  if (!stencil.zeroCrossing()) return 0;
  const float gradient = stencil.normSqGrad();
  return std::max({0.0f, kLeastWanted - gradient, gradient - kMostWanted});
}

/// Whether the surface crosses between a voxel and one of its six neighbours: what the stencil says too,
/// without reading all of it.
bool isCrossed(const openvdb::FloatGrid::ConstAccessor& surface, const Coord& voxel, float own) {
  for (const Coord& step : kSteps)
    for (const Coord& neighbour : {voxel + step, voxel - step}) {
      const float other = surface.getValue(neighbour);
      if (own > 0 ? other < 0 : other > 0) return true;
    }
  return false;
}

/// Coordinates of the offending voxels in the order of the tree.
std::vector<Coord> offendersOf(const openvdb::FloatGrid& surface) {
  openvdb::tree::LeafManager<const openvdb::FloatTree> leaves(surface.tree());
  std::vector<std::vector<Coord>> found(leaves.leafCount());
  leaves.foreach ([&](const auto& leaf, std::size_t n) {
    Stencil stencil(surface);
    const auto accessor = surface.getConstAccessor();
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      if (!isCrossed(accessor, voxel.getCoord(), *voxel)) continue;
      stencil.moveTo(voxel);
      if (offends(stencil)) found[n].push_back(voxel.getCoord());
    }
  });
  std::vector<Coord> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// The order in which the tree keeps its voxels: by root entry, inner node, leaf, place in the leaf.
bool comesBefore(const Coord& a, const Coord& b) {
  using Tree = openvdb::FloatTree;
  constexpr openvdb::Index kRoot = Tree::RootNodeType::ChildNodeType::TOTAL,
                           kInner = Tree::RootNodeType::ChildNodeType::ChildNodeType::TOTAL,
                           kLeaf = Tree::LeafNodeType::TOTAL;
  for (const openvdb::Index level : {kRoot, kInner, kLeaf})
    if ((a >> level) != (b >> level)) return (a >> level) < (b >> level);
  return a < b;
}

/// The offenders among `suspects` and the voxels whose stencils read one of them, in the order of the tree.
std::vector<Coord> offendersNear(const openvdb::FloatGrid& surface, const std::vector<Coord>& suspects) {
  std::vector<Coord> near;
  for (const Coord& voxel : suspects) {
    near.push_back(voxel);
    for (const Coord& step : kSteps)
      for (int n = 1; n <= kStencilReach; ++n) {
        const Coord reach(n * step.x(), n * step.y(), n * step.z());
        near.push_back(voxel + reach);
        near.push_back(voxel - reach);
      }
  }
  std::sort(near.begin(), near.end(), comesBefore);
  near.erase(std::unique(near.begin(), near.end()), near.end());
  Stencil stencil(surface);
  const auto accessor = surface.getConstAccessor();
  std::erase_if(near, [&](const Coord& voxel) {
    if (!accessor.isValueOn(voxel)) return true;
    stencil.moveTo(voxel);
    return !offends(stencil);
  });
  return near;
}

/// The voxels of a surface that is being repaired, with the stencil round one of them.
class Repair {
 public:
  explicit Repair(openvdb::FloatGrid& surface)
      : stencil_(surface),
        accessor_(surface.getAccessor()),
        dx_(static_cast<float>(surface.voxelSize().x())) {}

  /// Moves a voxel to the nearest value that suits its neighbours, of the same sign if there is one.
  void mend(const Coord& voxel) {
    stencil_.moveTo(voxel);
    if (!offends(stencil_)) return;  // a neighbour's change has mended it
    const float own = accessor_.getValue(voxel);
    accessor_.setValueOnly(voxel, suitableValue(voxel, own).value_or(own));
    changed_.push_back(voxel);
  }

  /// Of all moves of a voxel or one of its neighbours, makes the one that leaves the least strain round it.
  void mendJointly(const Coord& voxel) {
    stencil_.moveTo(voxel);
    if (!offends(stencil_)) return;
    Move best = bestMove(voxel);
    for (const Coord& step : kSteps)
      for (const Coord& neighbour : {voxel + step, voxel - step}) {
        const Move move = bestMove(neighbour);
        if (move.gain > best.gain) best = move;
      }
    accessor_.setValueOnly(best.voxel, best.value);
    changed_.push_back(best.voxel);
  }

  /// Moves a voxel and its neighbours half way to the mean of theirs.
  void smoothAround(const Coord& voxel) {
    smooth(voxel);
    for (const Coord& step : kSteps) smooth(voxel + step), smooth(voxel - step);
  }

  /// Voxels tried or changed since the last call.
  std::vector<Coord> takeChanged() { return std::exchange(changed_, {}); }

 private:
  struct Move {
    Coord voxel;
    float value;  // the voxel's new phi [m]
    float gain;   // of strain, 0: none found
  };

  Move bestMove(const Coord& voxel) {
    const float own = accessor_.getValue(voxel);
    Move best{voxel, own, 0};
    if (!accessor_.isValueOn(voxel)) return best;
    const float before = strainRound(voxel);
    for (int n = -kTries; n <= kTries; ++n) {
      const float value = own + dx_ * static_cast<float>(n) / kTriesPerVoxel;
      accessor_.setValueOnly(voxel, value);
      const float gain = before - strainRound(voxel);
      if (gain > best.gain) best = {voxel, value, gain};
    }
    accessor_.setValueOnly(voxel, own);
    return best;
  }

  /// Strain of all voxels whose differences use `voxel`.
  float strainRound(const Coord& voxel) {
    float sum = strainOf(voxel);
    for (const Coord& step : kSteps)
      for (int n = 1; n <= kStencilReach; ++n) {
        const Coord far(n * step.x(), n * step.y(), n * step.z());
        sum += strainOf(voxel + far) + strainOf(voxel - far);
      }
    return sum;
  }
  float strainOf(const Coord& voxel) {
    if (!accessor_.isValueOn(voxel)) return 0;
    stencil_.moveTo(voxel);
    return strainAt(stencil_);
  }

  void smooth(const Coord& voxel) {
    float sum = 0;
    for (const Coord& step : kSteps)
      sum += accessor_.getValue(voxel + step) + accessor_.getValue(voxel - step);
    if (!accessor_.isValueOn(voxel)) return;
    accessor_.setValueOnly(voxel, 0.5f * accessor_.getValue(voxel) + sum / 12);
    changed_.push_back(voxel);
  }
  std::optional<float> suitableValue(const Coord& voxel, float own) {
    std::optional<float> otherSign;
    for (int n = 1; n <= kTries; ++n) {
      const float change = dx_ * static_cast<float>(n) / kTriesPerVoxel;
      for (const float value :
           {own < 0 ? own + change : own - change, own < 0 ? own - change : own + change}) {
        if (!suits(voxel, value)) continue;
        if ((value < 0) == (own < 0)) return value;
        if (!otherSign) otherSign = value;
      }
    }
    return otherSign;
  }
  bool suits(const Coord& voxel, float value) {
    accessor_.setValueOnly(voxel, value);
    stencil_.moveTo(voxel);
    const float gradient = stencil_.normSqGrad();
    return gradient >= kLeastWanted && gradient <= kMostWanted;
  }

  Stencil stencil_;
  openvdb::FloatGrid::Accessor accessor_;
  float dx_;
  std::vector<Coord> changed_;
};

}  // namespace

std::size_t repairLevelSet(openvdb::FloatGrid& surface) {
  std::vector<Coord> offenders = offendersOf(surface);
  Repair repair(surface);
  for (int pass = 0; pass < kPasses && !offenders.empty(); ++pass) {
    for (const Coord& voxel : offenders) {
      if (pass < kMendingPasses) {
        repair.mend(voxel);
      } else if ((pass - kMendingPasses) % kSmoothingPeriod < kSmoothingPeriod - 1) {
        repair.mendJointly(voxel);
      } else {
        repair.smoothAround(voxel);
      }
    }
    std::vector<Coord> suspects = repair.takeChanged();
    suspects.insert(suspects.end(), offenders.begin(), offenders.end());
    offenders = offendersNear(surface, suspects);
  }
  return offenders.size();
}

}  // namespace spume::fluid
