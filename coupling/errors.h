#pragma once

#include <stdexcept>

namespace spume::coupling {

/// Wrong content of a scene or input file. `what()` is one message: file:line:column, the key or object, its
/// value, the allowed range with its unit and, for an unknown key, the nearest valid one.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that cannot be read or written. `what()` names the path and the system's reason.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace spume::coupling
