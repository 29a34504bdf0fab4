#include <algorithm>
#include <cctype>

#include "coupling/bubble_columns.h"
#include "coupling/bubble_table.h"
#include "coupling/nearest_key.h"
#include "coupling/text_fields.h"

namespace spume::coupling {
namespace {

constexpr std::size_t kIgnored = kBubbleColumns;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ",") + name;
  return text;
}

/// Spreadsheets put quotes around names.
std::string_view unquoted(std::string_view name) {
  const bool quoted = name.size() >= 2 && name.front() == '"' && name.back() == '"';
  return quoted ? name.substr(1, name.size() - 2) : name;
}

bool hasContent(std::string_view line) {
  line = trimmed(line);
  return !line.empty() && line.front() != '#';
}

class CsvReader {
 public:
  CsvReader(const std::string& path, std::string_view text) : path_(path), lines_(path, text) {}

  BubbleTable read() {
    std::string_view line;
    if (!nextLine(line)) throw SceneError(path_ + ": is empty; expected a header such as id,x,y,z,r");
    readHeader(line);
    while (nextLine(line)) {
      rowStart_.push_back(lines_.offsetOf(line));
      table_.line.push_back(lines_.number());
      readRow(line);
    }
    if (!table_.size()) throw SceneError(path_ + ": has a header but no bubbles");
    checkBubbles(table_, [this](std::size_t row, std::string_view column) { return placeOf(row, column); });
    return std::move(table_);
  }

 private:
  bool nextLine(std::string_view& line) {
    while (lines_.next(line))
      if (hasContent(line)) return true;
    return false;
  }

  void readHeader(std::string_view line);
  void assignColumn(std::string_view name);
  void requireColumns(std::string_view header) const;
  std::string nearestUnused(std::string_view wanted) const;
  void readRow(std::string_view line);
  std::string placeOf(std::size_t row, std::string_view column) const;

  std::string path_;
  TextLines lines_;
  std::vector<std::string> names_;     ///< of the header
  std::vector<std::size_t> role_;      ///< by field: its BubbleColumn, or kIgnored
  std::vector<std::size_t> rowStart_;  ///< by bubble: bytes before its line
  bool hasWetness_ = false;
  BubbleTable table_;
};

void CsvReader::readHeader(std::string_view line) {
  CommaFields fields(line);
  for (std::string_view field; fields.next(field);) assignColumn(unquoted(field));
  requireColumns(line);
}

void CsvReader::assignColumn(std::string_view name) {
  const std::size_t role = bubbleColumn(name);
  if (role != kIgnored && std::count(role_.begin(), role_.end(), role))
    lines_.fail(name, "column " + std::string(name) + " is given twice");
  if (role == kIgnored && !name.empty()) table_.unread.emplace_back(name);
  hasWetness_ = hasWetness_ || role == kWetness;
  names_.emplace_back(name);
  role_.push_back(role);
}

void CsvReader::requireColumns(std::string_view header) const {
  const auto given = [&](std::size_t column) { return std::count(role_.begin(), role_.end(), column); };
  const bool velocity = given(kVx) || given(kVy) || given(kVz);
  for (std::size_t column = 0; column < (velocity ? kWetness : kVx); ++column) {
    if (given(column)) continue;
    const std::string nearest = nearestUnused(kBubbleColumnName[column]);
    lines_.fail(header, "column " + std::string(kBubbleColumnName[column]) + " is missing" +
                            (nearest.empty() ? "" : "; the nearest one is " + quoted(nearest)) +
                            "; the header is " + joined(names_) + ", expected id,x,y,z,r" +
                            (velocity ? ",vx,vy,vz" : ""));
  }
}

/// Among the columns without a role; short names have so few letters that the first one counts most.
std::string CsvReader::nearestUnused(std::string_view wanted) const {
  std::vector<std::string> unused, sameInitial;
  for (std::size_t f = 0; f < names_.size(); ++f) {
    if (role_[f] != kIgnored || names_[f].empty()) continue;
    unused.push_back(names_[f]);
    if (std::tolower(static_cast<unsigned char>(names_[f][0])) == wanted[0]) sameInitial.push_back(names_[f]);
  }
  return nearestOf(std::string(wanted), sameInitial.empty() ? unused : sameInitial);
}

void CsvReader::readRow(std::string_view line) {
  BubbleValues value{};
  std::size_t count = 0;
  CommaFields fields(line);
  for (std::string_view field; fields.next(field); ++count) {
    if (count == role_.size())
      lines_.fail(field, "the row has more fields than the header's " + std::to_string(role_.size()));
    const std::size_t role = role_[count];
    if (role == kId)
      table_.id.push_back(idIn(lines_, field));
    else if (role != kIgnored)
      value[role] = numberIn(lines_, field, kBubbleColumnName[role]);
  }
  if (count < role_.size())
    lines_.fail(line, "the row has " + std::to_string(count) + " fields, the header " +
                          std::to_string(role_.size()) + " (" + joined(names_) + ")");
  table_.position.emplace_back(value[kX], value[kY], value[kZ]);
  table_.radius.push_back(value[kR]);
  table_.velocity.emplace_back(value[kVx], value[kVy], value[kVz]);
  if (hasWetness_) table_.wetness.push_back(value[kWetness]);
}

std::string CsvReader::placeOf(std::size_t row, std::string_view column) const {
  const std::size_t wanted = bubbleColumn(column);
  CommaFields fields(lines_.lineAt(rowStart_[row]));
  std::string_view field;
  for (std::size_t f = 0; fields.next(field) && role_[f] != wanted; ++f) continue;
  return lines_.placeOf(field);
}

}  // namespace

BubbleTable parseBubbleCsv(const std::string& path, std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return CsvReader(path, text).read();
}

}  // namespace spume::coupling
