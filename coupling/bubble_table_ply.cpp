#include <algorithm>
#include <array>

#include "coupling/bubble_columns.h"
#include "coupling/bubble_table.h"
#include "coupling/nearest_key.h"
#include "coupling/ply_header.h"
#include "coupling/text_fields.h"

namespace spume::coupling {
namespace {

constexpr int kAbsent = -1;

class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view bytes)
      : path_(path), lines_(path, bytes), header_(readPlyHeader(lines_, path)) {}

  BubbleTable read() {
    findColumns();
    if (header_.format == PlyFormat::ascii)
      readAscii();
    else
      readBinary();
    checkBubbles(table_, [this](std::size_t row, std::string_view column) { return placeOf(row, column); });
    return std::move(table_);
  }

 private:
  void findColumns();
  void requireColumn(BubbleColumn column) const;
  void readAscii();
  void readAsciiRow(std::string_view line, std::size_t row);
  void readBinary();
  void resize();
  void store(std::size_t row, std::uint64_t id, const BubbleValues& value);
  std::uint64_t binaryId(std::size_t row, double value) const;
  [[noreturn]] void failShort(std::size_t held) const;
  std::string placeOf(std::size_t row, std::string_view column) const;

  const std::string& path_;
  TextLines lines_;
  PlyHeader header_;
  std::array<int, kBubbleColumns> property_{};  ///< by column: index into the header's properties, or kAbsent
  std::vector<std::size_t> rowStart_;           ///< of an ascii file: bytes before a bubble's line
  BubbleTable table_;
};

void PlyReader::findColumns() {
  for (std::size_t c = 0; c < kBubbleColumns; ++c) property_[c] = header_.find(kBubbleColumnName[c]);
  for (const char* name : {"pscale", "radius"})  // what renderers call it goes before a mere r
    if (header_.find(name) != kAbsent) property_[kR] = header_.find(name);
  for (const BubbleColumn column : {kX, kY, kZ, kR}) requireColumn(column);
  table_.isNumbered = property_[kId] == kAbsent;
}

void PlyReader::requireColumn(BubbleColumn column) const {
  if (property_[column] != kAbsent) return;
  std::vector<std::string> unused;
  for (std::size_t k = 0; k < header_.properties.size(); ++k)
    if (std::find(property_.begin(), property_.end(), static_cast<int>(k)) == property_.end())
      unused.push_back(header_.properties[k].name);
  const std::string wanted = column == kR ? "radius" : std::string(kBubbleColumnName[column]);
  const std::string nearest = nearestOf(wanted, unused);
  throw SceneError(path_ + ": the vertices have no property " + wanted +
                   (column == kR ? " (or pscale, or r)" : "") +
                   (nearest.empty() ? "" : "; the nearest one is " + quoted(nearest)));
}

void PlyReader::readAscii() {
  const std::size_t shortest = 2 * header_.properties.size();  // a digit and a blank a property
  if (header_.vertices > lines_.rest().size() / shortest + 1) failShort(lines_.rest().size() / shortest);
  resize();
  rowStart_.resize(header_.vertices);
  std::string_view line;
  for (std::size_t row = 0; row < header_.vertices;) {
    if (!lines_.next(line)) failShort(row);
    if (trimmed(line).empty()) continue;
    rowStart_[row] = lines_.offsetOf(line);
    readAsciiRow(line, row++);
  }
}

void PlyReader::readAsciiRow(std::string_view line, std::size_t row) {
  BubbleValues value{};
  std::uint64_t id = row;
  std::string_view rest = line, word;
  for (std::size_t k = 0; k < header_.properties.size(); ++k) {
    if (!nextWord(rest, word))
      lines_.fail(line, "the vertex has " + std::to_string(k) + " numbers, expected " +
                            std::to_string(header_.properties.size()));
    const auto column =
        std::find(property_.begin(), property_.end(), static_cast<int>(k)) - property_.begin();
    if (column == kId)
      id = idIn(lines_, word);
    else if (column != kBubbleColumns)
      value[column] = numberIn(lines_, word, header_.properties[k].name);
  }
  if (nextWord(rest, word)) lines_.fail(word, "the vertex has more numbers than properties");
  store(row, id, value);
}

void PlyReader::readBinary() {
  const std::string_view data = lines_.rest();
  if (header_.vertices > data.size() / header_.stride) failShort(data.size() / header_.stride);
  resize();
  for (std::size_t row = 0; row < header_.vertices; ++row) {
    BubbleValues value{};
    for (std::size_t c = 0; c < kBubbleColumns; ++c) {
      if (property_[c] == kAbsent) continue;
      const PlyProperty& property = header_.properties[property_[c]];
      value[c] = plyValue(data.data() + row * header_.stride + property.offset, property.type);
    }
    store(row, property_[kId] == kAbsent ? row : binaryId(row, value[kId]), value);
  }
}

void PlyReader::resize() {
  table_.resize(header_.vertices);
  if (property_[kWetness] != kAbsent) table_.wetness.resize(header_.vertices);
}

void PlyReader::store(std::size_t row, std::uint64_t id, const BubbleValues& value) {
  table_.id[row] = id;
  table_.position[row] = {value[kX], value[kY], value[kZ]};
  table_.radius[row] = value[kR];
  table_.velocity[row] = {value[kVx], value[kVy], value[kVz]};
  if (!table_.wetness.empty()) table_.wetness[row] = value[kWetness];
}

std::uint64_t PlyReader::binaryId(std::size_t row, double value) const {
  std::uint64_t id = 0;
  if (isExactId(value, id)) return id;
  throw SceneError(placeOf(row, "id") + ": id " + std::to_string(value) +
                   " is not an integer from 0 to 2^53");
}

void PlyReader::failShort(std::size_t held) const {
  throw SceneError(path_ + ": is cut off: the header names " + std::to_string(header_.vertices) +
                   " vertices, the file holds at most " + std::to_string(held));
}

std::string PlyReader::placeOf(std::size_t row, std::string_view column) const {
  if (rowStart_.empty()) return path_ + ": vertex " + std::to_string(row);
  const std::size_t wanted = bubbleColumn(column);
  std::string_view rest = lines_.lineAt(rowStart_[row]), word = rest;
  for (int k = 0; k <= property_[wanted]; ++k) nextWord(rest, word);
  return lines_.placeOf(word);
}

}  // namespace

BubbleTable parseBubblePly(const std::string& path, std::string_view bytes) {
  return PlyReader(path, bytes).read();
}

}  // namespace spume::coupling
