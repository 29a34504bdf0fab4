#pragma once

#include <string>

#include "apps/trade/trade.h"

namespace spume::apps {

/// The page for a person, as Markdown: what may be turned and what the scene does not need, dials against the
/// reference, terms against the scene's own settings. Differences beyond the noise are bold. `plot`: the
/// picture's file, beside the page; `command`: how it was made.
std::string tradePage(const Trade& trade, const std::string& plot, const std::string& command);

}  // namespace spume::apps
