#include "apps/wedge/variation.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace spume::apps {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& problem) {
  throw coupling::SceneError("--vary " + text + ": " + problem);
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Finds the commas that stand outside brackets, braces and quotes.
class ValueSplitter {
 public:
  /// The values, or nothing if a bracket, a brace or a quote is left open or closed twice.
  std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> values(1);
    for (std::size_t n = 0; n < list.size(); ++n) {
      const bool escaped = quote_ == '"' && list[n] == '\\' && n + 1 < list.size();
      if (escaped) {
        values.back() += list[n++];
      } else if (take(list[n])) {
        values.emplace_back();
        continue;
      }
      values.back() += list[n];
    }
    if (quote_ || !open_.empty() || wrong_) return {};
    std::transform(values.begin(), values.end(), values.begin(), trimmed);
    return values;
  }

 private:
  /// Follows a character; true for a comma between values.
  bool take(char c) {
    if (quote_) {
      if (c == quote_) quote_ = 0;
      return false;
    }
    if (c == '"' || c == '\'') quote_ = c;
    if (c == '[' || c == '{') open_ += c;
    if (c == ']' || c == '}') close(c == ']' ? '[' : '{');
    return c == ',' && open_.empty();
  }

  void close(char opener) {
    if (open_.empty() || open_.back() != opener)
      wrong_ = true;
    else
      open_.pop_back();
  }

  std::string open_;
  char quote_ = 0;
  bool wrong_ = false;
};

/// The text with everything that shells and file systems may stumble over as single underlines.
std::string fileSafe(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) || std::string("-_.+").find(c) != std::string::npos)
      safe += c;
    else if (!safe.empty() && safe.back() != '_')
      safe += '_';
  }
  while (!safe.empty() && safe.back() == '_') safe.pop_back();
  return safe.empty() ? "value" : safe;
}

std::string nameOf(const coupling::Overrides& variant) {
  std::string name;
  for (const coupling::Override& one : variant)
    name.append(name.empty() ? "" : "__").append(fileSafe(one.key)).append("=").append(fileSafe(one.value));
  return name.empty() ? "own" : name;
}

}  // namespace

Variation parseVariation(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    refuse(text, "expected table.key=value,value,..., e.g. --vary liquid.cfl=1,2,4");
  Variation variation{text, trimmed(text.substr(0, equals)), ValueSplitter().split(text.substr(equals + 1))};
  if (variation.values.empty())
    refuse(text, "a bracket, a brace or a quote is not closed; put the argument in quotes for the shell");
  std::set<std::string> seen;
  for (const std::string& value : variation.values) {
    if (value.empty()) refuse(text, "a value is empty; take out the comma too many");
    if (!seen.insert(value).second) refuse(text, "the value " + value + " is given twice");
  }
  return variation;
}

std::vector<coupling::Overrides> combinations(const std::vector<Variation>& variations) {
  std::vector<coupling::Overrides> all(1);
  std::set<std::string> keys;
  for (const Variation& variation : variations) {
    if (!keys.insert(variation.key).second)
      refuse(variation.text, "the key is varied twice; put all its values into one --vary");
    if (all.size() * variation.values.size() > kMostVariants)
      refuse(variation.text, "makes " + std::to_string(all.size() * variation.values.size()) +
                                 " variants or more; at most " + std::to_string(kMostVariants));
    std::vector<coupling::Overrides> longer;
    for (const coupling::Overrides& sofar : all)
      for (const std::string& value : variation.values) {
        longer.push_back(sofar);
        longer.back().push_back({variation.key, value, "--vary"});
      }
    all = std::move(longer);
  }
  return all;
}

std::vector<std::string> folderNames(const std::vector<coupling::Overrides>& variants) {
  std::set<std::string> taken;
  std::vector<std::string> names;
  for (const coupling::Overrides& variant : variants) {
    const std::string whole = nameOf(variant), stem = whole.substr(0, kLongestName);
    std::string name = stem;
    for (int number = 2; name.size() < whole.size() || taken.count(name); ++number) {
      const std::string close = "__" + std::to_string(number);
      name = stem.substr(0, kLongestName - close.size()) + close;
      if (!taken.count(name)) break;
    }
    taken.insert(name);
    names.push_back(name);
  }
  return names;
}

}  // namespace spume::apps
