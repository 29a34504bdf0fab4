#pragma once

#include "apps/commands/commands.h"

namespace spume::apps {

/// Declares the verb that makes validation tables, with its options and examples.
void addReproduce(CLI::App& program, Action& action);

}  // namespace spume::apps
