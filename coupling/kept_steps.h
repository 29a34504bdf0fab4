#pragma once

#include <string>
#include <vector>

#include "coupling/simulation.h"

namespace spume::coupling {

/// Reports of the steps that a resumed run has behind it, as far as its steps.csv holds them: all that
/// frames.csv and run.json sum up. Up to and including step `last`; none where there is no such file. A cell
/// that is no number counts as 0. Throws FileError where the file cannot be read.
std::vector<StepReport> readKeptSteps(const std::string& path, int last);

}  // namespace spume::coupling
