#include "coupling/ply_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>

#include "coupling/errors.h"

namespace spume::coupling {
namespace {

struct TypeName {
  std::string_view name, alias;
  PlyType type;
  std::size_t bytes;
};

constexpr TypeName kTypes[] = {
    {"char", "int8", PlyType::int8, 1},        {"uchar", "uint8", PlyType::uint8, 1},
    {"short", "int16", PlyType::int16, 2},     {"ushort", "uint16", PlyType::uint16, 2},
    {"int", "int32", PlyType::int32, 4},       {"uint", "uint32", PlyType::uint32, 4},
    {"float", "float32", PlyType::float32, 4}, {"double", "float64", PlyType::float64, 8}};

std::vector<std::string_view> wordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::string_view word; nextWord(line, word);) words.push_back(word);
  return words;
}

/// Reads the lines between "ply" and "end_header".
class HeaderReader {
 public:
  HeaderReader(TextLines& lines, const std::string& path) : lines_(lines), path_(path) {}

  PlyHeader read() {
    std::string_view line;
    if (!lines_.next(line) || trimmed(line) != "ply")
      throw SceneError(path_ + ":1:1: is no PLY file: its first line is not 'ply'");
    while (lines_.next(line)) {
      const auto words = wordsOf(line);
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") return finish();
      readLine(line, words);
    }
    throw SceneError(path_ + ": the PLY header has no end_header");
  }

 private:
  using Words = std::vector<std::string_view>;

  void readLine(std::string_view line, const Words& words) {
    if (words[0] == "format" && words.size() == 3) return readFormat(words[1]);
    if (words[0] == "element" && words.size() == 3) return readElement(words[1], words[2]);
    if (words[0] == "property" && elements_ == 1) return readProperty(line, words);
    if (words[0] == "property" && inFaces_) return readFaceProperty(line, words);
    if (words[0] != "property") lines_.fail(words[0], quoted(line) + " is no line of a PLY header");
  }

  void readFormat(std::string_view format) {
    if (format != "ascii" && format != "binary_little_endian")
      lines_.fail(format,
                  "format " + std::string(format) + " is not read; write ascii or binary_little_endian");
    header_.format = format == "ascii" ? PlyFormat::ascii : PlyFormat::binaryLittleEndian;
    hasFormat_ = true;
  }

  void readElement(std::string_view name, std::string_view count) {
    inFaces_ = ++elements_ == 2 && name == "face";
    if (inFaces_) return readCount(count, "faces", header_.faces);
    if (elements_ > 1) return;
    if (name != "vertex")
      lines_.fail(name, "the first element is " + std::string(name) + ", expected vertex");
    readCount(count, "vertices", header_.vertices);
  }

  void readCount(std::string_view word, const std::string& what, std::size_t& count) const {
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (error != std::errc() || stop != word.data() + word.size())
      lines_.fail(word, quoted(word) + " is no number of " + what);
  }

  const TypeName* typeCalled(std::string_view word) const {
    const auto known = std::find_if(std::begin(kTypes), std::end(kTypes), [&](const TypeName& type) {
      return word == type.name || word == type.alias;
    });
    return known == std::end(kTypes) ? nullptr : known;
  }

  /// A list of indices, then scalars; faces of another kind are not read.
  void readFaceProperty(std::string_view line, const Words& words) {
    const bool isList = words.size() == 5 && words[1] == "list";
    const TypeName* first = isList              ? typeCalled(words[2])
                            : words.size() == 3 ? typeCalled(words[1])
                                                : nullptr;
    const TypeName* second = isList ? typeCalled(words[3]) : nullptr;
    if (!first || (isList && !second)) lines_.fail(words[0], quoted(line) + " is no property of a face");
    const bool isFirst = !hasFaceList_ && header_.faceTail == 0;
    if (isList != isFirst) header_.faces = 0;
    if (isList) {
      header_.faceLength = first->type;
      header_.faceIndex = second->type;
      hasFaceList_ = true;
    } else {
      header_.faceTail += first->bytes;
    }
  }

  void readProperty(std::string_view line, const Words& words) {
    const TypeName* known = words.size() == 3 ? typeCalled(words[1]) : nullptr;
    if (!known)
      lines_.fail(words[0], quoted(line) + " is no scalar property; expected e.g. property float x");
    header_.properties.push_back({std::string(words[2]), known->type, header_.stride});
    header_.stride += known->bytes;
  }

  PlyHeader finish() const {
    if (!hasFormat_) throw SceneError(path_ + ": the PLY header has no format line");
    if (!elements_) throw SceneError(path_ + ": the PLY header has no element vertex");
    return header_;
  }

  TextLines& lines_;
  const std::string& path_;
  PlyHeader header_;
  int elements_ = 0;
  bool hasFormat_ = false, inFaces_ = false, hasFaceList_ = false;
};

template <typename Value>
double littleEndian(const char* bytes) {
  std::array<char, sizeof(Value)> raw;
  std::memcpy(raw.data(), bytes, sizeof(Value));
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<Value>(raw));
}

}  // namespace

int PlyHeader::find(std::string_view name) const {
  for (std::size_t k = 0; k < properties.size(); ++k)
    if (properties[k].name == name) return static_cast<int>(k);
  return -1;
}

PlyHeader readPlyHeader(TextLines& lines, const std::string& path) {
  return HeaderReader(lines, path).read();
}

std::size_t plyBytes(PlyType type) {
  const auto known = std::find_if(std::begin(kTypes), std::end(kTypes),
                                  [type](const TypeName& name) { return name.type == type; });
  return known->bytes;
}

double plyValue(const char* bytes, PlyType type) {
  switch (type) {
    case PlyType::int8:
      return littleEndian<std::int8_t>(bytes);
    case PlyType::uint8:
      return littleEndian<std::uint8_t>(bytes);
    case PlyType::int16:
      return littleEndian<std::int16_t>(bytes);
    case PlyType::uint16:
      return littleEndian<std::uint16_t>(bytes);
    case PlyType::int32:
      return littleEndian<std::int32_t>(bytes);
    case PlyType::uint32:
      return littleEndian<std::uint32_t>(bytes);
    case PlyType::float32:
      return littleEndian<float>(bytes);
    case PlyType::float64:
      break;
  }
  return littleEndian<double>(bytes);
}

}  // namespace spume::coupling
