#include "coupling/scene_document.h"

#include <charconv>
#include <optional>

#include "coupling/atomic_file.h"

namespace spume::coupling {
namespace {

std::vector<std::string> splitAtDots(const std::string& key) {
  std::vector<std::string> parts(1);
  for (const char c : key) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::optional<std::size_t> asIndex(const std::string& text) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return index;
}

/// Whether `key` is `table` or lies in it.
bool isAtOrIn(const std::string& key, const std::string& table) {
  return key == table || key.rfind(table + ".", 0) == 0;
}

toml::table parse(const std::string& text, const std::string& path) {
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw SceneError(path + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) +
                     ": syntax: " + std::string(error.description()));
  }
}

/// { value = `text` }; where that is no TOML the text is a string.
toml::table valueTable(const std::string& text) {
  try {
    toml::table table = toml::parse("value = " + text);
    if (table.size() == 1) return table;
  } catch (const toml::parse_error&) {
  }
  return toml::table{{"value", text}};
}

/// The child of `node` called `part`; a missing table is made. Null where `node` cannot have one.
toml::node* childOf(toml::node& node, const std::string& part) {
  if (toml::array* array = node.as_array()) {
    const auto index = asIndex(part);
    return index ? array->get(*index) : nullptr;
  }
  toml::table* table = node.as_table();
  if (!table || (asIndex(part) && !table->contains(part))) return nullptr;
  return &table->insert(part, toml::table{}).first->second;  // keeps what is there
}

}  // namespace

SceneDocument::SceneDocument(const std::string& path, const Overrides& overrides)
    : path_(path), root_(parse(readFile(path), path)) {
  for (const Override& given : overrides) apply(given);
}

void SceneDocument::apply(const Override& given) {
  const std::vector<std::string> parts = splitAtDots(given.key);
  toml::node* node = &root_;
  for (std::size_t i = 0; node && i + 1 < parts.size(); ++i) node = childOf(*node, parts[i]);
  toml::table* table = node ? node->as_table() : nullptr;
  if (!table)
    throw SceneError(given.text() +
                     ": there is no such table in the scene; use table.key, or array.0.key for an item that "
                     "the file holds");
  toml::table parsed = valueTable(given.value);
  parsed.begin()->second.visit([&](auto& typed) { table->insert_or_assign(parts.back(), std::move(typed)); });
  overrides_[given.key] = given.text();
}

std::string SceneDocument::place(const std::string& key, const toml::source_region& source) const {
  const auto found = overrides_.lower_bound(key);  // the key itself, or one inside the table it names
  const bool overridden = found != overrides_.end() && isAtOrIn(found->first, key);
  if (overridden && (found->first == key || !source.begin)) return found->second;
  if (!source.begin) return path_;
  return path_ + ":" + std::to_string(source.begin.line) + ":" + std::to_string(source.begin.column) +
         (overridden ? " with " + found->second : "");
}

std::string SceneDocument::place(const std::string& key) const {
  const toml::node* node = &root_;
  toml::source_region source{};
  std::string found;  // as much of the key as the file holds
  for (const std::string& part : splitAtDots(key)) {
    const auto index = asIndex(part);
    if (const toml::table* table = node->as_table()) {
      node = table->get(part);
    } else {
      node = node->as_array() && index ? node->as_array()->get(*index) : nullptr;
    }
    if (!node) break;
    found.append(found.empty() ? "" : ".").append(part);
    if (node->source().begin) source = node->source();
  }
  return place(found, source);
}

}  // namespace spume::coupling
