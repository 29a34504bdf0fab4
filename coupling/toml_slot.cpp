#include "coupling/toml_slot.h"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace spume::coupling {
namespace {

using Walls = std::array<bool, 6>;

constexpr const char* kWallNames[6] = {"-x", "+x", "-y", "+y", "-z", "+z"};
constexpr double kLongestTime = 1e9;  // [s] keys of an animation; 32 years

template <typename... Cases>
struct Overload : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
Overload(Cases...) -> Overload<Cases...>;

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string inUnit(const KeyRange& range) {
  return exactText(range.least) + " to " + exactText(range.most) + " [" +
         (range.unit.empty() ? "-" : range.unit) + "]";
}

std::string describe(const toml::node& node) {
  std::ostringstream text;
  text << (node.is_table()     ? "a table"
           : node.is_array()   ? "an array"
           : node.is_string()  ? "a string"
           : node.is_boolean() ? "a truth value"
           : node.is_number()  ? "a number"
                               : "a date");
  if (node.is_value()) node.visit([&](const auto& value) { text << " (" << toml::node_view{value} << ")"; });
  return text.str();
}

double numberIn(const toml::node& node, const KeyRange& range) {
  if (!node.is_number()) throw BadValue("is " + describe(node) + "; expected a number, " + inUnit(range));
  const double value = *node.value<double>();
  if (!(value >= range.least && value <= range.most))
    throw BadValue("= " + exactText(value) + " is out of range; allowed: " + inUnit(range));
  return value;
}

std::int64_t integerIn(const toml::node& node, const KeyRange& range) {
  if (!node.is_integer())
    throw BadValue("is " + describe(node) + "; expected a whole number, " + inUnit(range));
  numberIn(node, range);
  return node.as_integer()->get();
}

const toml::array& arrayOf(const toml::node& node, std::size_t length, const KeyRange& range) {
  const toml::array* array = node.as_array();
  const std::string expected =
      "expected " + std::to_string(length) + " numbers in brackets, " + inUnit(range);
  if (!array) throw BadValue("is " + describe(node) + "; " + expected);
  if (array->size() != length)
    throw BadValue("has " + std::to_string(array->size()) + " entries; " + expected);
  return *array;
}

std::string stringOf(const toml::node& node, const std::string& expected) {
  if (!node.is_string()) throw BadValue("is " + describe(node) + "; expected " + expected);
  return node.as_string()->get();
}

/// Index of `name` among `names`.
std::size_t oneOf(const std::string& name, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw BadValue("= " + quoted(name) + " is not one of: " + joined(names));
  return found - names.begin();
}

Walls wallsOf(const toml::node& node) {
  const std::vector<std::string> names(std::begin(kWallNames), std::end(kWallNames));
  const toml::array* array = node.as_array();
  if (!array) throw BadValue("is " + describe(node) + "; expected a list of walls out of: " + joined(names));
  Walls walls{};
  for (const toml::node& entry : *array) walls[oneOf(stringOf(entry, "the name of a wall"), names)] = true;
  return walls;
}

/// The keys of an animation whose value has `length` numbers: [t, value ...] each, times increasing.
template <typename Keys, typename ReadValue>
Keys keysOf(const toml::table& table, std::size_t length, const KeyRange& range, const ReadValue& readValue) {
  const std::string expected = length == 1 ? "expected a number or { keys = [[t, value], ...] }"
                                           : "expected 3 numbers or { keys = [[t, x, y, z], ...] }";
  const toml::array* entries = table["keys"].as_array();
  if (!entries || table.size() != 1 || entries->empty())
    throw BadValue("is a table; " + expected + " with increasing times");
  Keys keys;
  for (const toml::node& entry : *entries) {
    const toml::array& key = arrayOf(entry, 1 + length, range);
    const double time = numberIn(key[0], {-kLongestTime, kLongestTime, "s"});
    if (!keys.empty() && time <= keys.back().first)
      throw BadValue("has a key at " + exactText(time) + " s that is not later than the one before it; " +
                     expected + " with increasing times");
    keys.emplace_back(time, readValue(key));
  }
  return keys;
}

Animated animationOf(const toml::node& node, const KeyRange& range) {
  Animated animation;
  if (!node.is_table()) return Animated(numberIn(node, range));
  animation.keys = keysOf<decltype(animation.keys)>(
      *node.as_table(), 1, range, [&](const toml::array& key) { return numberIn(key[1], range); });
  return animation;
}

Eigen::Vector3d vectorIn(const toml::array& array, std::size_t first, const KeyRange& range) {
  return {numberIn(array[first], range), numberIn(array[first + 1], range),
          numberIn(array[first + 2], range)};
}

AnimatedVector vectorAnimationOf(const toml::node& node, const KeyRange& range) {
  AnimatedVector animation;
  if (!node.is_table()) return AnimatedVector(vectorIn(arrayOf(node, 3, range), 0, range));
  animation.keys = keysOf<decltype(animation.keys)>(
      *node.as_table(), 3, range, [&](const toml::array& key) { return vectorIn(key, 1, range); });
  return animation;
}

template <typename Vector>
std::string vectorText(const Vector& vector) {
  std::string text;
  for (const auto component : vector) text += (text.empty() ? "" : ", ") + exactText(component);
  return "[" + text + "]";
}

/// One constant, or all keys, each as `keyText` writes it.
template <typename Keys, typename ValueText, typename KeyText>
std::string animationText(const Keys& keys, const ValueText& valueText, const KeyText& keyText) {
  if (keys.size() == 1) return valueText(keys.front().second);
  std::string text;
  for (const auto& [time, value] : keys) text.append(text.empty() ? "" : ", ").append(keyText(time, value));
  return "{ keys = [" + text + "] }";
}

std::string animationText(const Animated& animation) {
  return animationText(
      animation.keys, [](double value) { return exactText(value); },
      [](double time, double value) { return vectorText(Eigen::Vector2d(time, value)); });
}

std::string animationText(const AnimatedVector& animation) {
  return animationText(animation.keys, vectorText<Eigen::Vector3d>,
                       [](double time, const Eigen::Vector3d& value) {
                         return vectorText(Eigen::Vector4d(time, value.x(), value.y(), value.z()));
                       });
}

std::string wallsText(const Walls& walls) {
  std::string text;
  for (int side = 0; side < 6; ++side)
    if (walls[side]) text += (text.empty() ? "" : ", ") + quoted(kWallNames[side]);
  return "[" + text + "]";
}

}  // namespace

void assign(const Slot& slot, const KeyRange& range, const toml::node& node) {
  std::visit(
      Overload{[&](bool* value) {
                 if (!node.is_boolean()) throw BadValue("is " + describe(node) + "; expected true or false");
                 *value = node.as_boolean()->get();
               },
               [&](int* value) { *value = static_cast<int>(integerIn(node, range)); },
               [&](std::uint64_t* value) { *value = static_cast<std::uint64_t>(integerIn(node, range)); },
               [&](double* value) { *value = numberIn(node, range); },
               [&](std::string* value) { *value = stringOf(node, "a string in quotes"); },
               [&](Eigen::Vector2i* value) {
                 const toml::array& array = arrayOf(node, 2, range);
                 for (int i = 0; i < 2; ++i) (*value)[i] = static_cast<int>(integerIn(array[i], range));
               },
               [&](Eigen::Vector3d* value) { *value = vectorIn(arrayOf(node, 3, range), 0, range); },
               [&](Animated* value) { *value = animationOf(node, range); },
               [&](AnimatedVector* value) { *value = vectorAnimationOf(node, range); },
               [&](Walls* value) { *value = wallsOf(node); },
               [&](const ChoiceSlot& choice) {
                 const std::string expected = "one of: " + joined(choice.names);
                 choice.set(static_cast<int>(oneOf(stringOf(node, expected), choice.names)));
               }},
      slot);
}

std::string toToml(const Slot& slot) {
  return std::visit(Overload{[](const bool* value) { return std::string(*value ? "true" : "false"); },
                             [](const int* value) { return std::to_string(*value); },
                             [](const std::uint64_t* value) { return std::to_string(*value); },
                             [](const double* value) { return exactText(*value); },
                             [](const std::string* value) { return quoted(*value); },
                             [](const Eigen::Vector2i* value) { return vectorText(*value); },
                             [](const Eigen::Vector3d* value) { return vectorText(*value); },
                             [](const Animated* value) { return animationText(*value); },
                             [](const AnimatedVector* value) { return animationText(*value); },
                             [](const Walls* value) { return wallsText(*value); },
                             [](const ChoiceSlot& choice) { return quoted(choice.names.at(choice.get())); }},
                    slot);
}

std::string typeName(const Slot& slot) {
  return std::visit(
      Overload{
          [](const bool*) { return std::string("true or false"); },
          [](const int*) { return std::string("whole number"); },
          [](const std::uint64_t*) { return std::string("whole number"); },
          [](const double*) { return std::string("number"); },
          [](const std::string*) { return std::string("string"); },
          [](const Eigen::Vector2i*) { return std::string("2 whole numbers"); },
          [](const Eigen::Vector3d*) { return std::string("3 numbers"); },
          [](const Animated*) { return std::string("number or { keys = [[t, value], ...] }"); },
          [](const AnimatedVector*) { return std::string("3 numbers or { keys = [[t, x, y, z], ...] }"); },
          [](const Walls*) {
            return "list out of " + wallsText({true, true, true, true, true, true});
          },
          [](const ChoiceSlot& choice) { return "one of " + joined(choice.names); }},
      slot);
}

std::string rangeText(const Slot& slot, const KeyRange& range) {
  const bool none = std::holds_alternative<bool*>(slot) || std::holds_alternative<std::string*>(slot) ||
                    std::holds_alternative<Walls*>(slot) || std::holds_alternative<ChoiceSlot>(slot);
  return none ? std::string() : inUnit(range);
}

std::string exactText(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string exactText(const Eigen::Vector3d& vector) { return vectorText(vector); }

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    char escaped[8];
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      std::snprintf(escaped, sizeof escaped, "\\u%04X", static_cast<unsigned>(c));
      out += escaped;
    } else {
      out += c;
    }
  }
  return out + '"';
}

}  // namespace spume::coupling
