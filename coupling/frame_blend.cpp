#include "coupling/frame_blend.h"

#include "coupling/trilinear.h"
#include "fluid/parallel.h"

namespace spume::coupling {
namespace {

constexpr double kKnownBand = 2;  // [dx] of air round the liquid where caches hold velocities for certain

/// The two places, in cells, whose liquid meets at one place between the frames.
struct Meeting {
  Eigen::Vector3d upstream, downstream;
};

class Blender {
 public:
  Blender(const FramePair& frames, double share, double density, const Eigen::Vector3d& gravity)
      : frames_(frames), grid_(frames.before.grid), share_(share), density_(density), gravity_(gravity) {}

  double phiAt(const Eigen::Vector3d& inCells) const {
    const Meeting m = meetingAt(inCells);
    return TrilinearSamples::mix(phiOf(frames_.before, m.upstream), phiOf(frames_.after, m.downstream),
                                 share_);
  }

  /// Velocity [m/s] and grad p [Pa/m] across a face.
  void faceAt(int axis, const Eigen::Vector3d& inCells, float& velocity, float& gradient) const {
    const Meeting m = meetingAt(inCells);
    const bool isNearAfter = share_ >= 0.5;
    const fluid::LiquidState& near = isNearAfter ? frames_.after : frames_.before;
    // Paths end between faces, and what is interpolated there has lost the smallest eddies.
    const Eigen::Vector3d& there = isKnown(near, inCells) ? inCells : isNearAfter ? m.downstream : m.upstream;
    velocity = static_cast<float>(faceValue(near.velocity, axis, there));
    gradient = static_cast<float>(density_ * (gravity_[axis] - rateOfChange(axis, m)));
  }

 private:
  /// Both paths by the midpoint rule, in a velocity that changes from one frame's to the other's.
  Meeting meetingAt(const Eigen::Vector3d& inCells) const {
    const double cells = frames_.interval / grid_.dx;  // passed from frame to frame at 1 m/s
    const double back = share_ * cells, forth = (1 - share_) * cells;
    const Eigen::Vector3d here = velocityAt(inCells, share_);
    return {inside(inCells - back * velocityAt(inside(inCells - 0.5 * back * here), 0.5 * share_)),
            inside(inCells + forth * velocityAt(inside(inCells + 0.5 * forth * here), 0.5 * (1 + share_)))};
  }
  /// At `share` of the way between the frames; of the one frame that knows it where the other does not.
  Eigen::Vector3d velocityAt(const Eigen::Vector3d& inCells, double share) const {
    const bool early = isKnown(frames_.before, inCells), late = isKnown(frames_.after, inCells);
    if (early && !late) return faceVelocityAt(frames_.before.velocity, inCells);
    if (late && !early) return faceVelocityAt(frames_.after.velocity, inCells);
    return (1 - share) * faceVelocityAt(frames_.before.velocity, inCells) +
           share * faceVelocityAt(frames_.after.velocity, inCells);
  }
  /// Du/Dt along the paths [m/s^2]; what leaves the liquid or joins it falls freely.
  double rateOfChange(int axis, const Meeting& m) const {
    const bool stays =
        phiOf(frames_.before, m.upstream) < grid_.dx && phiOf(frames_.after, m.downstream) < grid_.dx;
    return stays ? (faceValue(frames_.after.velocity, axis, m.downstream) -
                    faceValue(frames_.before.velocity, axis, m.upstream)) /
                       frames_.interval
                 : gravity_[axis];
  }
  static double faceValue(const fluid::MacField<float>& faces, int axis, const Eigen::Vector3d& inCells) {
    return interpolateAt(faces[axis], firstFace(axis), inCells);
  }
  bool isKnown(const fluid::LiquidState& liquid, const Eigen::Vector3d& inCells) const {
    return phiOf(liquid, inCells) < kKnownBand * grid_.dx;
  }
  static double phiOf(const fluid::LiquidState& liquid, const Eigen::Vector3d& inCells) {
    return interpolateAt(liquid.phi, firstCentre(), inCells);
  }
  Eigen::Vector3d inside(const Eigen::Vector3d& inCells) const {
    return inCells.cwiseMax(0).cwiseMin(grid_.cells.cast<double>());
  }

  const FramePair& frames_;
  const fluid::GridSpec& grid_;
  const double share_, density_;
  const Eigen::Vector3d gravity_;
};

}  // namespace

void blendFrames(const FramePair& frames, double share, double density, const Eigen::Vector3d& gravity,
                 fluid::LiquidState& now) {
  const Blender blender(frames, share, density, gravity);
  fluid::forEachCell(now.grid.cells, [&](int i, int j, int k) {
    now.phi(i, j, k) = static_cast<float>(blender.phiAt(Eigen::Vector3d(i, j, k) + firstCentre()));
  });
  for (int axis = 0; axis < 3; ++axis)
    fluid::forEachCell(now.velocity[axis].size(), [&](int i, int j, int k) {
      blender.faceAt(axis, Eigen::Vector3d(i, j, k) + firstFace(axis), now.velocity[axis](i, j, k),
                     now.pressureGradient[axis](i, j, k));
    });
}

}  // namespace spume::coupling
