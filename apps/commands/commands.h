#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace spume::apps {

/// What a parsed command line asks for; returns the exit code. Set by the verb that was chosen.
using Action = std::function<int()>;

/// Each declares a verb with its options and examples.
void addRun(CLI::App& program, Action& action);
void addFoam(CLI::App& program, Action& action);
void addCheck(CLI::App& program, Action& action);
void addInfo(CLI::App& program, Action& action);
void addRender(CLI::App& program, Action& action);
void addMeasure(CLI::App& program, Action& action);
void addWedge(CLI::App& program, Action& action);
void addTrade(CLI::App& program, Action& action);

}  // namespace spume::apps
