#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coupling/text_fields.h"

namespace spume::apps {

/// Walks over the rows of a statistics file of a run: a header of names, then rows of comma-separated fields.
class CsvReader {
 public:
  /// Reads the file. Throws coupling::FileError.
  explicit CsvReader(std::string path);

  /// Where a column stands. Throws coupling::SceneError, naming the file, if there is none of that name.
  std::size_t column(const std::string& name) const;
  /// Moves to the next row. False at the end. Throws coupling::SceneError, with its place, if a row has
  /// another number of fields than the header.
  bool next();
  std::string_view text(std::size_t column) const { return fields_[column]; }
  double number(std::size_t column) const;

 private:
  void split(std::string_view line);

  const std::string path_, contents_;
  coupling::TextLines lines_;
  std::vector<std::string> names_;
  std::vector<std::string_view> fields_;
};

}  // namespace spume::apps
