#pragma once

#include <string>
#include <vector>

namespace spume::apps {

/// A field of CSV: quoted where it holds a comma or a quote.
std::string csvField(const std::string& text);

/// The fields of a line of CSV, quotes taken off.
std::vector<std::string> csvFields(const std::string& line);

}  // namespace spume::apps
