#include "fluid/transport_study.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "fluid/doubtful_cells.h"
#include "fluid/level_set.h"
#include "fluid/level_set_advection.h"
#include "fluid/marker_correction.h"
#include "fluid/marker_particles.h"
#include "fluid/marker_shares.h"
#include "fluid/parallel.h"
#include "fluid/reinitialize.h"

namespace spume::fluid {
namespace {

/// Thickness of the slab that stands for a plane.
constexpr int kSlabCells = 4;
constexpr int kSamples = 8;

/// A domain without solids whose sides are open, except those that cut a slab out of a plane.
SolidBoundary openSpace(const GridSpec& grid) {
  SolidBoundary solids;
  const float far = static_cast<float>(grid.dx * grid.cells.maxCoeff());
  solids.psi = DenseField<float>(grid.cells, far);
  solids.object = DenseField<std::int16_t>(grid.cells, -1);
  solids.open = MacField<float>(grid.cells, 1);
  solids.velocity = MacField<float>(grid.cells, 0);
  solids.prescribed = MacField<std::uint8_t>(grid.cells, 0);
  solids.cellFraction = DenseField<float>(grid.cells, 1);
  return solids;
}

GridSpec gridOf(const TransportCase& scene, int cells) {
  GridSpec grid;
  grid.dx = scene.size.maxCoeff() / cells;
  for (int a = 0; a < 3; ++a) grid.cells[a] = static_cast<int>(std::lround(scene.size[a] / grid.dx));
  if (scene.planar) grid.cells.z() = kSlabCells;
  return grid;
}

MacVelocity sampleField(const TransportCase& scene, const GridSpec& grid) {
  MacVelocity velocity(grid.cells);
  for (int a = 0; a < 3; ++a)
    forEachCell(velocity[a].size(), [&](int i, int j, int k) {
      velocity[a](i, j, k) = static_cast<float>(scene.velocity(grid.faceCentre(a, i, j, k))[a]);
    });
  fillGhostLayers(velocity);
  return velocity;
}

void scaleField(const MacVelocity& field, float factor, MacVelocity& out) {
  for (int a = 0; a < 3; ++a)
    for (std::ptrdiff_t n = 0; n < field[a].count(); ++n) out[a].data()[n] = factor * field[a].data()[n];
}

double fastest(const MacVelocity& velocity) {
  float m = 0;
  for (const DenseField<float>& f : velocity.axis)
    for (int i = 0; i < f.size().x(); ++i)
      for (int j = 0; j < f.size().y(); ++j)
        for (int k = 0; k < f.size().z(); ++k) m = std::max(m, std::abs(f(i, j, k)));
  return m;
}

/// Everything one run holds.
struct Study {
  const TransportCase& scene;
  const TransportOptions& options;
  MacVelocity field;  ///< velocity before its factor of time
  LiquidState state;
  SolidBoundary solids;
  DomainWalls walls;
  LevelSetAdvection advection;
  Reinitializer reinitializer;
  MarkerSorter sorter;
  MarkerSeeder seeder;
  MarkerCorrection correction;
  MarkerShares shares;

  Study(const TransportCase& s, const TransportOptions& o, const GridSpec& grid)
      : scene(s),
        options(o),
        field(sampleField(s, grid)),
        solids(openSpace(grid)),
        advection(grid),
        reinitializer(grid),
        sorter(grid),
        seeder(grid),
        shares(grid) {
    state.grid = grid;
    state.velocity = MacVelocity(grid.cells);
    walls.closed.fill(false);
    walls.closed[4] = walls.closed[5] = s.planar;
    initialiseLevelSet(grid, s.phi0, state.phi);
    if (options.markers) reseed();
    if (options.budget) shares.refreshLiquid(markerScene(), state.phi, state.positive, state.negative);
  }

  MarkerScene markerScene() const { return {state.grid, options.params, walls, solids}; }
  void reseed();
  void correct();
  void step(double t, double dt);
  double gridVolume() const;
  double volumeBesideGrid() const;
};

double Study::gridVolume() const { return liquidVolume(state.grid, state.phi, solids); }

/// Where phi is in doubt the markers know how much liquid there is, elsewhere the grid does. This is what the
/// negative markers of the cells in doubt stand for beyond what the grid shows there: what is outside the
/// grid, counted once. Negative where the grid draws a thin film too thick.
double Study::volumeBesideGrid() const {
  DoubtfulCells doubt(state.grid.cells);
  doubt.add(state.positive);
  doubt.add(state.negative);
  const MarkerSet& markers = state.negative;
  double held = 0, shown = 0;
  for (std::size_t n = 0; n < markers.size(); ++n)
    if (doubt(static_cast<int>(markers.x[n]), static_cast<int>(markers.y[n]), static_cast<int>(markers.z[n])))
      held += markers.gas[n];
  const Eigen::Vector3i& cells = state.grid.cells;
  for (int i = 0; i < cells.x(); ++i)
    for (int j = 0; j < cells.y(); ++j)
      for (int k = 0; k < cells.z(); ++k)
        if (doubt(i, j, k))
          shown += liquidFractionOfCell(state.phi, static_cast<float>(state.grid.dx), i, j, k);
  return held - shown * state.grid.cellVolume();
}

void Study::reseed() {
  seeder.reseed(markerScene(), state.phi, state.subSteps, state.positive, state.negative);
}

void Study::correct() {
  if (options.markers)
    correction.apply(static_cast<float>(state.grid.dx), solids.sides, state.positive, state.negative,
                     state.phi);
}

void Study::step(double t, double dt) {
  const double factor = scene.timeFactor ? scene.timeFactor(t + 0.5 * dt) : 1;
  scaleField(field, static_cast<float>(factor), state.velocity);
  advection.advance(options.params.levelSetTransport, state.velocity, dt, state.phi);
  if (options.markers)
    for (MarkerSet* markers : {&state.positive, &state.negative}) {
      advectMarkers(markerScene(), state.velocity, dt, *markers);
      sorter.compact(*markers);
    }
  correct();
  if (options.reinitialise) reinitializer.apply(state.phi);
  correct();
  ++state.subSteps;
  state.time = t + dt;
  if (!options.markers) return;
  if (options.budget) shares.refreshLiquid(markerScene(), state.phi, state.positive, state.negative);
  adjustRadii(markerScene(), state.phi, MarkerSign::positive, state.positive);
  adjustRadii(markerScene(), state.phi, MarkerSign::negative, state.negative);
  if (state.subSteps % options.params.reseedInterval == 0) reseed();
}

/// Compares the end with the exact start, which it should have come back to.
void compare(const Study& study, TransportResult& result) {
  const GridSpec& grid = study.state.grid;
  const DenseField<float> exact = sampledFraction(grid, study.scene.phi0);
  DenseField<float> end(grid.cells);
  computeLiquidFraction(study.state.phi, study.solids, static_cast<float>(grid.dx), end);
  double volume = 0, volume0 = 0, difference = 0, area = 0;
  for (int i = 0; i < grid.cells.x(); ++i)
    for (int j = 0; j < grid.cells.y(); ++j)
      for (int k = 0; k < grid.cells.z(); ++k) {
        volume += end(i, j, k);
        volume0 += exact(i, j, k);
        difference += std::abs(end(i, j, k) - exact(i, j, k));
        const double distance = study.scene.phi0(grid.cellCentre(i, j, k));
        area += std::abs(distance) < grid.dx ? 0.5 : 0;  // a layer two cells thick holds it
        if (end(i, j, k) < 0.5) result.lostThickness = std::max(result.lostThickness, -2 * distance);
      }
  const double depth = study.scene.planar ? kSlabCells * grid.dx : 1;
  result.volumeChange = (volume - volume0) / volume0;
  result.shapeError = difference * grid.cellVolume() / depth;
  result.interfaceError = difference / std::max(area, 1.0) * grid.dx;
}

}  // namespace

DenseField<float> sampledFraction(const GridSpec& grid,
                                  const std::function<double(const Eigen::Vector3d&)>& phi0) {
  DenseField<float> fraction(grid.cells);
  forEachCell(grid.cells, [&](int i, int j, int k) {
    const Eigen::Vector3d centre = grid.cellCentre(i, j, k);
    const double value = phi0(centre);
    if (std::abs(value) > grid.dx) {
      fraction(i, j, k) = value < 0;
      return;
    }
    int below = 0;
    for (int s = 0; s < kSamples * kSamples * kSamples; ++s) {
      const Eigen::Vector3d at(s / (kSamples * kSamples), s / kSamples % kSamples, s % kSamples);
      below += phi0(centre + grid.dx * ((at.array() + 0.5) / kSamples - 0.5).matrix()) < 0;
    }
    fraction(i, j, k) = static_cast<float>(below) / (kSamples * kSamples * kSamples);
  });
  return fraction;
}

TransportResult runTransport(const TransportCase& scene, const TransportOptions& options,
                             const TransportWatch& watch) {
  const GridSpec grid = gridOf(scene, options.cells);
  Study study(scene, options, grid);
  const double speed = fastest(study.field);
  TransportResult result;
  result.steps = std::max(1, static_cast<int>(std::ceil(scene.duration * speed / (options.cfl * grid.dx))));
  const double dt = scene.duration / result.steps;
  using Clock = std::chrono::steady_clock;
  const double volume0 = study.gridVolume();
  const Clock::time_point start = Clock::now();
  for (int n = 0; n < result.steps; ++n) {
    study.step(n * dt, dt);
    if (watch) watch(study.state, study.state.time);
    if (!options.budget) continue;
    result.escaped = study.volumeBesideGrid() / volume0;
    const double shown = study.gridVolume() / volume0;
    result.leastShown = std::min(result.leastShown, shown);
    result.worstBudget = std::max(result.worstBudget, std::abs(shown + result.escaped - 1));
  }
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  compare(study, result);
  result.state = std::move(study.state);
  return result;
}

}  // namespace spume::fluid
