#include "coupling/run_summary.h"

#include <openvdb/version.h>
#include <sys/utsname.h>
#include <tbb/version.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "coupling/atomic_file.h"
#include "coupling/scene_builder.h"
#include "coupling/simd_path.h"
#include "coupling/toml_slot.h"

namespace spume::coupling {
namespace {

/// Collects the members of a JSON object; nested objects are added as text.
class JsonObject {
 public:
  JsonObject& add(const std::string& name, const std::string& text) { return raw(name, quoted(text)); }
  JsonObject& add(const std::string& name, double value) { return raw(name, exactText(value)); }
  JsonObject& add(const std::string& name, const JsonObject& object) { return raw(name, object.text()); }
  JsonObject& add(const std::string& name, const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) list.append(list.empty() ? "" : ", ").append(quoted(word));
    return raw(name, "[" + list + "]");
  }
  std::string text() const { return "{" + members_ + "}"; }

 private:
  JsonObject& raw(const std::string& name, const std::string& value) {
    members_.append(members_.empty() ? "\n" : ",\n").append(quoted(name)).append(": ").append(value);
    return *this;
  }
  std::string members_;
};

std::string processorName() {
  constexpr char kKey[] = "model name";
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind(kKey, 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

JsonObject machine() {
  utsname system{};
  uname(&system);
  const double memory =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return JsonObject()
      .add("processor", processorName())
      .add("cores", std::thread::hardware_concurrency())
      .add("memory_bytes", memory)
      .add("system", std::string(system.sysname) + " " + system.release);
}

JsonObject versions() {
  return JsonObject()
      .add("spume", SPUME_VERSION)
      .add("simd", kSimdPath)
      .add("compiler", __VERSION__)
      .add("openvdb", OPENVDB_LIBRARY_VERSION_STRING)
      .add("tbb", TBB_runtime_version());
}

JsonObject gasTotals(const GasLedger& gas) {
  return JsonObject()
      .add("born_markers", gas.bornMarkers)
      .add("born_pockets", gas.bornPockets)
      .add("born_sources", gas.bornSources)
      .add("born_nucleation", gas.bornNucleation)
      .add("grown", gas.grown)
      .add("burst", gas.burst)
      .add("killed", gas.killed)
      .add("left", gas.left)
      .add("not_entrained", gas.notEntrained)
      .add("unplaced", gas.unplaced)
      .add("in_bubbles", gas.inBubbles)
      .add("in_reservoirs", gas.inReservoirs)
      .add("imbalance", gas.imbalance());
}

JsonObject totals(const RunSummary& summary) {
  return JsonObject()
      .add("frames", summary.frames)
      .add("steps", summary.steps)
      .add("simulated_seconds", summary.simulatedTime)
      .add("wall_seconds", summary.wallSeconds)
      .add("births", static_cast<double>(summary.births))
      .add("bursts", static_cast<double>(summary.bursts))
      .add("bubbles", static_cast<double>(summary.bubbles))
      .add("most_bubbles", static_cast<double>(summary.mostBubbles))
      .add("liquid_volume", summary.liquidVolume)
      .add("target_volume", summary.targetVolume)
      .add("poured", summary.poured)
      .add("drained", summary.drained)
      .add("gas", gasTotals(summary.gas));
}

JsonObject stages(const std::map<std::string, double>& seconds) {
  JsonObject object;
  for (const auto& [stage, spent] : seconds) object.add(stage, spent);
  return object;
}

void accumulate(RunSummary& summary, const StepReport& step) {
  ++summary.steps;
  summary.births += step.births;
  summary.bursts += step.bursts;
  summary.bubbles = step.foam.bubbles;
  summary.mostBubbles = std::max(summary.mostBubbles, summary.bubbles);
  summary.gas = step.gas;
  summary.liquidVolume = step.liquid.liquidVolume;
  summary.targetVolume = step.liquid.targetVolume;
  summary.poured = step.poured;
  summary.drained = step.drained;
  summary.stageSeconds["liquid"] += step.secondsLiquid;
  summary.stageSeconds["entrainment"] += step.secondsEntrainment;
  summary.stageSeconds["supply"] += step.secondsSupply;
  summary.stageSeconds["foam"] += step.secondsFoam;
  for (const auto& stage : step.liquid.stages)
    summary.stageSeconds["liquid: " + stage.stage] += stage.seconds;
  for (const auto& stage : step.foam.stages) summary.stageSeconds["foam: " + stage.stage] += stage.seconds;
}

}  // namespace

void accumulate(RunSummary& summary, const FrameReport& frame) {
  ++summary.frames;
  summary.simulatedTime = frame.time;
  summary.wallSeconds += frame.seconds;
  for (const StepReport& step : frame.steps) accumulate(summary, step);
}

std::string volumeWarning(const RunSummary& summary, double cellVolume) {
  constexpr double kTolerated = 0.05;  // of what it should hold; sound scenes stay within 1 %
  constexpr double kFewCells = 10;     // are no loss worth a word
  const double error = summary.liquidVolume - summary.targetVolume;
  if (std::abs(error) <= std::max(kTolerated * summary.targetVolume, kFewCells * cellVolume)) return {};
  std::ostringstream text;
  text.precision(3);
  text << "the liquid ends with " << summary.liquidVolume << " m^3 instead of " << summary.targetVolume
       << " m^3 (volume_drift in steps.csv says when); see that solids leave it room, that walls are a cell "
          "thick, and raise domain.resolution where sheets are thinner than cells";
  return text.str();
}

std::vector<std::string> switchedOff(const Scene& scene) {
  const std::pair<bool, const char*> features[] = {
      {scene.coupling.entrainment.enabled, "entrainment: no bubble is born from the liquid's motion"},
      {scene.coupling.immersedGas, "immersed gas: bubbles do not raise the surface"},
      {scene.coupling.twoWay, "two-way coupling: the liquid does not feel the drag of bubbles"},
      {scene.liquid.volumeControl, "volume control: the level set may lose or gain liquid"},
      {scene.foam.bursting, "bursting: bubbles live for ever"},
      {!scene.stillPool.enabled, "liquid motion: a pool at rest in closed form"},
      {scene.liquidCache.run.empty(), "liquid solver: the liquid is an earlier run's"},
      {scene.foam.attractionLaw != foam::AttractionLaw::none,
       "attraction: floating bubbles drift as they are"},
      {scene.dissolvedGas.enabled, "dissolved gas: bubbles do not grow"},
      {!scene.inflows.empty(), "inflows: none in the scene"},
      {!scene.solids.empty(), "solids: none but the walls"},
      {scene.output.liquid, "liquid cache"},
      {scene.output.bubblesVdb, "bubble cache as VDB"},
      {scene.output.bubblesPly, "bubble cache as PLY"},
      {scene.output.preview, "pictures"}};
  std::vector<std::string> off;
  for (const auto& [isOn, feature] : features)
    if (!isOn) off.push_back(feature);
  return off;
}

bool isUnderWay(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return false;
  const std::string text = readFile(path);
  const auto says = [&](const std::string& name, const std::string& value) {
    return text.find(quoted(name) + ": " + quoted(value)) != std::string::npos;
  };
  return says("status", "running") && says("spume", SPUME_VERSION) && says("simd", kSimdPath);
}

void writeRunJson(const std::string& path, const Scene& scene, const RunSummary& summary) {
  const Eigen::Vector3i cells = gridOf(scene).cells;
  const JsonObject run = JsonObject()
                             .add("scene", scene.name)
                             .add("title", scene.title)
                             .add("status", summary.status)
                             .add("seed", static_cast<double>(scene.seed))
                             .add("threads", summary.threads)
                             .add("cells_x", cells.x())
                             .add("cells_y", cells.y())
                             .add("cells_z", cells.z())
                             .add("cell_edge", scene.dx())
                             .add("machine", machine())
                             .add("versions", versions())
                             .add("totals", totals(summary))
                             .add("seconds_per_stage", stages(summary.stageSeconds))
                             .add("switched_off", summary.switchedOff);
  replaceFile(path, run.text() + "\n");
}

}  // namespace spume::coupling
