#pragma once

#include <string>

#include "apps/trade/trade.h"

namespace spume::apps {

/// The page for a person, as Markdown: what may be turned and what the scene does not need, dials against the
/// reference, terms against the scene's own settings. Differences larger than the noise are bold. `plot`: the
/// picture's file, beside the page; `command`: how it was made; `reading`: what a person made of it.
std::string tradePage(const Trade& trade, const std::string& plot, const std::string& command,
                      const std::string& reading = {});

/// The paragraph of a page that begins with "Reading:", written by hand and kept when the page is made again;
/// empty if it has none.
std::string readingOf(const std::string& page);

}  // namespace spume::apps
