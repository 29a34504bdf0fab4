#include "foam/foam_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "foam/attraction.h"
#include "foam/classification.h"
#include "foam/errors.h"
#include "foam/integrator.h"
#include "foam/lifetime.h"
#include "foam/near_walls.h"
#include "foam/neighbours.h"
#include "foam/parallel.h"
#include "foam/surroundings.h"
#include "foam/volume_correction.h"
#include "foam/wall_cells.h"
#include "foam/wall_limit.h"

namespace spume::foam {
namespace {

/// Most times the volumes are corrected at the end of a step of `newton`: errors of 10 % are 1e-8 after
/// three.
constexpr int kVolumePasses = 5;

/// Notes the wall time of each stage as it ends; a name that comes again adds to its first.
class StageClock {
 public:
  explicit StageClock(std::vector<FoamStageTime>& stages) : stages_(stages), last_(Clock::now()) {}
  void end(const char* stage) {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - std::exchange(last_, now)).count();
    const auto known = std::find_if(stages_.begin(), stages_.end(),
                                    [&](const FoamStageTime& noted) { return noted.stage == stage; });
    if (known != stages_.end())
      known->seconds += seconds;
    else
      stages_.push_back({stage, seconds});
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::vector<FoamStageTime>& stages_;
  Clock::time_point last_;
};

void requireUsable(const BubbleStore& bubbles, double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw InvalidParameter("foam step: dt = " + std::to_string(dt) + " s; it must be positive and finite");
  for (std::size_t i = 0; i < bubbles.size(); ++i) {
    const bool finite = bubbles.position[i].allFinite() && bubbles.velocity[i].allFinite() &&
                        std::isfinite(bubbles.radius[i]) && std::isfinite(bubbles.gas[i]);
    if (!finite || bubbles.radius[i] <= 0 || bubbles.gas[i] <= 0)
      throw NumericalFailure("foam: bubble " + std::to_string(bubbles.id[i]) +
                             " has a position, velocity, radius or gas that is not finite, or no size");
  }
}

void requireFinite(const BubbleStore& bubbles) {
  for (std::size_t i = 0; i < bubbles.size(); ++i)
    if (!bubbles.position[i].allFinite() || !bubbles.velocity[i].allFinite())
      throw NumericalFailure("foam: the step left bubble " + std::to_string(bubbles.id[i]) +
                             " without a finite place");
}

}  // namespace

struct FoamSolver::Internals {
  explicit Internals(FoamParams p) : params((p.validate(), std::move(p))), integrator(params) {}

  FoamParams params;
  Integrator integrator;
  WallCells cells;
  FoamTopology topology;
  std::vector<std::uint64_t> topologyId;  ///< ids of the topology's rows
  Neighbours neighbours;
  Surroundings around;
  std::vector<NearWalls> walls;
  Attraction attraction;
  Vectors3 pull;
  Eigen::VectorXd phiEnd, psiEnd;
  BubbleStore next;  ///< the bubbles while they change: the caller's stay whole until the end

  void measure(const LiquidSampler& liquid);
  void holdVolumes(const LiquidSampler& liquid);
  void relabelAtEnd(const LiquidSampler& liquid);
  void endLivesAndReport(double dt, FoamStepReport& report);
  void summarise(FoamStepReport& report) const;
  void reportClassChanges(const BubbleStore& before, FoamStepReport& report) const;
};

void FoamSolver::Internals::measure(const LiquidSampler& liquid) {
  if (isAnyCutByWall(next, around.psi))
    findNearWalls(liquid, around, next, next.radius, walls);
  else
    walls.clear();
  cells.compute(next, walls, topology);
  topologyId = next.id;
  neighbours.build(next.size(), topology.overlaps);
}

/// Corrects the radii where the bubbles have come to, until every cell holds its gas.
void FoamSolver::Internals::holdVolumes(const LiquidSampler& liquid) {
  around.sample(liquid, next.positions());
  for (int pass = 0;; ++pass) {
    measure(liquid);
    noteVolumes(topology, next);
    if (pass == kVolumePasses || worstVolumeError(next) <= kVolumeTolerance) return;
    projectVolumes(params, topology, next);
  }
}

void FoamSolver::Internals::relabelAtEnd(const LiquidSampler& liquid) {
  phiEnd.resize(static_cast<Eigen::Index>(next.size())), psiEnd.resize(phiEnd.size());
  if (next.size() == 0) return;
  liquid.phi(next.positions(), phiEnd);
  liquid.psi(next.positions(), psiEnd);
  relabel(phiEnd, next);
}

void FoamSolver::Internals::reportClassChanges(const BubbleStore& before, FoamStepReport& report) const {
  for (std::size_t i = 0; i < next.size(); ++i)
    if (next.type[i] != before.type[i])
      report.events.push_back({FoamEventKind::classChange, next.id[i], 0, next.position[i], next.radius[i],
                               next.gas[i], next.age[i], before.type[i], next.type[i]});
}

void FoamSolver::Internals::endLivesAndReport(double dt, FoamStepReport& report) {
  const auto supported = supportedBubbles(topology, psiEnd, next);
  const auto ended = endLives(params, topology, supported, psiEnd, dt, next);
  if (ended.empty()) return;
  std::vector<std::uint8_t> gone(next.size(), 0);
  for (const EndedLife& life : ended) {
    const std::size_t i = life.index;
    const bool merges = life.heir >= 0;
    gone[i] = 1;
    report.events.push_back({merges ? FoamEventKind::merge : FoamEventKind::burst, next.id[i],
                             merges ? next.id[life.heir] : 0, next.position[i], next.radius[i], next.gas[i],
                             life.age, next.type[i], next.type[i], !supported[i]});
    if (merges)
      coalesce(i, static_cast<std::size_t>(life.heir), integrator.mass(), next);
    else
      report.gasBurst += next.gas[i];
  }
  next.remove(gone);
}

void FoamSolver::Internals::summarise(FoamStepReport& report) const {
  const std::size_t n = next.size();
  report.bubbles = n;
  report.contacts = topology.films.size(), report.overlaps = topology.overlaps.size();
  std::vector<double> error;
  for (std::size_t i = 0; i < n; ++i) {
    report.liquid += next.type[i] == BubbleClass::liquid,
        report.surface += next.type[i] == BubbleClass::surface;
    report.air += next.type[i] == BubbleClass::air;
    report.hidden += next.hidden[i], report.clamped += next.clamped[i];
    report.gas += next.gas[i];
    report.maxSpeed = std::max(report.maxSpeed, next.velocity[i].norm());
    if (!next.hidden[i] && !next.clamped[i]) error.push_back(std::abs(next.volume[i] / next.gas[i] - 1));
  }
  if (error.empty()) return;
  const auto middle = error.begin() + static_cast<std::ptrdiff_t>(error.size() / 2);
  std::nth_element(error.begin(), middle, error.end());
  report.volumeErrorMedian = *middle;
  report.volumeErrorMax = *std::max_element(middle, error.end());
}

FoamSolver::FoamSolver(FoamParams params) : internals_(std::make_unique<Internals>(std::move(params))) {}
FoamSolver::~FoamSolver() = default;
const FoamTopology& FoamSolver::topology() const { return internals_->topology; }
const FoamParams& FoamSolver::params() const { return internals_->params; }

FoamStepReport FoamSolver::step(BubbleStore& bubbles, const LiquidSampler& liquid, double dt) {
  requireUsable(bubbles, dt);
  FoamStepReport report;
  StageClock clock(report.stages);
  Internals& s = *internals_;
  s.next = bubbles;
  s.around.sample(liquid, s.next.positions());
  clock.end("sample");
  s.measure(liquid);
  clock.end("geometry");
  correctVolumes(s.params, s.topology, dt, s.next);
  clock.end("volume");
  weighSurface(s.around, s.topology, s.neighbours, s.next);
  clock.end("classes");
  s.attraction.compute(s.params, s.next, s.around, liquid, s.topology, s.pull);
  clock.end("attraction");
  s.integrator.describe(s.around, s.pull, s.next);
  s.integrator.predict(dt);
  findNearWalls(liquid, s.around, s.next, s.integrator.reach(dt), s.walls);
  clock.end("predict");
  const SolveReport solve = s.integrator.couple(s.next, s.topology, s.neighbours, s.walls, dt);
  clock.end("solve");
  s.integrator.advance(dt, s.next);
  requireFinite(s.next);
  report.pushedOut = keepOutOfSolids(liquid, s.next);
  if (holdsVolumes(s.params)) s.holdVolumes(liquid);
  clock.end("volume");
  s.relabelAtEnd(liquid);
  s.reportClassChanges(bubbles, report);
  report.kineticEnergy = s.integrator.kineticEnergy();
  s.endLivesAndReport(dt, report);
  clock.end("events");
  report.solverIterations = solve.iterations, report.solverResidual = solve.residual;
  report.solverFellBack = solve.fellBack;
  s.summarise(report);
  std::swap(bubbles, s.next);
  return report;
}

double FoamSolver::stableDt(const BubbleStore& bubbles) const {
  const Internals& s = *internals_;
  std::vector<std::ptrdiff_t> row(s.topologyId.size());
  for (std::size_t k = 0; k < row.size(); ++k) row[k] = bubbles.find(s.topologyId[k]);
  const auto pairDt = [&](std::size_t p) {
    const OverlapPair& pair = s.topology.overlaps[p];
    const std::ptrdiff_t i = row[pair.i], j = row[pair.j];
    if (i < 0 || j < 0) return std::numeric_limits<double>::max();
    const double motion = (bubbles.velocity[i] - bubbles.velocity[j]).norm();
    const double allowed = 0.5 * std::min(bubbles.radius[i], bubbles.radius[j]);
    return motion > 0 ? allowed / motion : std::numeric_limits<double>::max();
  };
  return reduceIndices(s.topology.overlaps.size(), std::numeric_limits<double>::max(), pairDt,
                       [](double a, double b) { return std::min(a, b); });
}

}  // namespace spume::foam
