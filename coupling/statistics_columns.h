#pragma once

#include <functional>
#include <string>
#include <vector>

#include "coupling/simulation.h"
#include "coupling/statistics.h"

namespace spume::coupling {

/// A column and how its cell is made from a report.
template <typename Report>
struct Column {
  ColumnInfo info;
  std::function<std::string(const Report&)> cell;
};

/// An event and the step it happened in.
struct EventRow {
  int step;
  const Event& event;
};

const std::vector<Column<StepReport>>& columnsOfSteps();
const std::vector<Column<FrameReport>>& columnsOfFrames();
const std::vector<Column<EventRow>>& columnsOfEvents();

}  // namespace spume::coupling
