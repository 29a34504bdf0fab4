#pragma once

#include <string>
#include <vector>

#include "coupling/scene_toml.h"

namespace spume::apps {

/// A key of the scene and the values a sweep gives it one after the other.
struct Variation {
  std::string text;                 ///< as typed, "liquid.cfl=1,2,4"; for messages
  std::string key;                  ///< "liquid.cfl"
  std::vector<std::string> values;  ///< as --set takes them
};

/// Parses "table.key=value,value,...". Commas inside brackets, braces and quotes belong to a value. Throws
/// coupling::SceneError, naming the argument, if it has another form or gives a value twice.
Variation parseVariation(const std::string& text);

/// Every combination of the values, the last key changing fastest; one empty entry if there are no
/// variations. Throws coupling::SceneError where a key is varied twice or the combinations are more than
/// kMostVariants.
std::vector<coupling::Overrides> combinations(const std::vector<Variation>& variations);

/// More folders than this in one sweep are a slip of the keyboard, and more than job arrays take.
inline constexpr std::size_t kMostVariants = 10000;

/// Readable, unique names of folders, "liquid.cfl=2__foam.wetness=0.4": letters, digits and -_.+= alone, at
/// most kLongestName characters. Where two would be the same, or one is too long, a number closes it.
std::vector<std::string> folderNames(const std::vector<coupling::Overrides>& variants);

/// Leaves room for what is added within the 255 bytes file systems allow.
inline constexpr std::size_t kLongestName = 200;

}  // namespace spume::apps
