#include "foam/foam_solver.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "foam/attraction.h"
#include "foam/border_drift.h"
#include "foam/classification.h"
#include "foam/integrator.h"
#include "foam/kept_geometry.h"
#include "foam/lifetime.h"
#include "foam/near_walls.h"
#include "foam/neighbours.h"
#include "foam/order_statistic.h"
#include "foam/parallel.h"
#include "foam/space_order.h"
#include "foam/stage_clock.h"
#include "foam/step_checks.h"
#include "foam/step_summary.h"
#include "foam/surroundings.h"
#include "foam/volume_correction.h"
#include "foam/volume_patch.h"
#include "foam/wall_cells.h"
#include "foam/wall_limit.h"

namespace spume::foam {
namespace {

/// Most times the volumes are corrected at the end of a step of `newton`: the first two bring errors of 10 %
/// to 0.1 % but where cells appear or vanish, which is left to patches.
constexpr int kVolumePasses = 5;
/// Share of the cells that a patch may begin with; more are corrected with all others. About where both cost
/// the same: once all have been corrected the others stay as they are; before, they are as near the tolerance
/// as chance has it, and what a patch corrects puts some of them off it in turn.
constexpr double kFewCells = 0.05, kFewAtFirst = 0.01;

/// Share of the pairs that may move faster than the step resolves: bubbles that rise into a pile. Contacts
/// are implicit and stop them within a step of any length; a froth that moves as a whole is more than these.
constexpr double kArrivals = 0.05;

}  // namespace

struct FoamSolver::Internals {
  explicit Internals(FoamParams p)
      : params((p.validate(), std::move(p))), integrator(params), cells(params.connectivity) {}

  FoamParams params;
  Integrator integrator;
  WallCells cells;
  VolumePatch patch;
  KeptGeometry kept;  ///< of the last step's end; what comes of it does not depend on it
  FoamTopology topology;
  std::vector<std::uint64_t> topologyId;  ///< ids of the topology's rows
  Neighbours neighbours;
  Surroundings around;
  std::vector<double> widest;  ///< largest radius of each bubble in this step, where walls are near [m]
  WallSearch wallSearch;
  std::vector<NearWalls> walls;
  BorderDrift drift;
  Attraction attraction;
  Vectors3 pull;
  Eigen::VectorXd phiEnd, psiEnd;
  Vectors3 dragImpulse;  ///< of each row
  std::vector<DragImpulse> impulses;
  /// The bubbles while they change, in space order: what is near in the foam is near in memory. The caller's
  /// stay whole until the end.
  BubbleStore next;
  std::vector<std::int32_t> order;  ///< the caller's row behind each row of `next`
  std::vector<std::int32_t> rowOf;  ///< row of `next` of each of the caller's, -1 once its life has ended
  BubbleStore living;               ///< scratch

  void take(const BubbleStore& bubbles);
  void giveBack(BubbleStore& bubbles);
  std::vector<std::ptrdiff_t> rowsOfTopology(const BubbleStore& bubbles) const;
  double largestRadius(std::size_t i) const;
  void findWalls(const LiquidSampler& liquid);
  void findReachableWalls(const LiquidSampler& liquid);
  void measure();
  void measureStart();
  void moveTogether(const LiquidSampler& liquid, double dt, FoamStepReport& report);
  void noteImpulses(double dt);
  void sampleEnd(const LiquidSampler& liquid);
  bool endLivesAndReport(double dt, FoamStepReport& report);
  std::vector<std::int32_t> livingRows() const;
  void removeEnded(bool hasEnded);
  void holdVolumes(const LiquidSampler& liquid);
  void reportClassChanges(const BubbleStore& before, FoamStepReport& report) const;
};

void FoamSolver::Internals::take(const BubbleStore& bubbles) {
  sortInSpace(bubbles.position, order);
  next.gather(bubbles, order);
  rowOf.resize(order.size());
  forEachIndex(order.size(), [&](std::size_t k) { rowOf[order[k]] = static_cast<std::int32_t>(k); });
}

void FoamSolver::Internals::giveBack(BubbleStore& bubbles) {
  std::erase(rowOf, -1);
  bubbles.gather(next, rowOf);
}

/// The row of `bubbles` behind each row of the topology, or -1. They have just been given back as a rule, so
/// it is known where.
std::vector<std::ptrdiff_t> FoamSolver::Internals::rowsOfTopology(const BubbleStore& bubbles) const {
  std::vector<std::ptrdiff_t> rows(topologyId.size(), -1);
  for (std::size_t row = 0; row < rowOf.size(); ++row)
    if (static_cast<std::size_t>(rowOf[row]) < rows.size())
      rows[rowOf[row]] = static_cast<std::ptrdiff_t>(row);
  forEachIndex(rows.size(), [&](std::size_t k) {
    const auto row = static_cast<std::size_t>(rows[k]);
    if (row >= bubbles.size() || bubbles.id[row] != topologyId[k]) rows[k] = bubbles.find(topologyId[k]);
  });
  return rows;
}

/// Radius that bubble i may take, if it may then be cut by the nearest wall.
double FoamSolver::Internals::largestRadius(std::size_t i) const {
  const double psi = around.psi[static_cast<Eigen::Index>(i)], gas = next.gas[i];
  const bool isFar = ballVolume(std::max(psi, 0.0) / params.radiusLimit) > gas;  // found without a root
  return isFar ? next.radius[i] : std::max(next.radius[i], params.radiusLimit * gasRadius(gas));
}

/// Finds the walls that may cut a bubble, at any radius it may take.
void FoamSolver::Internals::findWalls(const LiquidSampler& liquid) {
  widest.resize(next.size());
  forEachIndex(next.size(), [&](std::size_t i) { widest[i] = largestRadius(i); });
  if (isAnyCutByWall(widest, around.psi))
    wallSearch.find(liquid, around, next, widest, walls);
  else
    walls.clear();
}

/// Finds the walls that a bubble may meet within the step, by its prediction.
void FoamSolver::Internals::findReachableWalls(const LiquidSampler& liquid) {
  if (walls.empty())
    wallSearch.find(liquid, around, next, integrator.reach(), walls);
  else
    wallSearch.findAgain(liquid, around, next, integrator.reach(), walls);
}

void FoamSolver::Internals::measure() {
  cells.compute(next, walls, topology);
  cells.listNeighbours(topology, neighbours);
  topologyId = next.id;
}

/// As measure(), by the local engine from what the last step has left.
void FoamSolver::Internals::measureStart() {
  const bool isLocal = params.connectivity == Connectivity::local;
  if (isLocal && kept.renew(next, walls, topology, neighbours))
    topologyId = next.id;
  else
    measure();
}

/// Corrects the radii where the bubbles have come to, until every cell holds its gas.
void FoamSolver::Internals::holdVolumes(const LiquidSampler& liquid) {
  around.sampleSolids(liquid, next.positions());
  findWalls(liquid);
  for (int pass = 0;; ++pass) {
    measure();
    noteVolumes(topology, next);
    const std::vector<std::int32_t> off = cellsOff(next, params.volumeTolerance);
    if (off.empty() || pass == kVolumePasses) break;
    const double few = pass == 0 ? kFewAtFirst : kFewCells;
    if (static_cast<double>(off.size()) > few * static_cast<double>(next.size()))
      projectVolumes(params, topology, neighbours, {}, next);
    else {
      patch.settle(params, walls, topology, neighbours, next);
      break;
    }
  }
  kept.note(next, walls);
}

/// Solves for all velocities at once, and goes along them.
void FoamSolver::Internals::moveTogether(const LiquidSampler& liquid, double dt, FoamStepReport& report) {
  const SolveReport solve = integrator.couple(next, topology, neighbours, walls, dt);
  report.solverIterations = solve.iterations, report.solverResidual = solve.residual;
  report.solverFellBack = solve.fellBack;
  integrator.advance(dt, next);
  drift.advance(next);
  requireSound(next, "after the implicit solve of a step", dt);
  report.pushedOut = keepOutOfSolids(liquid, next, psiEnd);
  report.kineticEnergy = integrator.kineticEnergy();
  noteImpulses(dt);
}

void FoamSolver::Internals::noteImpulses(double dt) {
  dragImpulse.resize(next.size());
  forEachIndex(next.size(), [&](std::size_t i) { dragImpulse[i] = integrator.dragImpulse(i, dt); });
  impulses.clear();
  for (std::size_t i = 0; i < next.size(); ++i)
    if (!dragImpulse[i].isZero(0)) impulses.push_back({next.position[i], dragImpulse[i], integrator.slip(i)});
}

void FoamSolver::Internals::sampleEnd(const LiquidSampler& liquid) {
  phiEnd.resize(static_cast<Eigen::Index>(next.size()));
  if (next.size() != 0) liquid.phi(next.positions(), phiEnd);
}

void FoamSolver::Internals::reportClassChanges(const BubbleStore& before, FoamStepReport& report) const {
  for (std::size_t row = 0; row < rowOf.size(); ++row)
    if (const std::int32_t i = rowOf[row]; i >= 0 && next.type[i] != before.type[row])
      report.events.push_back({FoamEventKind::classChange, next.id[i], 0, next.position[i], next.radius[i],
                               next.gas[i], next.age[i], before.type[row], next.type[i]});
}

/// Returns whether any life has ended.
bool FoamSolver::Internals::endLivesAndReport(double dt, FoamStepReport& report) {
  const auto supported = params.bursting ? supportedBubbles(topology, psiEnd, next)
                                         : std::vector<std::uint8_t>(next.size(), 1);  // nobody asks
  const auto ended = endLives(params, topology, supported, psiEnd, dt, next);
  for (const EndedLife& life : ended) {
    const std::size_t i = life.index;
    const bool merges = life.heir >= 0;
    rowOf[order[i]] = -1;
    report.events.push_back({merges ? FoamEventKind::merge : FoamEventKind::burst, next.id[i],
                             merges ? next.id[life.heir] : 0, next.position[i], next.radius[i], next.gas[i],
                             life.age, next.type[i], next.type[i], !supported[i]});
    if (merges)
      coalesce(i, static_cast<std::size_t>(life.heir), integrator.mass(), next);
    else
      report.gasBurst += next.gas[i];
  }
  return !ended.empty();
}

/// The rows that are left; where volumes are held, in the order in which the next step will take them, so
/// that it can use the geometry that is measured of them.
std::vector<std::int32_t> FoamSolver::Internals::livingRows() const {
  std::vector<std::int32_t> rows;
  if (!holdsVolumes(params)) {
    for (std::size_t i = 0; i < next.size(); ++i)
      if (rowOf[order[i]] >= 0) rows.push_back(static_cast<std::int32_t>(i));
    return rows;
  }
  std::vector<std::int32_t> living, place;
  for (const std::int32_t row : rowOf)
    if (row >= 0) living.push_back(row);
  std::vector<Eigen::Vector3d> at(living.size());
  for (std::size_t k = 0; k < living.size(); ++k) at[k] = next.position[living[k]];
  sortInSpace(at, place);
  for (const std::int32_t k : place) rows.push_back(living[k]);
  return rows;
}

/// Drops the rows of ended lives, so that the others' cells take their places before they are measured.
void FoamSolver::Internals::removeEnded(bool hasEnded) {
  if (!hasEnded && !holdsVolumes(params)) return;  // rows stay where they are
  const std::vector<std::int32_t> rows = livingRows();
  living.gather(next, rows);
  std::swap(next, living);
  const std::vector<std::int32_t> former = order;
  const Eigen::VectorXd phi = phiEnd;
  order.resize(rows.size()), phiEnd.resize(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    order[k] = former[rows[k]], phiEnd[k] = phi[rows[k]];
    rowOf[order[k]] = static_cast<std::int32_t>(k);
  }
}

FoamSolver::FoamSolver(FoamParams params) : internals_(std::make_unique<Internals>(std::move(params))) {}
FoamSolver::~FoamSolver() = default;
const std::vector<DragImpulse>& FoamSolver::dragImpulses() const { return internals_->impulses; }
const FoamTopology& FoamSolver::topology() const { return internals_->topology; }
const std::vector<std::uint64_t>& FoamSolver::topologyIds() const { return internals_->topologyId; }
const FoamParams& FoamSolver::params() const { return internals_->params; }

FoamStepReport FoamSolver::step(BubbleStore& bubbles, const LiquidSampler& liquid, double dt) {
  requireUsable(bubbles, dt);
  FoamStepReport report;
  StageClock clock(report.stages);
  Internals& s = *internals_;
  s.take(bubbles);
  s.around.sample(liquid, s.next.positions());
  clock.end("sample");
  s.findWalls(liquid);
  s.measureStart();
  clock.end("geometry");
  s.drift.find(s.params, s.around, s.topology, s.neighbours, s.walls, s.next, dt);
  clock.end("borders");
  correctVolumes(s.params, s.topology, dt, s.next);
  clock.end("volume");
  weighSurface(s.around, s.topology, s.neighbours, s.next);
  clock.end("classes");
  s.attraction.compute(s.params, s.next, s.around, liquid, s.topology, s.pull);
  clock.end("attraction");
  s.integrator.predict(s.around, s.pull, dt, s.next);
  s.findReachableWalls(liquid);
  clock.end("predict");
  s.moveTogether(liquid, dt, report);
  clock.end("solve");
  s.sampleEnd(liquid);
  relabel(s.phiEnd, s.next);
  s.removeEnded(s.endLivesAndReport(dt, report));
  clock.end("events");
  if (holdsVolumes(s.params)) s.holdVolumes(liquid);
  clock.end("volume");
  relabel(s.phiEnd, s.next);  // again: labels depend on radii
  s.reportClassChanges(bubbles, report);
  clock.end("events");
  s.giveBack(bubbles);
  summarise(bubbles, s.topology, report);
  return report;
}

double FoamSolver::stableDt(const BubbleStore& bubbles) const {
  const Internals& s = *internals_;
  const std::vector<std::ptrdiff_t> row = s.rowsOfTopology(bubbles);
  constexpr double kAny = std::numeric_limits<double>::max();
  std::vector<double> allowed(s.topology.overlaps.size());
  forEachIndex(allowed.size(), [&](std::size_t p) {
    const std::ptrdiff_t i = row[s.topology.overlaps[p].i], j = row[s.topology.overlaps[p].j];
    const double motion = i < 0 || j < 0 ? 0 : (bubbles.velocity[i] - bubbles.velocity[j]).norm();
    allowed[p] = motion > 0 ? 0.5 * std::min(bubbles.radius[i], bubbles.radius[j]) / motion : kAny;
  });
  if (allowed.empty()) return kAny;
  return orderStatistic(allowed, static_cast<std::size_t>(kArrivals * static_cast<double>(allowed.size())));
}

}  // namespace spume::foam
