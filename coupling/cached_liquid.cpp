#include "coupling/cached_liquid.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "coupling/drop_cache.h"
#include "coupling/frame_blend.h"
#include "coupling/scene_builder.h"
#include "coupling/vdb_liquid_sampler.h"
#include "fluid/level_set.h"
#include "fluid/parallel.h"

namespace spume::coupling {
namespace {

constexpr double kSameTime = 1e-9;  // [s]; steps are sums of many, frames are not

/// The liquid at rest the recorded run began with.
std::shared_ptr<const fluid::LiquidState> firstState(const Scene& scene, const fluid::GridSpec& grid) {
  auto first = std::make_shared<fluid::LiquidState>();
  const SignedDistance phi = initialPhi(scene);
  first->grid = grid;
  first->phi = fluid::DenseField<float>(grid.cells);
  first->velocity = fluid::MacVelocity(grid.cells);
  fluid::forEachCell(grid.cells, [&](int i, int j, int k) {
    first->phi(i, j, k) = static_cast<float>(phi(grid.cellCentre(i, j, k)));
  });
  return first;
}

/// Drops of the frame whose liquid lies in liquid/`name`.vdb; none if they were not cached.
std::vector<fluid::Drop> dropsOf(const std::string& folder, std::string name) {
  name.replace(0, name.find('.'), "drops");
  const std::string path = folder + "/drops/" + name;
  if (std::filesystem::exists(path + ".ply")) return readDropsPly(path + ".ply");
  if (std::filesystem::exists(path + ".vdb")) return readDropsVdb(path + ".vdb");
  return {};
}

/// Drops `t` [s] later in free fall.
std::vector<fluid::Drop> flown(std::vector<fluid::Drop> drops, double t, const Eigen::Vector3d& gravity) {
  for (fluid::Drop& drop : drops) {
    drop.position += t * drop.velocity + 0.5 * t * t * gravity;
    drop.velocity += t * gravity;
  }
  return drops;
}

void requireNoPressureProbe(const Scene& scene) {
  for (const ProbeSpec& probe : scene.probes)
    if (probe.kind == ProbeKind::pressure)
      throw SceneError("probe \"" + probe.name +
                       "\": a cached liquid holds no pressure; take it out, or run the scene itself");
}

}  // namespace

CachedLiquid::CachedLiquid(const Scene& scene, double time)
    : scene_(scene), recording_(scene.liquidCache.run), setup_(buildLiquidSetup(scene)) {
  recording_.requireSameLiquid(scene);
  requireNoPressureProbe(scene);
  const int last = recording_.frames().lastFrame();
  if (scene.time.frames > last)
    throw SceneError(recording_.folder() + ": holds the liquid up to frame " + std::to_string(last) +
                     ", time.frames asks for " + std::to_string(scene.time.frames) + ": give --frames " +
                     std::to_string(last) + " or fewer");
  const Eigen::Vector3i& cells = setup_.grid.cells;
  solids_ = fluid::buildSolidBoundary(setup_.grid, setup_.walls, setup_.solids, time);
  state_.grid = setup_.grid;
  state_.phi = fluid::DenseField<float>(cells);
  state_.velocity = fluid::MacVelocity(cells);
  state_.pressureGradient = fluid::MacField<float>(cells);
  pressure_ = fluid::DenseField<float>(cells);
  moveTo(time);
}

CachedLiquid::Frame CachedLiquid::frame(int index) const {
  const std::string& path = recording_.frames().paths.at(index);
  LiquidFrame cached = readLiquidFrame(path);
  if (cached.liquid.grid.cells != setup_.grid.cells)
    throw SceneError(path + ": its grid is not that of the run's scene.toml");
  cached.liquid.time = recording_.frames().frames[index] / scene_.time.fps;
  cached.liquid.drops = dropsOf(recording_.folder(), std::filesystem::path(path).stem().string());
  return std::make_shared<fluid::LiquidState>(std::move(cached.liquid));
}

/// Makes `before_` and `after_` the frames at or before, and after or at `time`.
void CachedLiquid::loadFramesRound(double time) {
  const std::vector<int>& frames = recording_.frames().frames;
  const auto isBefore = [&](int number, double t) { return number / scene_.time.fps < t - kSameTime; };
  const int next = static_cast<int>(
      std::min(std::lower_bound(frames.begin(), frames.end(), time, isBefore), frames.end() - 1) -
      frames.begin());
  if (next == next_) return;
  Frame after = frame(next);  // which may throw
  before_ = next == 0                     ? firstState(scene_, setup_.grid)
            : next == next_ + 1 && after_ ? std::move(after_)
                                          : frame(next - 1);
  after_ = std::move(after);
  next_ = next;
}

void CachedLiquid::moveTo(double time) {
  loadFramesRound(time);
  const double interval = after_->time - before_->time;
  const double share = std::clamp((time - before_->time) / interval, 0.0, 1.0);
  blendFrames({*before_, *after_, interval}, share, scene_.liquid.density, scene_.liquid.gravity, state_);
  fluid::fillGhostLayers(state_.phi);
  const bool atFrame = std::abs(time - after_->time) < kSameTime;
  state_.drops = atFrame ? after_->drops : flown(before_->drops, time - before_->time, scene_.liquid.gravity);
  state_.time = time;
  fluid::updateSolidBoundary(setup_.grid, setup_.walls, setup_.solids, time, solids_);
}

/// The state the recorded run began in: what the first step should have ended with, less what flowed in it.
StepReport CachedLiquid::beginning() const {
  const StepReport& first = recording_.steps().front();
  StepReport start;
  start.liquid.liquidVolume =
      first.liquid.targetVolume - first.immersedGas - first.poured + first.drained + first.liquid.dropVolume;
  return start;
}

/// Linear between the ends of the recorded steps.
double CachedLiquid::recordedAt(double time, double (*value)(const StepReport&)) const {
  const std::vector<StepReport>& steps = recording_.steps();
  const auto endsBefore = [](const StepReport& step, double t) { return step.time < t; };
  const auto after = std::lower_bound(steps.begin(), steps.end(), time, endsBefore);
  if (after == steps.end()) return value(steps.back());
  const StepReport before = after == steps.begin() ? beginning() : *(after - 1);
  return std::lerp(value(before), value(*after), (time - before.time) / (after->time - before.time));
}

fluid::LiquidStepReport CachedLiquid::step(double dt, const fluid::ImmersedGas& gas,
                                           const std::vector<fluid::Push>&) {
  const double start = state_.time, end = start + dt;
  moveTo(end);
  stepStart_ = start;
  const auto grown = [&](double (*total)(const StepReport&)) {
    return recordedAt(end, total) - recordedAt(start, total);
  };
  fluid::LiquidStepReport report;
  report.liquidVolume = report.targetVolume = liquidVolume();
  for (const double volume : gas.volume) {
    report.liquidVolume += volume;
    report.targetVolume += volume;
  }
  report.poured = grown([](const StepReport& step) { return step.poured; });
  report.drained = grown([](const StepReport& step) { return step.drained; });
  report.drops = state_.drops.size();
  report.dropVolume = recordedAt(end, [](const StepReport& step) { return step.liquid.dropVolume; });
  return report;
}

void CachedLiquid::rollBack() { moveTo(stepStart_); }

double CachedLiquid::stableDt(int) const {
  const std::vector<StepReport>& steps = recording_.steps();
  const auto endsBefore = [](const StepReport& step, double t) { return step.time < t; };
  const auto now = std::lower_bound(steps.begin(), steps.end(), state_.time + kSameTime, endsBefore);
  return now == steps.end() ? steps.back().dt : now->dt;
}

/// Without the gas of bubbles: of what the grid held, less what was immersed in it.
double CachedLiquid::liquidVolume() const {
  return recordedAt(state_.time,
                    [](const StepReport& step) { return step.liquid.liquidVolume - step.immersedGas; });
}

std::vector<Birth> CachedLiquid::recordedBirths() const {
  const double start = stepStart_;
  const std::vector<RecordedBirth>& all = recording_.births();
  const auto isEarlier = [](const RecordedBirth& birth, double t) { return birth.time <= t; };
  const auto first = std::lower_bound(all.begin(), all.end(), start + kSameTime, isEarlier);
  const auto end = std::lower_bound(first, all.end(), state_.time + kSameTime, isEarlier);
  const std::size_t count = static_cast<std::size_t>(end - first);
  Eigen::Matrix3Xd position(3, count), velocity(3, count);
  for (std::size_t n = 0; n < count; ++n) position.col(n) = first[n].position;
  sampler()->velocity(position, velocity);
  std::vector<Birth> births;
  for (std::size_t n = 0; n < count; ++n)
    births.push_back(
        {{position.col(n), velocity.col(n), first[n].radius, foam::BubbleClass::liquid}, first[n].cause});
  return births;
}

std::unique_ptr<foam::LiquidSampler> CachedLiquid::sampler() const {
  return std::make_unique<VdbLiquidSampler>(state_, solids_, solidVelocity(scene_, state_.time));
}

}  // namespace spume::coupling
