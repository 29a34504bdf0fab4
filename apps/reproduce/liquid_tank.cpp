#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "apps/reproduce/liquid_bench.h"
#include "apps/reproduce/liquid_studies.h"

namespace spume::apps {
namespace {

/// Height of the liquid above the floor in the column of cells through (x, z): what a gauge reads [m].
double gauge(const fluid::LiquidState& state, double x, double z) {
  const fluid::GridSpec& grid = state.grid;
  const Eigen::Vector3i at = grid.toCells({x, 0, z}).array().floor().cast<int>().matrix();
  double height = 0;
  for (int j = 0; j < grid.cells.y(); ++j)
    height += std::clamp(0.5 - state.phi(at.x(), j, at.z()) / grid.dx, 0.0, 1.0) * grid.dx;
  return height;
}

/// What the four pressure gauges on the box's front read while the water meets it.
struct ImpactRecord {
  static constexpr int kGauges = 4;
  static constexpr double kRisen = 500;  ///< pressure that counts as wetted [Pa]
  std::array<double, kGauges> peak{}, peakTime{};
  double rise = 0;  ///< when the lowest gauge is wetted [s]
  void note(const fluid::LiquidSolver& solver) {
    const fluid::GridSpec& grid = solver.state().grid;
    for (int n = 0; n < kGauges; ++n) {
      const Eigen::Vector3d place(.8245, .021 + .04 * n, .471);
      const Eigen::Vector3i cell = grid.toCells(place).array().floor().cast<int>().matrix();
      const double p = solver.pressure()(cell);
      if (n == 0 && rise == 0 && p > kRisen) rise = solver.state().time;
      if (p > peak[n]) peak[n] = p, peakTime[n] = solver.state().time;
    }
  }
};

constexpr const char* kTankSource = "Kleefsman et al. 2005, distributed data";
constexpr double kImpactEnd = 0.55;          ///< the water has met the box and its gauges have peaked [s]
constexpr double kImpactStep = 0.25 * 0.01;  ///< [s]

std::string tankResolution(const fluid::GridSpec& grid) {
  return std::to_string(grid.cells.x()) + " x " + std::to_string(grid.cells.y()) + " x " +
         std::to_string(grid.cells.z());
}

/// The tank of SPHERIC test 2 with `across` cells over its width of 1 m.
fluid::LiquidSolver tank(int across) {
  const double dx = 1.0 / across;
  const fluid::GridSpec grid{{static_cast<int>(std::lround(3.22 / dx)), across, across}, dx, {0, 0, 0}};
  const fluid::SolidObject box{"box",
                               [](const Eigen::Vector3d& x, double) {
                                 const Eigen::Vector3d lower(.6635, -1, .2955), upper(.8245, .161, .6985);
                                 return (lower - x).cwiseMax(x - upper).maxCoeff();
                               },
                               {},
                               false};
  fluid::FluidParams params;
  params.gravity = {0, -9.81, 0};
  params.density = 998.2;
  const auto phi0 = [](const Eigen::Vector3d& x) { return std::max(1.992 - x.x(), x.y() - .55); };
  return {params, {grid, openTop(), {box}, {}}, phi0};
}

/// Rows of the impact: [SPHERIC test 2] P1 to P4.
void addImpact(const ImpactRecord& impact, const fluid::GridSpec& grid, std::vector<ResultRow>& rows) {
  constexpr std::array<double, ImpactRecord::kGauges> kPeak{11.2e3, 8.13e3, 6.56e3, 7.2e3};
  constexpr std::array<const char*, ImpactRecord::kGauges> kText{"11.2 kPa", "8.13 kPa; interFoam -15.5 %",
                                                                 "6.56 kPa", "7.2 kPa"};
  constexpr double kRise = .393;
  ResultRow r;
  r.resolution = tankResolution(grid);
  r.source = kTankSource;
  r.quantity = "error of the time P1 rises";
  r.reference = ".393 s; interFoam +2.4 %";
  r.note =
      "steps of 0.6 ms: 5.1 %; the front meets the box at .417 s with 32 cells across, at .410 s with 64";
  rows.push_back(aimAtMost(r, 100 * (impact.rise / kRise - 1), 3, "%"));
  r.note.clear();
  for (int n = 0; n < ImpactRecord::kGauges; ++n) {
    r.aim.clear();
    r.verdict = Verdict::none;
    r.quantity = "error of the peak of P" + std::to_string(n + 1);
    r.reference = kText[n];
    const double error = 100 * (impact.peak[n] / kPeak[n] - 1);
    rows.push_back(n == 1 ? aimAtMost(r, error, 20, "%") : reportOnly(r, error, "%"));
  }
}

ImpactRecord impactOn(fluid::LiquidSolver& solver) {
  ImpactRecord impact;
  while (solver.state().time < kImpactEnd) {
    solver.step(kImpactStep);
    impact.note(solver);
  }
  return impact;
}

/// What the height gauges H2 and H4 read at the times of three measurements.
struct HeightRecord {
  struct Reading {
    double time, h2, h4;
  };
  static constexpr std::array<Reading, 3> kMeasured{
      {{.5, .099, .426}, {1.007, .180, .277}, {1.80, .333, .147}}};
  double error2 = 0, error4 = 0, peak = 0, peakTime = 0;
  std::size_t next = 0;

  void note(const fluid::LiquidState& state, double step) {
    const double h2 = gauge(state, .992, .5);
    if (h2 > peak) peak = h2, peakTime = state.time;
    if (next == kMeasured.size() || state.time < kMeasured[next].time - 0.5 * step) return;
    error2 += std::abs(h2 - kMeasured[next].h2) / kMeasured.size();
    error4 += std::abs(gauge(state, 2.638, .5) - kMeasured[next].h4) / kMeasured.size();
    ++next;
  }
};

std::vector<ResultRow> heightRows(const HeightRecord& heights, const fluid::GridSpec& grid) {
  constexpr double kLargest2 = .341, kLargest4 = .55, kPeakTime = 1.787;
  ResultRow h2, h4, top, arrival;
  for (ResultRow* r : {&h2, &h4, &top, &arrival}) {
    r->resolution = tankResolution(grid);
    r->source = kTankSource;
  }
  h2.quantity = "mean error of H2 at 3 times, of its maximum";
  h4.quantity = "mean error of H4 at 3 times, of its maximum";
  top.quantity = "error of the peak of H2";
  arrival.quantity = "error of its time";
  h2.note = "the wave that comes back breaks: 3.7 to 8.2 % in runs that differ by round-off";
  h2.reference = ".099, .180, .333 m; interFoam 3.0 %";
  h4.reference = ".426, .277, .147 m; interFoam 1.8 %";
  top.reference = ".341 m";
  arrival.reference = "1.787 s";
  return {aimAtMost(h2, 100 * heights.error2 / kLargest2, 4, "%"),
          aimAtMost(h4, 100 * heights.error4 / kLargest4, 4, "%"),
          reportOnly(top, 100 * (heights.peak / kLargest2 - 1), "%"),
          aimAtMost(arrival, 100 * (heights.peakTime / kPeakTime - 1), 3, "%")};
}

/// F10: a column 0.55 m high meets a box on the floor of a tank [SPHERIC test 2]; the impact at twice the
/// resolution, too.
std::vector<ResultRow> boxInTank(const StudyContext&) {
  constexpr int kAcross = 32;
  constexpr double kStep = 0.01, kEnd = 2;
  fluid::LiquidSolver solver = tank(kAcross);
  HeightRecord heights;
  ImpactRecord impact;
  while (solver.state().time < kEnd) {
    const bool meets = solver.state().time < kImpactEnd;
    const double step = meets ? kImpactStep : kStep;
    solver.step(step);
    if (meets) impact.note(solver);
    heights.note(solver.state(), step);
  }
  std::vector<ResultRow> rows = heightRows(heights, solver.state().grid);
  addImpact(impact, solver.state().grid, rows);
  fluid::LiquidSolver fine = tank(2 * kAcross);
  addImpact(impactOn(fine), fine.state().grid, rows);
  return rows;
}

/// F12: a nozzle of 2 cm fills a box of 16 cm at 0.5 m/s.
std::vector<ResultRow> filling(const StudyContext&) {
  constexpr int kCells = 40;
  constexpr double kSpeed = 0.5, kRadius = 0.01, kDuration = 5;
  const double dx = 0.16 / kCells, area = std::numbers::pi * kRadius * kRadius;
  fluid::Inflow nozzle;
  nozzle.name = "nozzle";
  nozzle.sdf = [dx](const Eigen::Vector3d& x) {
    const double across = std::hypot(x.x() - 0.08, x.z() - 0.08) - kRadius;
    return std::max({across, x.y() - 0.153, 0.153 - 3 * dx - x.y()});
  };
  nozzle.velocity = {0, -kSpeed, 0};
  nozzle.area = area;
  nozzle.scale = [](double) { return 1.0; };
  fluid::LiquidSolver solver({}, {{{kCells, kCells, kCells}, dx, {0, 0, 0}}, openTop(), {}, {nozzle}},
                             [](const auto& x) { return x.y() - 0.04; });
  const double start = solver.liquidVolume();
  double poured = 0, worst = 0;
  while (solver.state().time < kDuration) {
    const fluid::LiquidStepReport report = solver.step(0.01);
    poured += report.poured;
    if (solver.state().time > 1)
      worst = std::max(worst, std::abs(report.liquidVolume + report.dropVolume - start - poured));
  }
  ResultRow flux, volume;
  flux.resolution = volume.resolution = "40^3, 5 s";
  flux.quantity = "poured, beside Q t";
  volume.quantity = "largest error of the volume after 1 s, of what is poured";
  flux.reference = "Q = 1.5708e-4 m^3/s";
  volume.reference = "V0 + Q t";
  flux.source = volume.source = "exact";
  const double stamped = area * 3 * dx;  // the nozzle's own region is filled once
  return {aimAtMost(flux, 100 * ((poured - stamped) / (kSpeed * area * kDuration) - 1), 0.5, "%"),
          aimAtMost(volume, 100 * worst / poured, 0.5, "%")};
}

}  // namespace

std::vector<Study> tankStudies() {
  return {{"F10", "column against a box", 500, boxInTank}, {"F12", "filling at rate Q", 150, filling}};
}

}  // namespace spume::apps
