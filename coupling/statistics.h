#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "coupling/errors.h"
#include "coupling/simulation.h"

namespace spume::coupling {

/// A column of a statistics file: its name, its unit and what it holds.
struct ColumnInfo {
  std::string name, unit, meaning;
};

std::vector<ColumnInfo> stepColumns();
std::vector<ColumnInfo> frameColumns();
std::vector<ColumnInfo> eventColumns();

/// steps.csv, frames.csv and events.csv of a run, one row a step, frame or event, numbers that read back
/// exactly.
class StatisticsWriter {
 public:
  /// Starts new files, or, where `step` > 0, keeps the rows up to and including step `step` and frame `frame`
  /// of files a resumed run left. Throws FileError.
  explicit StatisticsWriter(const std::string& folder, int step = 0, int frame = 0);

  /// Appends the step's row and its events. Throws FileError if a row cannot be written.
  void add(const StepReport& report);
  /// Appends the frame's row and flushes all files. Throws FileError.
  void add(const FrameReport& report);

 private:
  struct File {
    std::string path;
    std::ofstream stream;
  };
  File steps_, frames_, events_;
};

}  // namespace spume::coupling
