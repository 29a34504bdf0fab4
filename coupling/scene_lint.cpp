#include "coupling/scene_lint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "coupling/bubble_sources.h"
#include "coupling/domain_box.h"
#include "coupling/finding_list.h"
#include "coupling/first_bubbles.h"
#include "coupling/foam_objects.h"
#include "coupling/object_label.h"
#include "coupling/room_lint.h"
#include "coupling/scene_builder.h"
#include "coupling/scene_volumes.h"
#include "coupling/solid_lint.h"
#include "coupling/unused_keys.h"
#include "foam/volume_correction.h"

namespace spume::coupling {
namespace {

constexpr double kNozzleCells = 2;          // least radius of a round jet [dx]
constexpr double kLargeBubbleCells = 1;     // radius above which a bubble spans several cells [dx]
constexpr double kBubblesPerBlock = 0.125;  // gas of a typical bubble over the volume of a reservoir block
constexpr double kCrowd = 20;               // gas of the first bubbles over the room they share
constexpr double kManySites = 1e6;          // of nucleation that are slow to make
constexpr double kGentleImpact = 0.2;       // below this even landing drops and soft jets entrain [m/s]
constexpr double kLeastRoom = 0.5;          // of a source outside solids: most of it
constexpr double kDryShare = 1e-4;          // smallest share of air in the domain that is worth running

class Linter {
 public:
  explicit Linter(const Scene& scene) : scene_(scene), domain_(scene), dx_(scene.dx()) {}

  std::vector<Finding> lint() {
    lintRoom(scene_, findings_);
    lintSolids(scene_, findings_);
    lintInflows();
    lintProbes();
    lintBubbles();
    lintSupply();
    lintSteps();
    lintLiquid();
    noteUnusedKeys(scene_, findings_);
    return findings_.take();
  }

 private:
  void lintInflows() {
    for (std::size_t i = 0; i < scene_.inflows.size(); ++i) {
      const InflowSpec& inflow = scene_.inflows[i];
      const std::string object = objectLabel("inflow", inflow.name, i);
      if (inflow.radius < kNozzleCells * dx_)
        findings_.warn(object, "has a radius of ", inflow.radius / dx_,
                       " cells: the jet will be square; 2 or more are round");
      const double length = inflow.speed.largest() * scene_.time.minDt;
      const double allowed = scene_.liquid.cfl * scene_.time.maxSubSteps * dx_;
      if (length > allowed)
        findings_.warn(object, "moves ", length / dx_, " cells in the shortest step of ", scene_.time.minDt,
                       " s, more than liquid.cfl times time.max_substeps = ", allowed / dx_,
                       ": the liquid will take more sub-steps; lower time.min_step");
      if (inflow.start >= scene_.time.frames / scene_.time.fps)
        findings_.note(object, "opens at ", inflow.start, " s, after the last frame");
    }
  }

  void lintProbes() {
    if (scene_.probes.empty() || scene_.solids.empty()) return;
    const SignedDistance psi = solidDistance(scene_);
    for (std::size_t i = 0; i < scene_.probes.size(); ++i)
      if (scene_.probes[i].kind != ProbeKind::volume && psi(scene_.probes[i].position) < 0)
        findings_.warn(objectLabel("probe", scene_.probes[i].name, i),
                       "lies in a solid at the start: it reads no liquid there");
  }

  void lintBubbles() {
    const EntrainmentSpec& births = scene_.coupling.entrainment;
    double largest = births.enabled ? births.maxRadius : 0;
    const FirstBubbles written(scene_);
    written.lint(findings_);
    const foam::BubbleStore first = written.store();
    for (const double radius : first.radius) largest = std::max(largest, radius);
    lintCrowd(first);
    for (const BubbleSourceSpec& source : scene_.bubbleSources)
      largest = std::max(largest, source.radius.most);
    if (!scene_.stillPool.enabled && largest > kLargeBubbleCells * dx_)
      findings_.warn(
          "bubbles", "reach a radius of ", largest / dx_,
          " cells: the liquid changes across them, yet is sampled at their centre; use smaller bubbles or a "
          "lower "
          "resolution");
    const double typical = foam::ballVolume(births.medianRadius);
    if (births.enabled && typical > kBubblesPerBlock * std::pow(births.blockSize, 3))
      findings_.note("coupling.entrainment.block_size", births.blockSize,
                     " m is small for bubbles of radius ", births.medianRadius,
                     " m: gas waits long for a whole bubble");
    if (births.enabled && births.onset < kGentleImpact)
      findings_.note("coupling.entrainment.onset", births.onset, " m/s: below ", kGentleImpact,
                     " m/s even landing drops and soft jets make bubbles");
  }

  /// Work grows with the overlaps: where many bubbles share one place a step may take minutes.
  void lintCrowd(const foam::BubbleStore& bubbles) {
    double widest = 0;
    for (const double radius : bubbles.radius) widest = std::max(widest, 2 * radius);
    std::map<std::array<double, 3>, double> volume;  // of the bubbles centred in blocks as wide as the widest
    for (std::size_t b = 0; b < bubbles.size(); ++b) {
      const Eigen::Array3d block = (bubbles.position[b].array() / widest).floor();
      volume[{block.x(), block.y(), block.z()}] += foam::ballVolume(bubbles.radius[b]);
    }
    for (const auto& [block, gas] : volume)
      if (gas > kCrowd * std::pow(widest, 3))
        return findings_.warn("bubbles", "near [", (block[0] + 0.5) * widest, ", ", (block[1] + 0.5) * widest,
                              ", ", (block[2] + 0.5) * widest, "] m are ", gas / std::pow(widest, 3),
                              " times as large as the room they share: the first steps will be very slow; "
                              "spread them, or let a [[bubble_source]] blow them in");
  }

  void lintSupply() {
    const double end = scene_.time.frames / scene_.time.fps;
    for (std::size_t i = 0; i < scene_.bubbleSources.size(); ++i)
      if (scene_.bubbleSources[i].start >= end)
        findings_.note(objectLabel("bubble_source", scene_.bubbleSources[i].name, i), "starts at ",
                       scene_.bubbleSources[i].start, " s, after the last frame");
    lintSourceRooms();
    for (std::size_t i = 0; i < scene_.nucleation.size(); ++i) lintNucleation(i);
    const double saturation = scene_.dissolvedGas.henry * scene_.dissolvedGas.pressure;
    if (scene_.dissolvedGas.enabled && scene_.dissolvedGas.concentration < saturation)
      findings_.note("dissolved_gas.concentration", scene_.dissolvedGas.concentration,
                     " mol/m^3 is under the saturation of ", saturation, ": bubbles shrink");
  }

  /// A bubble of which all places that are drawn lie in solids is left out.
  void lintSourceRooms() {
    if (scene_.solids.empty() || scene_.bubbleSources.empty()) return;
    const SignedDistance psi = solidDistance(scene_);
    for (std::size_t i = 0; i < scene_.bubbleSources.size(); ++i) {
      const double free = roomShare(scene_.bubbleSources[i].shape, domain_, psi);
      if (free < kLeastRoom)
        findings_.warn(objectLabel("bubble_source", scene_.bubbleSources[i].name, i), "has only ", 100 * free,
                       " % of its region outside solids: ", 100 * std::pow(1 - free, BubbleSources::kPlaces),
                       " % of its bubbles will find no place and be left out; move it or the solid");
    }
  }

  /// A bubble that a solid holds and that does not grow blocks its site for ever.
  void lintNucleation(std::size_t i) {
    const NucleationSpec& spec = scene_.nucleation[i];
    const double sites = spec.density * closedArea();
    if ((spec.solid.empty() || spec.solid == kWallsOfDomain) && sites > kManySites)
      findings_.warn(objectLabel("nucleation", spec.name, i), "scatters about ", sites,
                     " sites over the walls of the domain: each is a bubble every ", spec.waiting,
                     " s; lower its density [1/m^2]");
    double holds = scene_.foam.walls.detachRadius;
    for (const SolidSpec& solid : scene_.solids)
      if (solid.name == spec.solid || spec.solid.empty()) holds = std::max(holds, solid.surface.detachRadius);
    if (!scene_.dissolvedGas.enabled && holds > spec.radius.least)
      findings_.warn(objectLabel("nucleation", spec.name, i), "makes bubbles of radius ", spec.radius.least,
                     " m on solids that hold them up to ", holds,
                     " m, and nothing makes them grow: enable dissolved_gas or lower detach_radius");
  }

  double closedArea() const {
    const Eigen::Vector3d size = domain_.size();
    double area = 0;
    for (int side = 0; side < 6; ++side)
      if (scene_.domain.closed[side]) area += size.prod() / size[side / 2];
    return area;
  }

  void lintSteps() {
    const double frame = 1 / scene_.time.fps;
    if (scene_.time.minDt > frame)
      findings_.note("time.min_step", scene_.time.minDt, " s is longer than a frame of ", frame,
                     " s: frames end steps, so steps are as long as frames");
  }

  void lintLiquid() {
    if (scene_.stillPool.enabled) return lintPool();
    if (!scene_.liquidCache.run.empty()) return lintCache();
    const double share = initialWetShare(scene_);
    if (scene_.liquidBodies.empty() && scene_.inflows.empty())
      findings_.warn("scene", "has no liquid: neither [[liquid_body]] nor [[inflow]]");
    if (share > 1 - kDryShare)
      findings_.warn("domain", "is full of liquid: there is no surface for bubbles to gather at");
    const double end = scene_.time.frames / scene_.time.fps;
    const double room = (1 - share) * domain_.volume();
    const bool closed =
        std::all_of(scene_.domain.closed.begin(), scene_.domain.closed.end(), [](bool c) { return c; });
    if (pouredUntil(scene_, end) > room)
      findings_.warn("inflow", "pours ", pouredUntil(scene_, end), " m^3 into ", room,
                     " m^3 of air: ", closed ? "the closed domain will be over-full" : "it will run over");
    if (closed && !scene_.inflows.empty())
      findings_.warn("domain.walls", "are all closed while liquid is poured in: the air cannot leave");
  }

  void lintCache() {
    if (scene_.coupling.twoWay)
      findings_.note("coupling.two_way", "true does nothing: the cached liquid of ", scene_.liquidCache.run,
                     " moves as it did");
  }

  void lintPool() {
    const Eigen::Vector3d g = scene_.liquid.gravity,
                          up = g.norm() > 0 ? Eigen::Vector3d(-g.normalized()) : Eigen::Vector3d::UnitY();
    const Eigen::Vector3d &low = domain_.lower, &high = domain_.upper;
    double bottom = 0, top = 0;
    for (int axis = 0; axis < 3; ++axis) {
      bottom += std::min(up[axis] * low[axis], up[axis] * high[axis]);
      top += std::max(up[axis] * low[axis], up[axis] * high[axis]);
    }
    if (scene_.stillPool.level < bottom || scene_.stillPool.level > top)
      findings_.note("still_pool.level", scene_.stillPool.level,
                     " m lies outside the domain, which goes from ", bottom, " to ", top,
                     " m: there is no surface in it");
    if (scene_.coupling.twoWay)
      findings_.note("coupling.two_way", "true does nothing: the liquid of a still pool does not move");
  }

  const Scene& scene_;
  const DomainBox domain_;
  double dx_;
  FindingList findings_;
};

}  // namespace

std::vector<Finding> lintScene(const Scene& scene) { return Linter(scene).lint(); }

}  // namespace spume::coupling
