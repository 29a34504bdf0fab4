#pragma once

#include <string>

namespace spume::apps {

/// A text as one word of a POSIX shell: in quotes if it holds anything a shell may read otherwise.
std::string shellWord(const std::string& text);

}  // namespace spume::apps
