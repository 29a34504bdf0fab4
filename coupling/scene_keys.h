#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "coupling/scene.h"

namespace spume::coupling {

/// An enumeration in a scene: one of `names`, by index.
struct ChoiceSlot {
  std::vector<std::string> names;
  std::function<int()> get;
  std::function<void(int)> set;
};

/// Where the value of a key lives, by its type.
using Slot = std::variant<bool*, int*, std::uint64_t*, double*, std::string*, Eigen::Vector2i*,
                          Eigen::Vector3d*, Animated*, AnimatedVector*, std::array<bool, 6>*, ChoiceSlot>;

/// The closed range of a number, or of every component of a vector, with its unit.
struct KeyRange {
  double least, most;
  std::string unit;
};

/// One key: everything that reading, checking, writing and documenting it needs.
struct KeyRow {
  std::string name;
  KeyRange range;
  std::string meaning;
  bool required = false;
  std::function<Slot(Scene&, std::size_t item)> slot;
  std::function<bool(const Scene&, std::size_t item)> applies;  ///< empty: always
  std::string appliesTo;                                        ///< in words, where `applies` is set
};

/// A table of the scene file, or an array of tables.
struct KeyTable {
  std::string path;  ///< "domain", "coupling.entrainment", "inflow"
  std::string meaning;
  std::vector<KeyRow> keys;
  std::function<std::size_t(const Scene&)> count;  ///< empty: a single table
  std::function<void(Scene&, std::size_t)> resize;
  bool isArray() const { return static_cast<bool>(count); }
};

/// Every table of a scene file, in the order of writing.
const std::vector<KeyTable>& sceneTables();

}  // namespace spume::coupling
