#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace spume::coupling {

/// Walks over the lines of a text held in memory, and says where in it a piece lies. Pieces are views into
/// the text.
class TextLines {
 public:
  /// `path` is for messages. `text` must outlive the object.
  TextLines(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {}

  /// Moves to the next line, without its LF or CRLF. False at the end of the text.
  bool next(std::string_view& line);
  /// Number of the line moved to last, from 1; 0 before the first.
  std::size_t number() const { return number_; }
  /// What follows the lines passed so far.
  std::string_view rest() const { return text_.substr(offset_); }
  /// The line that starts at `offset` bytes, as `next` would give it.
  std::string_view lineAt(std::size_t offset) const;
  /// Bytes before a piece of the text.
  std::size_t offsetOf(std::string_view piece) const {
    return static_cast<std::size_t>(piece.data() - text_.data());
  }

  /// "path:line:column", both from 1, columns in bytes. O(n).
  std::string placeOf(std::string_view piece) const;
  /// Throws SceneError with the place of a piece.
  [[noreturn]] void fail(std::string_view piece, const std::string& problem) const;

 private:
  std::string path_;
  std::string_view text_;
  std::size_t offset_ = 0, number_ = 0;
};

/// 'text' in quotes, for messages.
std::string quoted(std::string_view text);

/// Without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text);

/// Cuts the next word (between blanks and tabs) off `rest`. False if there is none.
bool nextWord(std::string_view& rest, std::string_view& word);

/// Cuts the next comma-separated field off `line`, trimmed. False if nothing was left; a line that ends with
/// a comma ends with an empty field.
class CommaFields {
 public:
  explicit CommaFields(std::string_view line) : rest_(line) {}
  bool next(std::string_view& field);

 private:
  std::string_view rest_;
  bool done_ = false;
};

/// The number that a whole field is; throws SceneError naming `column` if it is none or does not fit into a
/// double. "nan" and "inf" are numbers.
double numberIn(const TextLines& lines, std::string_view field, std::string_view column);

/// The id that a whole field is: an integer from 0 to 2^64 - 1, or a decimal form such as 1e3 of one up to
/// 2^53. Throws SceneError.
std::uint64_t idIn(const TextLines& lines, std::string_view field);

/// True and the integer, if `value` is one from 0 to 2^53.
bool isExactId(double value, std::uint64_t& id);

}  // namespace spume::coupling
