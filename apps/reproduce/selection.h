#pragma once

#include <string>
#include <vector>

#include "apps/reproduce/reproduction.h"

namespace spume::apps {

/// A table and the cases of it that were named one by one; none: all that are not too dear.
struct Selection {
  const Reproduction* table;
  std::vector<std::string> cases;

  /// `maxCost` [s] counts where no case was named.
  bool wants(const Study& study, double maxCost) const;
};

/// Keys of a table's cases in its order.
std::vector<std::string> keysOf(const Reproduction& table);

/// What a command line asks for. `targets`: names of tables, keys of cases, or "all"; `cases` narrows every
/// table down. Throws coupling::SceneError, with the nearest known word, if one is unknown.
std::vector<Selection> select(const std::vector<Reproduction>& tables,
                              const std::vector<std::string>& targets, const std::vector<std::string>& cases);

}  // namespace spume::apps
