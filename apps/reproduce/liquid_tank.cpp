#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

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

double columnDistance(const Eigen::Vector3d& x) { return std::max(1.992 - x.x(), x.y() - .55); }

fluid::FluidParams waterOfTank(std::uint64_t seed = 1) {
  fluid::FluidParams params;
  params.gravity = {0, -9.81, 0};
  params.density = 998.2;
  params.seed = seed;
  return params;
}

/// The tank of SPHERIC test 2 with `across` cells over its width of 1 m.
fluid::LiquidSolver tank(int across, std::uint64_t seed = 1) {
  const double dx = 1.0 / across;
  const fluid::GridSpec grid{{static_cast<int>(std::lround(3.22 / dx)), across, across}, dx, {0, 0, 0}};
  const fluid::SolidObject box{"box",
                               [](const Eigen::Vector3d& x, double) {
                                 const Eigen::Vector3d lower(.6635, -1, .2955), upper(.8245, .161, .6985);
                                 return (lower - x).cwiseMax(x - upper).maxCoeff();
                               },
                               {},
                               false};
  return {waterOfTank(seed), {grid, openTop(), {box}, {}}, columnDistance};
}

/// Mean of a figure of some runs, and its range as a text.
template <typename Run, typename Figure>
std::pair<double, std::string> meanAndRange(const std::vector<Run>& runs, const Figure& figure) {
  double low = figure(runs[0]), high = low, sum = 0;
  for (const Run& run : runs) {
    const double value = figure(run);
    low = std::min(low, value), high = std::max(high, value), sum += value;
  }
  char text[64];
  std::snprintf(text, sizeof text, "single runs %.2g to %.2g %%", low, high);
  return {sum / static_cast<double>(runs.size()), text};
}

std::string meanOf(const std::string& resolution, std::size_t runs) {
  return resolution + ", mean of " + std::to_string(runs) + " runs";
}

/// Rows of the impact: [SPHERIC test 2] P1 to P4. The gauges are 4 cm apart: the grid of the heights has 3 cm
/// cells and only tells; the finer one, `asked`, is compared with the aims. A peak lasts a step or two: runs
/// that differ in their markers alone differ in it.
void addImpact(const std::vector<ImpactRecord>& runs, const std::string& resolution, bool asked,
               std::vector<ResultRow>& rows) {
  constexpr std::array<double, ImpactRecord::kGauges> kPeak{11.2e3, 8.13e3, 6.56e3, 7.2e3};
  constexpr std::array<const char*, ImpactRecord::kGauges> kText{"11.2 kPa", "8.13 kPa; interFoam -15.5 %",
                                                                 "6.56 kPa", "7.2 kPa"};
  constexpr double kRise = .393;
  ResultRow r;
  r.resolution = meanOf(resolution, runs.size());
  r.source = kTankSource;
  r.quantity = "error of the time P1 rises";
  r.reference = ".393 s; interFoam +2.4 %";
  r.note = "when the front is there: see the plane flow";
  const auto late = [](const ImpactRecord& run) { return 100 * (run.rise / kRise - 1); };
  const double mean = meanAndRange(runs, late).first;
  rows.push_back(asked ? aimAtMost(r, mean, 3, "%") : reportOnly(r, mean, "%"));
  for (int n = 0; n < ImpactRecord::kGauges; ++n) {
    r.aim.clear();
    r.verdict = Verdict::none;
    r.quantity = "error of the peak of P" + std::to_string(n + 1);
    r.reference = kText[n];
    const auto excess = [&](const ImpactRecord& run) { return 100 * (run.peak[n] / kPeak[n] - 1); };
    const auto [error, range] = meanAndRange(runs, excess);
    r.note = range;
    rows.push_back(n == 1 && asked ? aimAtMost(r, error, 20, "%") : reportOnly(r, error, "%"));
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

constexpr std::size_t kGauges = 4, kTimes = 3;
/// Readings of H1 and H3 are each other's in our list of the data: with .001 m at .5 s the third gauge would
/// be dry a quarter of a second after the front passed it.
using Readings = std::array<std::array<double, kTimes>, kGauges>;  ///< of H1 to H4 [m]
constexpr std::array<double, kTimes> kReadAt{.5, 1.007, 1.80};     ///< [s]
constexpr Readings kMeasured{
    {{.001, .161, .298}, {.099, .180, .333}, {.095, .154, .122}, {.426, .277, .147}}};
constexpr std::array<double, kGauges> kLargest{.341, .341, .341, .55};  ///< H1 and H3 in the unit of H2 [m]

/// What the height gauges read at the times of the measurements, and the crest at H2.
struct HeightRecord {
  Readings height{};
  double peak = 0, peakTime = 0;
  std::size_t next = 0;

  void note(const fluid::LiquidState& state, double step) {
    constexpr std::array<double, kGauges> kPlace{.496, .992, 1.488, 2.638};
    const double h2 = gauge(state, kPlace[1], .5);
    if (h2 > peak) peak = h2, peakTime = state.time;
    if (next == kTimes || state.time < kReadAt[next] - 0.5 * step) return;
    for (std::size_t g = 0; g < kGauges; ++g) height[g][next] = gauge(state, kPlace[g], .5);
    ++next;
  }
};

/// Mean over the times of the error of gauge g, of its maximum [%].
double errorOf(const Readings& height, std::size_t g) {
  double sum = 0;
  for (std::size_t t = 0; t < kTimes; ++t) sum += std::abs(height[g][t] - kMeasured[g][t]);
  return 100 * sum / kTimes / kLargest[g];
}

/// The wave that comes back breaks, and runs that differ by round-off alone differ in it by several percent:
/// what can be compared with the one measurement is the mean of some runs.
std::vector<ResultRow> heightRows(const std::vector<HeightRecord>& runs, const std::string& resolution) {
  constexpr double kPeak = .341, kPeakTime = 1.787, kLimit = 4;
  constexpr std::array<const char*, kGauges> kReference{
      ".001, .161, .298 m", ".099, .180, .333 m; interFoam 3.0 %", ".095, .154, .122 m",
      ".426, .277, .147 m; interFoam 1.8 %"};
  HeightRecord mean;
  for (const HeightRecord& run : runs) {
    for (std::size_t g = 0; g < kGauges; ++g)
      for (std::size_t t = 0; t < kTimes; ++t) mean.height[g][t] += run.height[g][t] / runs.size();
    mean.peak += run.peak / runs.size();
    mean.peakTime += run.peakTime / runs.size();
  }
  std::vector<ResultRow> rows;
  ResultRow r;
  r.resolution = meanOf(resolution, runs.size());
  r.source = kTankSource;
  for (std::size_t g = 0; g < kGauges; ++g) {
    r.quantity = "mean error of H" + std::to_string(g + 1) + " at 3 times, of " +
                 (g % 2 ? "its maximum" : "H2's maximum");
    r.reference = kReference[g];
    r.note = meanAndRange(runs, [g](const HeightRecord& run) { return errorOf(run.height, g); }).second;
    const double error = errorOf(mean.height, g);
    rows.push_back(g % 2 ? aimAtMost(r, error, kLimit, "%") : reportOnly(r, error, "%"));
    r.aim.clear(), r.verdict = Verdict::none;
  }
  r.quantity = "error of the peak of H2";
  r.reference = ".341 m";
  const auto crest = [](const HeightRecord& run) { return 100 * (run.peak / kPeak - 1); };
  r.note = meanAndRange(runs, crest).second;
  rows.push_back(reportOnly(r, 100 * (mean.peak / kPeak - 1), "%"));
  r.quantity = "error of its time";
  r.reference = "1.787 s";
  const auto arrival = [](const HeightRecord& run) { return 100 * (run.peakTime / kPeakTime - 1); };
  r.note = meanAndRange(runs, arrival).second;
  rows.push_back(aimAtMost(r, 100 * (mean.peakTime / kPeakTime - 1), 3, "%"));
  return rows;
}

/// When the front of the same column on a plane floor comes to where the box would be [s].
double frontArrival(int across) {
  constexpr double kBox = .8245;
  const double dx = 1.0 / across;
  const fluid::GridSpec grid =
      slab(static_cast<int>(std::lround(3.22 / dx)), static_cast<int>(std::lround(.75 / dx)), dx);
  fluid::LiquidSolver solver(waterOfTank(), {grid, openTop(), {}, {}}, columnDistance);
  const auto place = [&] {  // of the tip, from the dry end
    int i = 0;
    while (i + 1 < grid.cells.x() && solver.state().phi(i, 0, 1) >= 0) ++i;
    const double wet = solver.state().phi(i, 0, 1), dry = i > 0 ? solver.state().phi(i - 1, 0, 1) : 0;
    return grid.cellCentre(i, 0, 0).x() - dx * (i > 0 ? wet / (wet - dry) : 0);
  };
  double before = place(), now = before;
  while (now > kBox && solver.state().time < kImpactEnd) {
    before = now;
    solver.step(kImpactStep);
    now = place();
  }
  return solver.state().time - kImpactStep * (kBox - now) / (before - now);
}

/// How the time of the front goes with the grid: the error of the time P1 rises that no finer grid would
/// mend.
ResultRow frontRow() {
  constexpr double kRise = .393;
  std::array<double, 3> time{};
  const std::array<int, 3> across{32, 64, 128};
  for (std::size_t n = 0; n < across.size(); ++n) time[n] = frontArrival(across[n]);
  ResultRow r;
  r.resolution = "plane, 32, 64 and 128 cells a metre";
  r.quantity = "error of the time the front comes to the box, extrapolated";
  r.reference = ".393 s for P1";
  r.source = kTankSource;
  char text[64];
  std::snprintf(text, sizeof text, "%.4f, %.4f, %.4f s; first order", time[0], time[1], time[2]);
  r.note = text;
  return reportOnly(r, 100 * ((2 * time[2] - time[1]) / kRise - 1), "%");
}

/// F10: a column 0.55 m high meets a box on the floor of a tank [SPHERIC test 2]; the heights from runs with
/// different markers, the impact at two resolutions.
std::vector<ResultRow> boxInTank(const StudyContext&) {
  constexpr int kAcross = 32, kRuns = 4, kFineRuns = 3;
  constexpr double kStep = 0.01, kEnd = 2;
  std::vector<HeightRecord> heights(kRuns);
  std::vector<ImpactRecord> coarse(kRuns), fine;
  std::string resolution;
  for (int n = 0; n < kRuns; ++n) {
    fluid::LiquidSolver solver = tank(kAcross, n + 1);
    resolution = tankResolution(solver.state().grid);
    while (solver.state().time < kEnd) {
      const bool meets = solver.state().time < kImpactEnd;
      const double step = meets ? kImpactStep : kStep;
      solver.step(step);
      if (meets) coarse[n].note(solver);
      heights[n].note(solver.state(), step);
    }
  }
  std::vector<ResultRow> rows = heightRows(heights, resolution);
  addImpact(coarse, resolution, false, rows);
  for (int n = 0; n < kFineRuns; ++n) {
    fluid::LiquidSolver solver = tank(2 * kAcross, n + 1);
    resolution = tankResolution(solver.state().grid);
    fine.push_back(impactOn(solver));
  }
  addImpact(fine, resolution, true, rows);
  rows.push_back(frontRow());
  return rows;
}

}  // namespace

std::vector<Study> tankStudies() { return {{"F10", "column against a box", 900, boxInTank}}; }

}  // namespace spume::apps
