#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "coupling/errors.h"
#include "coupling/simulation.h"

namespace spume::coupling {

/// A column of a statistics file: its name, its unit ("-" if none) and what it holds.
struct ColumnInfo {
  std::string name, unit, meaning;
};

/// Columns of steps.csv. Behind them follows one column `seconds_<stage>` for every stage the run's first
/// step timed.
std::vector<ColumnInfo> stepColumns();
std::vector<ColumnInfo> frameColumns();
std::vector<ColumnInfo> eventColumns();

/// steps.csv, frames.csv, events.csv and probes.csv of a run, one row a step, frame, event or reading of the
/// probes, numbers that read back exactly.
class StatisticsWriter {
 public:
  /// Starts new files, or, where `step` > 0, keeps the rows up to and including step `step` and frame `frame`
  /// of the files a resumed run left. probes.csv is written if there are `probes`. Throws FileError.
  explicit StatisticsWriter(const std::string& folder, int step = 0, int frame = 0,
                            const std::vector<ColumnInfo>& probes = {});

  /// Appends the step's row and its events. Throws FileError if a row cannot be written.
  void add(const StepReport& report);
  /// Appends the frame's row and hands all files to the system. Throws FileError.
  void add(const FrameReport& report);

 private:
  struct File {
    std::string path;
    std::string header;  ///< without the end of line; empty: not yet known
    std::ofstream stream;
  };
  static File openFile(const std::string& path, const std::string& header, int lastKept);
  static void writeRow(File& file, const std::string& row);
  void startSteps(const StepReport& first);

  File steps_, frames_, events_, probes_;
  std::vector<std::string> stages_;  ///< names of the trailing columns of steps.csv
};

}  // namespace spume::coupling
