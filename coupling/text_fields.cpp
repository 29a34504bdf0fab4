#include "coupling/text_fields.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "coupling/errors.h"

namespace spume::coupling {
namespace {

constexpr double kLargestExactInteger = 9007199254740992.0;  ///< 2^53: a double holds every one up to it

bool isBlank(char c) { return c == ' ' || c == '\t'; }

/// The line at the start of `text`, with its line feed.
std::string_view firstLine(std::string_view text) {
  const std::size_t feed = text.find('\n');
  return feed == std::string_view::npos ? text : text.substr(0, feed + 1);
}

std::string_view withoutLineEnd(std::string_view line) {
  if (line.ends_with('\n')) line.remove_suffix(1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// std::from_chars knows no plus sign.
std::string_view withoutPlus(std::string_view field) {
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
  return field;
}

template <typename Number>
std::errc parseWhole(std::string_view field, Number& value) {
  const char* const end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, value);
  return error == std::errc() && stop != end ? std::errc::invalid_argument : error;
}

}  // namespace

bool TextLines::next(std::string_view& line) {
  if (offset_ >= text_.size()) return false;
  const std::string_view whole = firstLine(rest());
  offset_ += whole.size();
  ++number_;
  line = withoutLineEnd(whole);
  return true;
}

std::string_view TextLines::lineAt(std::size_t offset) const {
  return withoutLineEnd(firstLine(text_.substr(offset)));
}

std::string TextLines::placeOf(std::string_view piece) const {
  const std::string_view before = text_.substr(0, offsetOf(piece));
  const std::size_t feed = before.rfind('\n');
  const std::size_t lineStart = feed == std::string_view::npos ? 0 : feed + 1;
  return path_ + ":" + std::to_string(1 + std::count(before.begin(), before.end(), '\n')) + ":" +
         std::to_string(1 + before.size() - lineStart);
}

void TextLines::fail(std::string_view piece, const std::string& problem) const {
  throw SceneError(placeOf(piece) + ": " + problem);
}

std::string quoted(std::string_view text) {
  std::string out(1, '\'');
  out.append(text).push_back('\'');
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

bool nextWord(std::string_view& rest, std::string_view& word) {
  rest = trimmed(rest);
  std::size_t length = 0;
  while (length < rest.size() && !isBlank(rest[length])) ++length;
  word = rest.substr(0, length);
  rest.remove_prefix(length);
  return length > 0;
}

bool CommaFields::next(std::string_view& field) {
  if (done_) return false;
  const std::size_t comma = rest_.find(',');
  done_ = comma == std::string_view::npos;
  field = trimmed(rest_.substr(0, comma));
  if (!done_) rest_.remove_prefix(comma + 1);
  return true;
}

double numberIn(const TextLines& lines, std::string_view field, std::string_view column) {
  double value = 0;
  const std::errc error = parseWhole(withoutPlus(field), value);
  if (error == std::errc()) return value;
  const std::string what = std::string(column) + " = " + quoted(field);
  if (error == std::errc::result_out_of_range)
    lines.fail(field, what + " does not fit into a number of double precision (1e-307 to 1e308)");
  lines.fail(field, what + " is not a number; expected e.g. 0.0015 or 1.5e-3");
}

std::uint64_t idIn(const TextLines& lines, std::string_view field) {
  std::uint64_t id = 0;
  if (parseWhole(withoutPlus(field), id) == std::errc()) return id;
  double value = 0;
  if (parseWhole(withoutPlus(field), value) == std::errc() && isExactId(value, id)) return id;
  lines.fail(field, "id = " + quoted(field) + " is not an integer from 0 to 2^64 - 1");
}

bool isExactId(double value, std::uint64_t& id) {
  if (!(value >= 0 && value <= kLargestExactInteger) || value != std::floor(value)) return false;
  id = static_cast<std::uint64_t>(value);
  return true;
}

}  // namespace spume::coupling
