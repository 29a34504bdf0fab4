#include "coupling/solid_lint.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "coupling/object_label.h"
#include "coupling/scene_builder.h"
#include "coupling/shapes.h"
#include "coupling/solid_motion.h"

namespace spume::coupling {
namespace {

constexpr double kWallCells = 1;        // thinnest solid that cannot leak [dx]
constexpr double kOverlapCells = 0.25;  // depth from which two solids in the same place overlap [dx]
constexpr double kRoundOff = 1e-9;      // of a wall as thick as a cell

/// What a lattice of points, two a cell, says about a solid at the start.
struct SolidSample {
  double depth = 0;  ///< the deepest of them lies [m]; 0: none is in it
  std::set<std::size_t> overlaps;
  Eigen::AlignedBox3d box;  ///< around those in it
};

class SolidLinter {
 public:
  SolidLinter(const Scene& scene, FindingList& findings)
      : scene_(scene), dx_(scene.dx()), findings_(findings), samples_(sampled()) {}

  void lint() {
    for (std::size_t i = 0; i < scene_.solids.size(); ++i) {
      lintPlace(i);
      lintMotion(i);
      for (const std::size_t other : samples_[i].overlaps)
        findings_.warn(
            label(i), "overlaps ", label(other),
            ": they act as one solid with the velocity of the nearer; move them apart if that is not meant");
    }
  }

 private:
  std::string label(std::size_t i) const { return objectLabel("solid", scene_.solids[i].name, i); }

  std::vector<SolidSample> sampled() const {
    const std::vector<SignedDistance> psi = solidDistances(scene_, 0);
    const fluid::GridSpec grid = gridOf(scene_);
    std::vector<SolidSample> samples(psi.size());
    const Eigen::Vector3i points = 2 * grid.cells;
    for (int i = 0; i <= points.x(); ++i)
      for (int j = 0; j <= points.y(); ++j)
        for (int k = 0; k <= points.z(); ++k)
          noteDepths(psi, grid.toWorld(0.5 * Eigen::Vector3d(i, j, k)), samples);
    return samples;
  }

  void noteDepths(const std::vector<SignedDistance>& psi, const Eigen::Vector3d& x,
                  std::vector<SolidSample>& samples) const {
    std::size_t first = psi.size();
    for (std::size_t n = 0; n < psi.size(); ++n) {
      const double depth = -psi[n](x);
      if (depth <= 0) continue;
      samples[n].depth = std::max(samples[n].depth, depth);
      samples[n].box.extend(x);
      if (depth < kOverlapCells * dx_) continue;
      if (first < n) samples[first].overlaps.insert(n);
      first = std::min(first, n);
    }
  }

  /// A solid from a file is as thick as the lattice finds it, which is at most a cell off.
  void lintPlace(std::size_t i) {
    const SolidSpec& solid = scene_.solids[i];
    const bool fromFile = isFromFile(solid.shape.kind);
    if (samples_[i].depth == 0 && !moves(solid.motion))
      return findings_.warn(label(i),
                            "holds no point of the grid: it lies outside the domain or is smaller "
                            "than a cell, so it does nothing; check its place",
                            fromFile ? " and its scale [m per unit of the file]" : "");
    if (fromFile && samples_[i].depth == 0) return;  // comes in later
    const double wall = fromFile ? 2 * samples_[i].depth : thickness(solid.shape);
    if (wall >= kWallCells * (1 - kRoundOff) * dx_) return;
    if (fromFile)
      return findings_.warn(label(i), "is thinner than a cell of ", dx_,
                            " m, or nearly so: liquid may leak through; raise domain.resolution");
    findings_.warn(label(i), "is ", wall, " m thin, under one cell of ", dx_,
                   " m: liquid may leak through; use a resolution of at least ",
                   std::ceil(scene_.domain.size.maxCoeff() / wall));
  }

  /// The times of all keys of the motion up to the end of the run.
  std::set<double> keyTimes(const MotionSpec& motion) const {
    const double end = scene_.time.frames / scene_.time.fps;
    std::set<double> times;
    const auto collect = [&](const auto& keys) {
      for (const auto& [time, value] : keys) times.insert(std::clamp(time, 0.0, end));
    };
    collect(motion.position.keys);
    collect(motion.rotation.keys);
    return times;
  }

  /// Speed of the fastest corner of its box in the stretch of keys that ends at t [m/s].
  double speedAt(const MotionSpec& motion, const Eigen::AlignedBox3d& box, double t) const {
    if (box.isEmpty()) return motion.position.rate(t).norm();
    const Pose start = poseAt(motion, 0), now = poseAt(motion, t);
    double fastest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d placed =
          start.toPlaced(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
      fastest = std::max(fastest, velocityAt(motion, now.toWorld(placed), t).norm());
    }
    return fastest;
  }

  void lintMotion(std::size_t i) {
    const MotionSpec& motion = scene_.solids[i].motion;
    if (!moves(motion)) return;
    double last = 0, fastest = 0;
    for (const double time : keyTimes(motion)) {
      const double speed = speedAt(motion, samples_[i].box, time);
      if (time - last > 0 && time - last < scene_.time.minDt && speed * (time - last) > dx_)
        return findings_.warn(label(i), "moves ", speed * (time - last) / dx_, " cells between its keys at ",
                              last, " and ", time, " s, less than the shortest step of ", scene_.time.minDt,
                              " s: liquid in its way is passed over; spread the keys or lower time.min_step");
      fastest = std::max(fastest, speed);
      last = time;
    }
    if (fastest * scene_.time.minDt > scene_.time.maxSubSteps * dx_)
      findings_.warn(
          label(i), "moves at up to ", fastest, " m/s, ", fastest * scene_.time.minDt / dx_,
          " cells in the shortest step of ", scene_.time.minDt,
          " s: the liquid takes a sub-step for each, and what it sweeps that fast breaks up; lower "
          "time.min_step or slow it down");
  }

  const Scene& scene_;
  double dx_;
  FindingList& findings_;
  std::vector<SolidSample> samples_;
};

}  // namespace

void lintSolids(const Scene& scene, FindingList& findings) {
  if (!scene.solids.empty()) SolidLinter(scene, findings).lint();
}

}  // namespace spume::coupling
