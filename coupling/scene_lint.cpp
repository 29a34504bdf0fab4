#include "coupling/scene_lint.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include "coupling/object_label.h"
#include "coupling/scene_builder.h"
#include "coupling/scene_volumes.h"
#include "coupling/shapes.h"

namespace spume::coupling {
namespace {

constexpr double kWallCells = 1;            // thinnest solid that cannot leak [dx]
constexpr double kOverlapCells = 0.25;      // depth from which two solids in the same place overlap [dx]
constexpr double kRoundOff = 1e-9;          // of a wall as thick as a cell
constexpr double kNozzleCells = 2;          // least radius of a round jet [dx]
constexpr double kLargeBubbleCells = 1;     // radius above which a bubble spans several cells [dx]
constexpr double kBubblesPerBlock = 0.125;  // gas of a typical bubble over the volume of a reservoir block
constexpr double kGentleImpact = 0.2;       // below this even landing drops and soft jets entrain [m/s]
constexpr double kDryShare = 1e-4;          // smallest share of air in the domain that is worth running

class Linter {
 public:
  explicit Linter(const Scene& scene) : scene_(scene), dx_(scene.dx()) {}

  std::vector<Finding> lint() {
    lintSolids();
    lintInflows();
    lintProbes();
    lintBubbles();
    lintSupply();
    lintSteps();
    lintLiquid();
    std::stable_sort(findings_.begin(), findings_.end(),
                     [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
    return std::move(findings_);
  }

 private:
  template <typename... Parts>
  void add(Severity severity, const std::string& object, const Parts&... parts) {
    std::ostringstream message;
    message.precision(3);
    (message << ... << parts);
    findings_.push_back({severity, object, message.str()});
  }

  void lintSolids() {
    if (scene_.solids.empty()) return;
    const fluid::LiquidSetup setup = buildLiquidSetup(scene_);
    std::vector<SolidSample> samples = sampleSolids(setup);
    for (std::size_t i = 0; i < scene_.solids.size(); ++i) {
      const bool fromFile = isFromFile(scene_.solids[i].shape.kind);
      lintWall(i, fromFile ? 2 * samples[i].depth : thickness(scene_.solids[i].shape));
      for (const std::size_t other : samples[i].overlaps)
        add(Severity::warning, solidLabel(i), "overlaps ", solidLabel(other),
            ": they act as one solid with the velocity of the nearer; move them apart if that is not meant");
    }
  }

  std::string solidLabel(std::size_t i) const { return objectLabel("solid", scene_.solids[i].name, i); }

  void lintWall(std::size_t i, double wall) {
    if (wall < kWallCells * (1 - kRoundOff) * dx_)
      add(Severity::warning, solidLabel(i), "is ", wall, " m thin, under one cell of ", dx_,
          " m: liquid may leak through; use a resolution of at least ",
          std::ceil(scene_.domain.size.maxCoeff() / wall));
  }

  /// What a lattice of points, two a cell, says about a solid at the start.
  struct SolidSample {
    double depth = 0;  ///< the deepest of them lies [m]
    std::set<std::size_t> overlaps;
  };
  std::vector<SolidSample> sampleSolids(const fluid::LiquidSetup& setup) const {
    std::vector<SolidSample> samples(setup.solids.size());
    std::vector<SignedDistance> psi;
    for (const fluid::SolidObject& solid : setup.solids) psi.push_back(solid.frozen(0));
    const Eigen::Vector3i points = 2 * setup.grid.cells;
    for (int i = 0; i <= points.x(); ++i)
      for (int j = 0; j <= points.y(); ++j)
        for (int k = 0; k <= points.z(); ++k)
          noteDepths(psi, setup.grid.toWorld(0.5 * Eigen::Vector3d(i, j, k)), samples);
    return samples;
  }
  void noteDepths(const std::vector<SignedDistance>& psi, const Eigen::Vector3d& x,
                  std::vector<SolidSample>& samples) const {
    std::size_t first = psi.size();
    for (std::size_t n = 0; n < psi.size(); ++n) {
      const double depth = -psi[n](x);
      samples[n].depth = std::max(samples[n].depth, depth);
      if (depth < kOverlapCells * dx_) continue;
      if (first < n) samples[first].overlaps.insert(n);
      first = std::min(first, n);
    }
  }

  void lintInflows() {
    for (std::size_t i = 0; i < scene_.inflows.size(); ++i) {
      const InflowSpec& inflow = scene_.inflows[i];
      const std::string object = objectLabel("inflow", inflow.name, i);
      if (inflow.radius < kNozzleCells * dx_)
        add(Severity::warning, object, "has a radius of ", inflow.radius / dx_,
            " cells: the jet will be square; 2 or more are round");
      const double length = inflow.speed.largest() * scene_.time.minDt;
      const double allowed = scene_.liquid.cfl * scene_.time.maxSubSteps * dx_;
      if (length > allowed)
        add(Severity::warning, object, "moves ", length / dx_, " cells in the shortest step of ",
            scene_.time.minDt, " s, more than liquid.cfl times time.max_substeps = ", allowed / dx_,
            ": the liquid will take more sub-steps; lower time.min_step");
      if (inflow.start >= scene_.time.frames / scene_.time.fps)
        add(Severity::note, object, "opens at ", inflow.start, " s, after the last frame");
    }
  }

  void lintProbes() {
    if (scene_.probes.empty() || scene_.solids.empty()) return;
    const SignedDistance psi = solidDistance(scene_);
    for (std::size_t i = 0; i < scene_.probes.size(); ++i)
      if (scene_.probes[i].kind != ProbeKind::volume && psi(scene_.probes[i].position) < 0)
        add(Severity::warning, objectLabel("probe", scene_.probes[i].name, i),
            "lies in a solid at the start: it reads no liquid there");
  }

  void lintBubbles() {
    const EntrainmentSpec& births = scene_.coupling.entrainment;
    double largest = births.enabled ? births.maxRadius : 0;
    for (const BubblesSpec& bubbles : scene_.bubbles) largest = std::max(largest, bubbles.bubble.radius);
    for (const BubbleSourceSpec& source : scene_.bubbleSources)
      largest = std::max(largest, source.radius.most);
    if (largest > kLargeBubbleCells * dx_)
      add(Severity::warning, "bubbles", "reach a radius of ", largest / dx_,
          " cells: the liquid changes across them, yet is sampled at their centre; use smaller bubbles or a "
          "lower "
          "resolution");
    const double typical = 4 * std::numbers::pi / 3 * std::pow(births.medianRadius, 3);
    if (births.enabled && typical > kBubblesPerBlock * std::pow(births.blockSize, 3))
      add(Severity::note, "coupling.entrainment.block_size", births.blockSize,
          " m is small for bubbles of radius ", births.medianRadius, " m: gas waits long for a whole bubble");
    if (births.enabled && births.onset < kGentleImpact)
      add(Severity::note, "coupling.entrainment.onset", births.onset, " m/s: below ", kGentleImpact,
          " m/s even landing drops and soft jets make bubbles");
  }

  void lintSupply() {
    const double end = scene_.time.frames / scene_.time.fps;
    for (std::size_t i = 0; i < scene_.bubbleSources.size(); ++i)
      if (scene_.bubbleSources[i].start >= end)
        add(Severity::note, objectLabel("bubble_source", scene_.bubbleSources[i].name, i), "starts at ",
            scene_.bubbleSources[i].start, " s, after the last frame");
    for (std::size_t i = 0; i < scene_.nucleation.size(); ++i) lintNucleation(i);
    const double saturation = scene_.dissolvedGas.henry * scene_.dissolvedGas.pressure;
    if (scene_.dissolvedGas.enabled && scene_.dissolvedGas.concentration < saturation)
      add(Severity::note, "dissolved_gas.concentration", scene_.dissolvedGas.concentration,
          " mol/m^3 is under the saturation of ", saturation, ": bubbles shrink");
  }

  /// A bubble that a solid holds and that does not grow blocks its site for ever.
  void lintNucleation(std::size_t i) {
    const NucleationSpec& spec = scene_.nucleation[i];
    double holds = scene_.foam.walls.detachRadius;
    for (const SolidSpec& solid : scene_.solids)
      if (solid.name == spec.solid || spec.solid.empty()) holds = std::max(holds, solid.surface.detachRadius);
    if (!scene_.dissolvedGas.enabled && holds > spec.radius.least)
      add(Severity::warning, objectLabel("nucleation", spec.name, i), "makes bubbles of radius ",
          spec.radius.least, " m on solids that hold them up to ", holds,
          " m, and nothing makes them grow: enable dissolved_gas or lower detach_radius");
  }

  void lintSteps() {
    const double frame = 1 / scene_.time.fps;
    if (scene_.time.minDt > frame)
      add(Severity::note, "time.min_step", scene_.time.minDt, " s is longer than a frame of ", frame,
          " s: frames end steps, so steps are as long as frames");
  }

  void lintLiquid() {
    if (scene_.stillPool.enabled) return lintPool();
    const double share = initialWetShare(scene_);
    if (scene_.liquidBodies.empty() && scene_.inflows.empty())
      add(Severity::warning, "scene", "has no liquid: neither [[liquid_body]] nor [[inflow]]");
    if (share > 1 - kDryShare)
      add(Severity::warning, "domain", "is full of liquid: there is no surface for bubbles to gather at");
    const double end = scene_.time.frames / scene_.time.fps;
    const double room = (1 - share) * scene_.domain.size.prod();
    const bool closed =
        std::all_of(scene_.domain.closed.begin(), scene_.domain.closed.end(), [](bool c) { return c; });
    if (pouredUntil(scene_, end) > room)
      add(Severity::warning, "inflow", "pours ", pouredUntil(scene_, end), " m^3 into ", room,
          " m^3 of air: ", closed ? "the closed domain will be over-full" : "it will run over");
    if (closed && !scene_.inflows.empty())
      add(Severity::warning, "domain.walls",
          "are all closed while liquid is poured in: the air cannot leave");
  }

  void lintPool() {
    const Eigen::Vector3d g = scene_.liquid.gravity,
                          up = g.norm() > 0 ? Eigen::Vector3d(-g.normalized()) : Eigen::Vector3d::UnitY();
    const Eigen::Vector3d low = scene_.domain.lower, high = low + scene_.domain.size;
    double bottom = 0, top = 0;
    for (int axis = 0; axis < 3; ++axis) {
      bottom += std::min(up[axis] * low[axis], up[axis] * high[axis]);
      top += std::max(up[axis] * low[axis], up[axis] * high[axis]);
    }
    if (scene_.stillPool.level < bottom || scene_.stillPool.level > top)
      add(Severity::note, "still_pool.level", scene_.stillPool.level,
          " m lies outside the domain, which goes from ", bottom, " to ", top,
          " m: there is no surface in it");
    if (scene_.coupling.twoWay)
      add(Severity::note, "coupling.two_way", "true does nothing: the liquid of a still pool does not move");
  }

  const Scene& scene_;
  double dx_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> lintScene(const Scene& scene) { return Linter(scene).lint(); }

}  // namespace spume::coupling
