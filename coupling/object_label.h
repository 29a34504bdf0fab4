#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "coupling/errors.h"

namespace spume::coupling {

/// What messages call an object of a scene: "inflow 'jet'", or "inflow 0" where it has no name.
inline std::string objectLabel(const std::string& table, const std::string& name, std::size_t item) {
  return name.empty() ? table + " " + std::to_string(item) : table + " '" + name + "'";
}

/// A fault of one item of a scene's array of tables: whoever has the file can say where that is.
class ObjectError : public SceneError {
 public:
  /// `key` as in the document: "bubble_source.0".
  ObjectError(std::string key, const std::string& message) : SceneError(message), key_(std::move(key)) {}
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

/// A file of such an item that cannot be read.
class ObjectFileError : public FileError {
 public:
  ObjectFileError(std::string key, const std::string& message) : FileError(message), key_(std::move(key)) {}
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

/// Calls check(); what it throws as SceneError or FileError becomes an ObjectError or ObjectFileError of that
/// item, its message headed by `label` where that is not in it yet.
template <typename Check>
void checkItem(const std::string& table, std::size_t item, const Check& check,
               const std::string& label = "") {
  const std::string key = table + "." + std::to_string(item), head = label.empty() ? "" : label + ": ";
  try {
    check();
  } catch (const SceneError& error) {
    throw ObjectError(key, head + error.what());
  } catch (const FileError& error) {
    throw ObjectFileError(key, head + error.what());
  }
}

}  // namespace spume::coupling
