#include "coupling/kept_steps.h"

#include <charconv>
#include <filesystem>
#include <functional>
#include <map>

#include "coupling/atomic_file.h"
#include "coupling/text_fields.h"

namespace spume::coupling {
namespace {

using Setter = std::function<void(StepReport&, double)>;

/// A setter for the member that `place` finds in a report.
template <typename Place>
Setter into(Place place) {
  return [place](StepReport& report, double value) {
    auto& member = place(report);
    member = static_cast<std::decay_t<decltype(member)>>(value);
  };
}

/// The columns that are read back; statistics_columns.cpp writes them.
const std::map<std::string_view, Setter>& settersOfColumns() {
  using R = StepReport;
  static const std::map<std::string_view, Setter> kSetters{
      {"step", into([](R & r) -> auto& { return r.step; })},
      {"time", into([](R & r) -> auto& { return r.time; })},
      {"dt", into([](R & r) -> auto& { return r.dt; })},
      {"halvings", into([](R & r) -> auto& { return r.halvings; })},
      {"liquid_substeps", into([](R & r) -> auto& { return r.liquid.subSteps; })},
      {"cfl", into([](R & r) -> auto& { return r.liquid.cfl; })},
      {"max_speed", into([](R & r) -> auto& { return r.liquid.maxSpeed; })},
      {"pressure_iterations", into([](R & r) -> auto& { return r.liquid.pressureIterations; })},
      {"divergence", into([](R & r) -> auto& { return r.liquid.divergence; })},
      {"liquid_volume", into([](R & r) -> auto& { return r.liquid.liquidVolume; })},
      {"target_volume", into([](R & r) -> auto& { return r.liquid.targetVolume; })},
      {"poured", into([](R & r) -> auto& { return r.poured; })},
      {"drained", into([](R & r) -> auto& { return r.drained; })},
      {"immersed_gas", into([](R & r) -> auto& { return r.immersedGas; })},
      {"drops", into([](R & r) -> auto& { return r.liquid.drops; })},
      {"drop_volume", into([](R & r) -> auto& { return r.liquid.dropVolume; })},
      {"bubbles", into([](R & r) -> auto& { return r.foam.bubbles; })},
      {"bubbles_liquid", into([](R & r) -> auto& { return r.foam.liquid; })},
      {"bubbles_surface", into([](R & r) -> auto& { return r.foam.surface; })},
      {"bubbles_air", into([](R & r) -> auto& { return r.foam.air; })},
      {"births", into([](R & r) -> auto& { return r.births; })},
      {"source_unplaced", into([](R & r) -> auto& { return r.sourceUnplaced; })},
      {"bursts", into([](R & r) -> auto& { return r.bursts; })},
      {"contacts", into([](R & r) -> auto& { return r.foam.contacts; })},
      {"foam_iterations", into([](R & r) -> auto& { return r.foam.solverIterations; })},
      {"volume_error_median", into([](R & r) -> auto& { return r.foam.volumeErrorMedian; })},
      {"volume_error_max", into([](R & r) -> auto& { return r.foam.volumeErrorMax; })},
      {"gas_born_markers", into([](R & r) -> auto& { return r.gas.bornMarkers; })},
      {"gas_born_pockets", into([](R & r) -> auto& { return r.gas.bornPockets; })},
      {"gas_born_sources", into([](R & r) -> auto& { return r.gas.bornSources; })},
      {"gas_born_nucleation", into([](R & r) -> auto& { return r.gas.bornNucleation; })},
      {"gas_grown", into([](R & r) -> auto& { return r.gas.grown; })},
      {"gas_burst", into([](R & r) -> auto& { return r.gas.burst; })},
      {"gas_killed", into([](R & r) -> auto& { return r.gas.killed; })},
      {"gas_left", into([](R & r) -> auto& { return r.gas.left; })},
      {"gas_not_entrained", into([](R & r) -> auto& { return r.gas.notEntrained; })},
      {"gas_unplaced", into([](R & r) -> auto& { return r.gas.unplaced; })},
      {"gas_in_bubbles", into([](R & r) -> auto& { return r.gas.inBubbles; })},
      {"gas_in_reservoirs", into([](R & r) -> auto& { return r.gas.inReservoirs; })},
      {"seconds_liquid", into([](R & r) -> auto& { return r.secondsLiquid; })},
      {"seconds_entrainment", into([](R & r) -> auto& { return r.secondsEntrainment; })},
      {"seconds_supply", into([](R & r) -> auto& { return r.secondsSupply; })},
      {"seconds_foam", into([](R & r) -> auto& { return r.secondsFoam; })}};
  return kSetters;
}

/// What to do with the cells of a column; a stage's column adds the stage to the report.
Setter setterOf(std::string_view column) {
  constexpr std::string_view kLiquid = "seconds_liquid_", kFoam = "seconds_foam_";
  const auto known = settersOfColumns().find(column);
  if (known != settersOfColumns().end()) return known->second;
  if (column.starts_with(kLiquid))
    return [stage = std::string(column.substr(kLiquid.size()))](StepReport& report, double seconds) {
      report.liquid.stages.push_back({stage, seconds});
    };
  if (column.starts_with(kFoam))
    return [stage = std::string(column.substr(kFoam.size()))](StepReport& report, double seconds) {
      report.foam.stages.push_back({stage, seconds});
    };
  return [](StepReport&, double) {};
}

double numberOrZero(std::string_view cell) {
  double value = 0;
  std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return value;
}

}  // namespace

std::vector<StepReport> readKeptSteps(const std::string& path, int last) {
  std::vector<StepReport> steps;
  if (!std::filesystem::exists(path)) return steps;
  const std::string contents = readFile(path);
  TextLines lines(path, contents);
  std::string_view line, cell;
  std::vector<Setter> setters;
  if (lines.next(line))
    for (CommaFields fields(line); fields.next(cell);) setters.push_back(setterOf(cell));
  while (lines.next(line)) {
    StepReport report;
    CommaFields fields(line);
    for (std::size_t n = 0; n < setters.size() && fields.next(cell); ++n)
      setters[n](report, numberOrZero(cell));
    if (report.step < 1 || report.step > last) break;
    steps.push_back(std::move(report));
  }
  return steps;
}

}  // namespace spume::coupling
