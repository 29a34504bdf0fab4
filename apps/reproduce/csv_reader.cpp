#include "apps/reproduce/csv_reader.h"

#include <algorithm>

#include "coupling/atomic_file.h"
#include "coupling/errors.h"

namespace spume::apps {

CsvReader::CsvReader(std::string path)
    : path_(std::move(path)), contents_(coupling::readFile(path_)), lines_(path_, contents_) {
  std::string_view header;
  if (lines_.next(header)) split(header);
  names_.assign(fields_.begin(), fields_.end());
}

std::size_t CsvReader::column(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) throw coupling::SceneError(path_ + ": has no column " + name);
  return static_cast<std::size_t>(found - names_.begin());
}

void CsvReader::split(std::string_view line) {
  fields_.clear();
  coupling::CommaFields fields(line);
  for (std::string_view field; fields.next(field);) fields_.push_back(field);
}

bool CsvReader::next() {
  std::string_view line;
  if (!lines_.next(line)) return false;
  split(line);
  if (fields_.size() != names_.size())
    throw coupling::SceneError(path_ + ":" + std::to_string(lines_.number()) + ": " +
                               std::to_string(fields_.size()) + " fields, expected " +
                               std::to_string(names_.size()));
  return true;
}

double CsvReader::number(std::size_t column) const {
  return coupling::numberIn(lines_, fields_[column], names_[column]);
}

}  // namespace spume::apps
