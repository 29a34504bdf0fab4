#pragma once

#include <toml++/toml.h>

#include <map>
#include <string>

#include "coupling/scene_toml.h"

namespace spume::coupling {

/// A parsed scene file with the overrides put in, and where each of its values was written.
class SceneDocument {
 public:
  /// Throws FileError (cannot be read) or SceneError (syntax, an override that cannot be placed).
  SceneDocument(const std::string& path, const Overrides& overrides);

  const toml::table& root() const { return root_; }
  /// "file:line:column", or what Override::text() says where an override put the value of `key`.
  std::string place(const std::string& key, const toml::source_region& source) const;
  /// Place of a dotted key, as near as the file says it: the value, else its table, else the file.
  std::string place(const std::string& key) const;

 private:
  void apply(const Override& given);

  std::string path_;
  toml::table root_;
  std::map<std::string, std::string> overrides_;  ///< dotted key -> what the command line said
};

}  // namespace spume::coupling
