#include "apps/wedge/shell_word.h"

#include <algorithm>
#include <cctype>

namespace spume::apps {
namespace {

/// What no shell reads as anything but itself, wherever it stands in an argument.
bool isPlain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || std::string("-_./+=,:").find(c) != std::string::npos;
}

}  // namespace

std::string shellWord(const std::string& text) {
  if (!text.empty() && std::all_of(text.begin(), text.end(), isPlain)) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

}  // namespace spume::apps
