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

/// Calls check(); what it throws as SceneError becomes an ObjectError of that item.
template <typename Check>
void checkItem(const std::string& table, std::size_t item, const Check& check) {
  try {
    check();
  } catch (const SceneError& error) {
    throw ObjectError(table + "." + std::to_string(item), error.what());
  }
}

}  // namespace spume::coupling
