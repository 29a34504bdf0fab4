#include "fluid/liquid_stages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "fluid/errors.h"
#include "fluid/liquid_measures.h"
#include "fluid/open_boundary.h"
#include "fluid/parallel_copy.h"
#include "fluid/pocket_markers.h"
#include "fluid/specks.h"

namespace spume::fluid {
namespace {

/// Sub-steps between two looks at how much liquid each marker stands for: a thinning sheet changes it over
/// many. The air that a marker stands for is looked at in each: taken a few sub-steps before it goes under,
/// when it is still far above the surface, it is too much, and makes half as many births again in a pour.
constexpr int kSubStepsPerDropVolume = 4;

}  // namespace

LiquidStages::LiquidStages(FluidParams p, LiquidSetup s)
    : params(std::move(p)),
      setup(std::move(s)),
      solids(buildSolidBoundary(setup.grid, setup.walls, setup.solids, 0)),
      inflows(setup.grid, setup.inflows, params.seed),
      outflows(setup.grid, setup.outflows),
      levelSetAdvection(setup.grid),
      crowding(setup.grid),
      surfaceLift(setup.grid),
      reinitializer(setup.grid),
      velocityAdvector(setup.grid),
      acceleration(setup.grid),
      extrapolator(setup.grid),
      sorter(setup.grid),
      seeder(setup.grid),
      escape(setup.grid),
      drops(setup.grid),
      pocketBooks(setup.grid, params),
      volumeControl(setup.grid, params, &solids),
      wallSlip(setup.grid),
      viscosity(setup.grid, params),
      projection(setup.grid, params),
      source(setup.grid.cells),
      cellMark(setup.grid.cells, -1) {
  state.grid = setup.grid;
  solids.sides.walkReach = static_cast<int>(std::ceil(params.cfl)) + kStencilReach;
  params.gravity.cwiseAbs().maxCoeff(&solids.sides.upAxis);
  const double down = params.gravity[solids.sides.upAxis];
  solids.sides.upSense = (down < 0) - (down > 0);
  if (!setup.solids.empty()) solids.sides.find(solids);
}

void LiquidStages::start() {
  inflows.release(solids);  // what is rebuilt here knows walls and solids alone
  updateSolidBoundary(state.grid, setup.walls, setup.solids, state.time, solids);
  extension.rebuild(solids);
  wallSlip.rebuild(solids);
  surfaceStands = false;
  lastAdvance = 0;
  maxSpeed = carryingSpeed();
}

void LiquidStages::startPockets() {
  findPockets(state.time);
  pocketBooks.update(pockets, state.velocity, 0);
  state.volume = volumeControl.ledger();
  state.volume.pocketGas = pocketBooks.gas();
}

void LiquidStages::resumeControl() {
  if (state.subSteps > 0) inflows.resume(state.time, solids);  // else nothing has been poured yet
  bodies.find(state.grid, state.phi, solids);
  volumeControl.resume(bodies, state.volume);
  findPockets(state.time);
  pocketBooks.resume(pockets, state.volume.pocketGas);
}

/// What opens at the end of a step has to find itself open in its last sub-step, as in a run resumed from
/// there.
double LiquidStages::endOf(double dt) const {
  const double end = state.time + dt,
               roundOff = kRoundOff * dt + 4 * std::numeric_limits<double>::epsilon() * std::abs(stepEnd);
  return std::abs(stepEnd - end) <= roundOff ? stepEnd : end;
}

bool LiquidStages::solidsMove() const {
  return std::any_of(setup.solids.begin(), setup.solids.end(), [](const auto& s) { return s.moves; });
}

void LiquidStages::moveSolids(double dt) {
  if (!solidsMove()) return;
  psiBefore = solids.psi;
  if (!updateSolidBoundary(state.grid, setup.walls, setup.solids, endOf(dt), solids)) {
    if (extension.hasUncovered()) extension.rebuild(solids);  // as a resumed run has it
    return;
  }
  surfaceStands = false;
  extension.rebuild(solids, &psiBefore);
  wallSlip.rebuild(solids);
  extension.uncover(state.phi);
  extension.apply(state.phi);
}

/// Carries phi for dt [s], or for half of it where that saves liquid from an impact; returns the time taken.
double LiquidStages::carrySurface(double dt) {
  copyInParallel(state.velocity, surfaceVelocity);
  extrapolator.goOn(state.phi, solids, surfaceVelocity, surfaceStands);
  crowding.prepare(state.phi, solids, surfaceVelocity);
  copyInParallel(state.phi, phiBefore);
  const auto carry = [&](double time) {
    levelSetAdvection.advance(params.levelSetTransport, surfaceVelocity, time, state.phi, &solids);
    admitAir(state.grid, solids, surfaceVelocity, time, state.phi);
    crowding.find(state.phi, solids, surfaceVelocity, time);
  };
  carry(dt);
  if (!crowdsTooMuch(dt)) return dt;
  copyInParallel(phiBefore, state.phi);
  carry(0.5 * dt);
  return 0.5 * dt;
}

/// Carries surface and markers; returns the time taken.
double LiquidStages::transport(double asked, LiquidStepReport& report) {
  const double dt = carrySurface(asked);
  report.drained += volumeControl.bookOutflow(phiBefore, solids, state.velocity, dt);
  MarkerScene scene = markerScene();
  scene.objects = &setup.solids;
  scene.middle = state.time + 0.5 * dt;
  advectMarkers(scene, surfaceVelocity, dt, state.positive);
  advectMarkers(scene, surfaceVelocity, dt, state.negative);
  report.drained += outflows.empty(endOf(dt), solids, state.phi, state.negative, volumeControl);
  extension.apply(state.phi);
  sorter.compact(state.positive);
  sorter.compact(state.negative);
  return dt;
}

/// `flagsStand`: markers know already which of them have escaped.
void LiquidStages::correctSurface(bool flagsStand) {
  correction.apply(static_cast<float>(state.grid.dx), solids.sides, state.positive, state.negative, state.phi,
                   flagsStand);
  extension.apply(state.phi);
}

/// phi becomes a distance again, and liquid that transport has crowded gets room at the surface.
void LiquidStages::restoreDistance() {
  reinitializer.apply(state.phi, &solids);
  extension.apply(state.phi);
  if (crowding.cells().empty()) return;
  surfaceLift.apply(crowding.cells(), solids, state.phi, state.positive, state.negative);
  extension.apply(state.phi);
}

void LiquidStages::loseMarkers() {
  const MarkerScene scene = markerScene();
  escape.refreshGas(scene, state.phi, state.positive);
  escape.releaseEscaped(scene, state.phi, state.velocity, state.positive, escaped);
}

/// Drops fly on the new surface; those that land, and markers that fly off, move volume between the bodies
/// and the air.
void LiquidStages::moveDrops(double dt, LiquidStepReport& report) {
  const MarkerScene scene = markerScene();
  DropFlight flight = fly(scene, state.phi, dt, state.drops);
  landed = std::move(flight.landed);
  for (const Drop& drop : landed) volumeControl.deposit(drop.position, drop.volume);
  if (state.subSteps % kSubStepsPerDropVolume == 0)
    drops.refreshVolumes(scene, state.phi, state.positive, state.negative);
  launch(drops.launch(scene, state.phi, state.velocity, state.negative), report);
  report.landed += volumeOf(landed);
  report.drained += flight.left;
}

/// Drops get their volume from the bodies they leave.
void LiquidStages::launch(std::vector<Drop> launched, LiquidStepReport& report) {
  for (Drop& drop : launched) {
    drop.volume = volumeControl.withdraw(drop.position, drop.volume);
    if (!(drop.volume > 0)) continue;
    report.launched += drop.volume;
    drop.id = state.dropsEver++;
    state.drops.push_back(drop);
  }
}

void LiquidStages::reseed() {
  const MarkerScene scene = markerScene();
  adjustRadii(scene, state.phi, MarkerSign::positive, state.positive);
  adjustRadii(scene, state.phi, MarkerSign::negative, state.negative);
  if (state.subSteps % params.reseedInterval != 0) return;
  seeder.reseed(scene, state.phi, state.subSteps, state.positive, state.negative);
}

/// The pockets that are too large to be filled.
void LiquidStages::findPockets(double t) {
  pockets.find(state.grid, state.phi, solids, outflows.openCells(t));
  pockets.dropSmall();
}

void LiquidStages::fillPockets(double dt) {
  pockets.find(state.grid, state.phi, solids, outflows.openCells(endOf(dt)));
  const auto filled = pockets.fillSmall(state.grid, solids, state.velocity, state.phi);
  collapsePockets(markerScene(), filled, state.phi, state.velocity, sorter, cellMark, state.positive,
                  collapsed);
  pocketsFilled = !filled.empty();
}

void LiquidStages::pour(double dt, const ImmersedGas& gas, LiquidStepReport& report) {
  const std::vector<PouredVolume>& poured = inflows.stamp(endOf(dt), dt, state.phi, solids);
  for (const PouredVolume& p : poured) report.poured += p.volume;
  extension.apply(state.phi);
  findBodies(report);
  volumeControl.update(bodies, state.velocity, dt, poured, gas);
  if (pocketsFilled || inflows.reshaped()) findPockets(endOf(dt));
  pocketBooks.update(pockets, state.velocity, dt);
}

/// The bodies of the liquid, without those that are too fine for the grid: these become drops.
void LiquidStages::findBodies(LiquidStepReport& report) {
  bodies.find(state.grid, state.phi, solids);
  std::vector<Drop> specks = releaseSpecks(state.grid, bodies, state.velocity, state.negative, state.phi);
  if (specks.empty()) return;
  launch(std::move(specks), report);
  extension.apply(state.phi);
  bodies.find(state.grid, state.phi, solids);
}

/// A sub-step of `asked` [s] or less; returns the time it took.
double LiquidStages::subStep(double asked, const ImmersedGas& gas, LiquidStepReport& report,
                             StageClock& clock) {
  double dt = asked;
  clock.time("pressure", [&] { leapAhead(dt); });
  if (params.velocityAdvection == VelocityAdvection::trapezoidal)
    clock.time("extrapolation",
               [&] { acceleration.find(state, solids, params, extrapolator, surfaceStands); });
  clock.time("solids", [&] { moveSolids(dt); });
  clock.time("transport", [&] { dt = transport(asked, report); });
  const double advance = velocityAdvance(dt);
  clock.time("correction", [&] { correctSurface(false); });
  clock.time("reinitialize", [&] { restoreDistance(); });
  clock.time("escape", [&] { loseMarkers(); });
  clock.time("drops", [&] { moveDrops(dt, report); });
  clock.time("correction", [&] { correctSurface(true); });  // flagged by the two before
  clock.time("reseed", [&] { reseed(); });
  clock.time("pockets", [&] { fillPockets(dt); });
  clock.time("inflow", [&] { pour(dt, gas, report); });
  clock.time("advection", [&] { moveVelocity(advance, report); });
  if (params.viscosity > 0) clock.time("viscosity", [&] { applyViscosity(advance); });
  clock.time("pressure", [&] { project(dt, advance, report); });
  clock.time("extrapolation", [&] { extrapolate(); });
  report.cfl = std::max(report.cfl, maxSpeed * dt / state.grid.dx);
  maxSpeed = carryingSpeed();
  checkFinite(dt);
  state.volume = volumeControl.ledger();
  state.volume.pocketGas = pocketBooks.gas();
  state.time = endOf(dt);
  state.lead += advance - dt;
  lastAdvance = advance;
  ++state.subSteps;
  ++report.subSteps;
  return dt;
}

void LiquidStages::measure(LiquidStepReport& report) {
  // No further back than the velocity that has carried the surface here, if any has.
  const bool carried = lastAdvance > 0;
  presentVelocity(carried ? surfaceVelocity : state.velocity, state.velocity,
                  carried ? std::clamp(state.lead / lastAdvance, 0.0, 1.0) : 0, velocityNow);
  const LiquidEnergy energy =
      liquidEnergy(state.grid, bodies.fraction(), velocityNow, params.density, params.gravity);
  const LiquidEnergy flying = energyOf(state.drops, params.density, params.gravity);
  report.kineticEnergy = energy.kinetic + flying.kinetic;
  report.potentialEnergy = energy.potential + flying.potential;
  report.maxSpeed = maxSpeed;
  report.liquidVolume = bodies.volume;
  report.targetVolume = volumeControl.targetVolume();
  report.drops = state.drops.size();
  report.dropVolume = volumeOf(state.drops);
  report.positiveMarkers = state.positive.size();
  report.negativeMarkers = state.negative.size();
}

}  // namespace spume::fluid
