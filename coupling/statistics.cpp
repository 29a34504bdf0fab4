#include "coupling/statistics.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "coupling/atomic_file.h"
#include "coupling/statistics_columns.h"
#include "coupling/toml_slot.h"

namespace spume::coupling {
namespace {

constexpr char kStagePrefix[] = ",seconds_";

template <typename Report>
std::vector<ColumnInfo> infosOf(const std::vector<Column<Report>>& columns) {
  std::vector<ColumnInfo> infos;
  for (const auto& column : columns) infos.push_back(column.info);
  return infos;
}

template <typename Report>
std::string headerOf(const std::vector<Column<Report>>& columns) {
  std::string header;
  for (const auto& column : columns) header += (header.empty() ? "" : ",") + column.info.name;
  return header;
}

template <typename Report>
std::string rowOf(const std::vector<Column<Report>>& columns, const Report& report) {
  std::string row;
  for (const auto& column : columns) row.append(row.empty() ? "" : ",").append(column.cell(report));
  return row;
}

/// The header and the rows whose first cell is at most `last`; a row without its end of line was cut off.
std::string keptRows(const std::string& contents, int last, std::string& header) {
  std::string kept;
  std::size_t start = 0;
  for (std::size_t end; (end = contents.find('\n', start)) != std::string::npos; start = end + 1) {
    const std::string line = contents.substr(start, end - start);
    if (start == 0) header = line;
    if (start == 0 || std::atol(line.c_str()) <= last) kept += line + "\n";
  }
  return kept;
}

std::string probeHeader(const std::vector<ColumnInfo>& probes) {
  std::string header = "step,time";
  for (const ColumnInfo& probe : probes) header += "," + probe.name;
  return header;
}

std::string probeRow(const StepReport& report) {
  std::ostringstream row;
  row << report.step << ',' << exactText(report.time);
  for (const double value : report.probes) row << ',' << exactText(value);
  return row.str();
}

/// Every stage either module timed, in their order, with what is added for each.
template <typename Visit>
void forEachStage(const StepReport& report, const Visit& visit) {
  for (const auto& stage : report.liquid.stages) visit("liquid_" + stage.stage, stage.seconds);
  for (const auto& stage : report.foam.stages) visit("foam_" + stage.stage, stage.seconds);
}

std::string spacesToUnderlines(std::string text) {
  std::replace(text.begin(), text.end(), ' ', '_');
  std::replace(text.begin(), text.end(), ',', '_');
  return text;
}

}  // namespace

std::vector<ColumnInfo> stepColumns() { return infosOf(columnsOfSteps()); }
std::vector<ColumnInfo> frameColumns() { return infosOf(columnsOfFrames()); }
std::vector<ColumnInfo> eventColumns() { return infosOf(columnsOfEvents()); }

StatisticsWriter::StatisticsWriter(const std::string& folder, int step, int frame,
                                   const std::vector<ColumnInfo>& probes)
    : steps_(openFile(folder + "/steps.csv", "", step)),
      frames_(openFile(folder + "/frames.csv", headerOf(columnsOfFrames()), frame)),
      events_(openFile(folder + "/events.csv", headerOf(columnsOfEvents()), step)) {
  if (!probes.empty()) probes_ = openFile(folder + "/probes.csv", probeHeader(probes), step);
  const std::string fixed = headerOf(columnsOfSteps());
  if (steps_.header.size() <= fixed.size()) return;
  std::istringstream stages(steps_.header.substr(fixed.size()));  // ",seconds_a,seconds_b"
  std::string name;
  std::getline(stages, name, ',');
  while (std::getline(stages, name, ',')) stages_.push_back(name.substr(std::strlen(kStagePrefix) - 1));
}

StatisticsWriter::File StatisticsWriter::openFile(const std::string& path, const std::string& header,
                                                  int lastKept) {
  File file{path, header, {}};
  std::string kept;
  if (lastKept > 0 && std::filesystem::exists(path)) kept = keptRows(readFile(path), lastKept, file.header);
  if (kept.empty() && !header.empty()) kept = header + "\n";
  replaceFile(path, kept);
  file.stream.open(path, std::ios::binary | std::ios::app);
  if (!file.stream) throw FileError(path + ": cannot write: " + std::strerror(errno));
  return file;
}

void StatisticsWriter::writeRow(File& file, const std::string& row) {
  errno = 0;
  file.stream << row << '\n';
  if (!file.stream) throw FileError(file.path + ": cannot write: " + std::strerror(errno ? errno : EIO));
}

void StatisticsWriter::startSteps(const StepReport& first) {
  steps_.header = headerOf(columnsOfSteps());
  forEachStage(first,
               [&](const std::string& stage, double) { stages_.push_back(spacesToUnderlines(stage)); });
  for (const std::string& stage : stages_) steps_.header += kStagePrefix + stage;
  writeRow(steps_, steps_.header);
}

void StatisticsWriter::add(const StepReport& report) {
  if (steps_.header.empty()) startSteps(report);
  std::vector<double> seconds(stages_.size(), 0.0);
  forEachStage(report, [&](const std::string& stage, double spent) {
    const auto found = std::find(stages_.begin(), stages_.end(), spacesToUnderlines(stage));
    if (found != stages_.end()) seconds[found - stages_.begin()] += spent;
  });
  std::string row = rowOf(columnsOfSteps(), report);
  for (const double spent : seconds) row += ',', row += exactText(spent);
  writeRow(steps_, row);
  for (const Event& event : report.events) writeRow(events_, rowOf(columnsOfEvents(), {report.step, event}));
  if (!report.probes.empty()) writeRow(probes_, probeRow(report));
}

void StatisticsWriter::add(const FrameReport& report) {
  writeRow(frames_, rowOf(columnsOfFrames(), report));
  for (File* file : {&steps_, &frames_, &events_, &probes_}) {
    errno = 0;
    file->stream.flush();
    if (!file->stream) throw FileError(file->path + ": cannot write: " + std::strerror(errno ? errno : EIO));
  }
}

}  // namespace spume::coupling
