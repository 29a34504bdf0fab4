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

/// A fault of one key of an item of a scene's array of tables; `what()` says it as one message that begins
/// with the key, but not of which item. checkItem() does.
class KeyFault : public SceneError {
 public:
  /// `key` as in the item: "radius"; `words` follow it: "= 0.001 m is too small; at least ...".
  KeyFault(std::string key, const std::string& words) : KeyFault(key, key + " ", words) {}
  /// The same where the message begins with something else, such as the line of a file that `key` names.
  KeyFault(std::string key, const std::string& head, const std::string& words)
      : SceneError(head + words), key_(std::move(key)) {}
  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

/// A fault of one item of a scene's array of tables: whoever has the file can say where that is.
class ObjectError : public SceneError {
 public:
  /// `key` as in the document: "bubble_source.0.max_radius".
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

/// Calls check(); what it throws as KeyFault, SceneError or FileError becomes an ObjectError or
/// ObjectFileError of that item, headed by its `label`. What names no key comes of the files that the key
/// `file` names.
template <typename Check>
void checkItem(const std::string& table, std::size_t item, const Check& check, const std::string& label) {
  const std::string key = table + "." + std::to_string(item) + ".", head = label + ": ";
  try {
    check();
  } catch (const KeyFault& fault) {
    throw ObjectError(key + fault.key(), head + fault.what());
  } catch (const SceneError& error) {
    throw ObjectError(key + "file", head + error.what());
  } catch (const FileError& error) {
    throw ObjectFileError(key + "file", head + error.what());
  }
}

}  // namespace spume::coupling
