#include "apps/reproduce/selection.h"

#include <algorithm>

#include "coupling/errors.h"
#include "coupling/nearest_key.h"

namespace spume::apps {
namespace {

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void requireKnown(const std::vector<std::string>& words, const std::vector<std::string>& known,
                  const std::string& what) {
  for (const std::string& word : words) {
    if (contains(known, word)) continue;
    std::string all;
    for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
    throw coupling::SceneError("unknown " + what + " " + word + ": did you mean " +
                               coupling::nearestOf(word, known) + "? These are: " + all);
  }
}

}  // namespace

bool Selection::wants(const Study& study, double maxCost) const {
  return cases.empty() ? study.cost <= maxCost : contains(cases, study.key);
}

std::vector<std::string> keysOf(const Reproduction& table) {
  std::vector<std::string> keys;
  for (const Study& study : table.studies) keys.push_back(study.key);
  return keys;
}

std::vector<Selection> select(const std::vector<Reproduction>& tables,
                              const std::vector<std::string>& targets,
                              const std::vector<std::string>& cases) {
  std::vector<Selection> selections;
  std::vector<std::string> names, keys;
  for (const Reproduction& table : tables) {
    const std::vector<std::string> own = keysOf(table);
    const bool whole = contains(targets, "all") || contains(targets, table.name);
    std::vector<std::string> named;
    for (const std::string& key : own)
      if (!whole && contains(targets, key)) named.push_back(key);
    names.push_back(table.name);
    names.insert(names.end(), own.begin(), own.end());
    if (!whole && named.empty()) continue;
    keys.insert(keys.end(), own.begin(), own.end());
    named.insert(named.end(), cases.begin(), cases.end());
    selections.push_back({&table, std::move(named)});
  }
  names.push_back("all");
  requireKnown(targets, names, "table");
  if (!cases.empty()) requireKnown(cases, keys, "case");
  return selections;
}

}  // namespace spume::apps
