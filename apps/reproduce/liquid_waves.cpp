#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

#include "apps/reproduce/liquid_bench.h"
#include "apps/reproduce/liquid_studies.h"

namespace spume::apps {
namespace {

using std::numbers::pi;

/// Standing wave of one half length in a plane tank with free slip.
struct Tank {
  double length = 0.16, depth = 0.08;  ///< [m]
  int cells = 64;                      ///< along the length
  double viscosity = 0;                ///< nu [m^2/s]
  double rate() const {                ///< omega of the inviscid wave [1/s]
    const double k = pi / length;
    return std::sqrt(9.81 * k * std::tanh(k * depth));
  }
};

/// Amplitude of the wave over time.
struct Record {
  std::vector<double> time, amplitude;
};

/// Part cos(pi x/L) of the surface's height [m].
double modeOf(const fluid::LiquidState& state, double length) {
  double sum = 0;
  const fluid::GridSpec& grid = state.grid;
  for (int i = 0; i < grid.cells.x(); ++i) {
    const double x = grid.cellCentre(i, 0, 0).x();
    sum += surfaceAlong(state, 1, {i, 0, 1}) * std::cos(pi * x / length);
  }
  return 2 * sum / grid.cells.x();
}

Record slosh(const Tank& tank, double periods) {
  constexpr int kStepsPerPeriod = 120;
  const double amplitude = 0.01 * tank.length, k = pi / tank.length, dx = tank.length / tank.cells;
  const int ny = static_cast<int>(std::lround(1.3 * tank.depth / dx));
  fluid::FluidParams params;
  params.gravity = {0, -9.81, 0};
  params.viscosity = tank.viscosity * params.density;
  params.noSlip = false;
  const auto phi0 = [&](const Eigen::Vector3d& x) {
    return (x.y() - tank.depth - amplitude * std::cos(k * x.x())) /
           std::hypot(1, amplitude * k * std::sin(k * x.x()));
  };
  fluid::LiquidSolver solver(params, {slab(tank.cells, ny, dx), openTop(), {}, {}}, phi0);
  const double dt = 2 * pi / tank.rate() / kStepsPerPeriod;
  Record record{{0}, {modeOf(solver.state(), tank.length)}};
  for (int n = 0; n < periods * kStepsPerPeriod; ++n) {
    solver.step(dt);
    record.time.push_back(solver.state().time);
    record.amplitude.push_back(modeOf(solver.state(), tank.length));
  }
  return record;
}

/// Times at which the amplitude passes 0.
std::vector<double> zerosOf(const Record& r) {
  std::vector<double> zeros;
  for (std::size_t n = 1; n < r.time.size(); ++n)
    if (r.amplitude[n - 1] * r.amplitude[n] < 0)
      zeros.push_back(r.time[n - 1] + (r.time[n] - r.time[n - 1]) * r.amplitude[n - 1] /
                                          (r.amplitude[n - 1] - r.amplitude[n]));
  return zeros;
}

/// Decay rate [1/s] of the extremes, by least squares on their logarithm.
double decayOf(const Record& r) {
  double n = 0, t = 0, y = 0, tt = 0, ty = 0;
  for (std::size_t i = 1; i + 1 < r.time.size(); ++i) {
    const double a = std::abs(r.amplitude[i]);
    if (a < std::abs(r.amplitude[i - 1]) || a <= std::abs(r.amplitude[i + 1])) continue;
    const double x = r.time[i], l = std::log(a);
    ++n, t += x, y += l, tt += x * x, ty += x * l;
  }
  return -(n * ty - t * y) / (n * tt - t * t);
}

ResultRow row(const Tank& tank, const std::string& quantity, const std::string& reference) {
  ResultRow r;
  char text[64];
  std::snprintf(text, sizeof text, "%d cells along %.3g m, depth %.3g m", tank.cells, tank.length,
                tank.depth);
  r.resolution = text;
  r.quantity = quantity;
  r.reference = reference;
  r.source = "exact, linear";
  return r;
}

std::vector<ResultRow> sloshing(const StudyContext&) {
  std::vector<ResultRow> rows;
  for (const Tank& tank : {Tank{}, Tank{1, 0.5}, Tank{1, 0.2}}) {
    const Record record = slosh(tank, 3.3);
    const std::vector<double> zeros = zerosOf(record);
    const double exact = 2 * pi / tank.rate();
    const double period = zeros.size() < 3 ? 0 : 2 * (zeros.back() - zeros.front()) / (zeros.size() - 1);
    char text[32];
    std::snprintf(text, sizeof text, "T = %.5f s", exact);
    ResultRow error = row(tank, "error of the period", text);
    rows.push_back(aimAtMost(error, 100 * (period / exact - 1), 0.5, "%"));
    ResultRow loss = row(tank, "loss of amplitude a period", "zero");
    rows.push_back(aimAtMost(loss, 100 * -std::expm1(-decayOf(record) * exact), 5, "%"));
  }
  return rows;
}

/// Decay rate [1/s] of the wave by linear theory: potential flow and a vortical layer under the surface with
/// wave number m, m^2 = k^2 + s/nu, that together leave no stress on the surface and slide along the floor;
/// s is the complex rate of the wave. The well-known 2 nu k^2 is its limit for nu k^2 << omega.
double exactDecay(const Tank& tank) {
  using Complex = std::complex<double>;
  const double k = pi / tank.length, nu = tank.viscosity, potential = std::tanh(k * tank.depth);
  const auto balance = [&](Complex s) {  // of normal stresses, times s, per amplitude of the potential
    const Complex m = std::sqrt(k * k + s / nu);
    const Complex vortical = -2 * k * k * potential / (m * m / k + k);  // no shear stress at the surface
    return -s * s - 2 * nu * s * (k * k + m * vortical / std::tanh(m * tank.depth)) -
           9.81 * (k * potential + vortical);
  };
  constexpr int kNewtonSteps = 50;
  constexpr double kDifference = 1e-6;
  Complex s(-2 * nu * k * k, tank.rate());
  for (int n = 0; n < kNewtonSteps; ++n) {
    const double h = kDifference * std::abs(s);
    s -= balance(s) * 2.0 * h / (balance(s + h) - balance(s - h));
  }
  return -s.real();
}

std::vector<ResultRow> viscousDecay(const StudyContext&) {
  Tank tank;
  const double inviscid = decayOf(slosh(tank, 3.3));
  tank.viscosity = 1e-3;
  const double k = pi / tank.length, exact = exactDecay(tank), limit = 2 * tank.viscosity * k * k;
  const double decay = decayOf(slosh(tank, 3.3));
  char text[64];
  std::snprintf(text, sizeof text, "linear theory %.4g 1/s; limit 2 nu k^2 = %.4g 1/s", exact, limit);
  ResultRow r = row(tank, "error of the decay rate, nu = 1e-3 m^2/s", text);
  aimAtMost(r, 100 * (decay / exact - 1), 10, "%");
  ResultRow net = row(tank, "the same less the inviscid run's own decay", text);
  reportOnly(net, 100 * ((decay - inviscid) / exact - 1), "%");
  return {r, net};
}

}  // namespace

std::vector<Study> waveStudies() {
  return {{"F6", "sloshing", 120, sloshing}, {"F7", "viscous decay of a wave", 80, viscousDecay}};
}

}  // namespace spume::apps
