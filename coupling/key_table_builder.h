#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "coupling/scene_keys.h"

namespace spume::coupling {

/// Collects the keys of one table. `Object` is what the table fills: a part of the scene, or an item of one
/// of its lists. A `place` is a member pointer of Object, or a function from Object& to the value.
template <typename Object>
class KeyTableBuilder {
 public:
  using Find = std::function<Object&(Scene&, std::size_t item)>;

  KeyTableBuilder(std::string path, std::string meaning, Find find) : find_(std::move(find)) {
    table_.path = std::move(path);
    table_.meaning = std::move(meaning);
  }

  /// A key whose type has no range: string, truth value, walls.
  template <typename Place>
  KeyTableBuilder& key(std::string name, Place place, std::string meaning) {
    return key(std::move(name), place, {0, 0, ""}, std::move(meaning));
  }
  /// A number or a vector of them.
  template <typename Place>
  KeyTableBuilder& key(std::string name, Place place, KeyRange range, std::string meaning) {
    const Find find = find_;
    auto slot = [find, place](Scene& scene, std::size_t item) -> Slot {
      return &std::invoke(place, find(scene, item));
    };
    return add(std::move(name), std::move(range), std::move(meaning), slot);
  }
  /// An enumeration whose values, from 0, are called `names`.
  template <typename Place>
  KeyTableBuilder& choice(std::string name, Place place, std::vector<std::string> names,
                          std::string meaning) {
    const Find find = find_;
    auto slot = [find, place, names](Scene& scene, std::size_t item) -> Slot {
      auto& value = std::invoke(place, find(scene, item));
      using Enum = std::remove_reference_t<decltype(value)>;
      return ChoiceSlot{names, [&value] { return static_cast<int>(value); },
                        [&value](int index) { value = static_cast<Enum>(index); }};
    };
    return add(std::move(name), {0, 0, ""}, std::move(meaning), slot);
  }
  /// The last key must be given.
  KeyTableBuilder& required() {
    table_.keys.back().required = true;
    return *this;
  }
  /// The last key only has a meaning where `applies`; `words` say where that is.
  KeyTableBuilder& onlyIf(std::function<bool(const Object&)> applies, std::string words) {
    KeyRow& row = table_.keys.back();
    const Find find = find_;
    row.applies = [find, applies](const Scene& scene, std::size_t item) {
      return applies(find(const_cast<Scene&>(scene), item));  // `find` only looks up
    };
    row.appliesTo = std::move(words);
    return *this;
  }
  /// The last key only has a meaning in some scenes.
  KeyTableBuilder& onlyWhere(std::function<bool(const Scene&)> applies, std::string words) {
    KeyRow& row = table_.keys.back();
    row.applies = [applies](const Scene& scene, std::size_t) { return applies(scene); };
    row.appliesTo = std::move(words);
    return *this;
  }
  /// The table is an array, kept in `list`.
  template <typename Item>
  KeyTableBuilder& listed(std::vector<Item> Scene::*list) {
    table_.count = [list](const Scene& scene) { return (scene.*list).size(); };
    table_.resize = [list](Scene& scene, std::size_t size) { (scene.*list).resize(size); };
    return *this;
  }

  KeyTable build() { return std::move(table_); }

 private:
  KeyTableBuilder& add(std::string name, KeyRange range, std::string meaning,
                       std::function<Slot(Scene&, std::size_t)> slot) {
    KeyRow row;
    row.name = std::move(name);
    row.range = std::move(range);
    row.meaning = std::move(meaning);
    row.slot = std::move(slot);
    table_.keys.push_back(std::move(row));
    return *this;
  }

  Find find_;
  KeyTable table_;
};

/// A table that fills one part of the scene.
template <typename Part>
KeyTableBuilder<Part> partTable(std::string path, std::string meaning, Part Scene::*part) {
  return {std::move(path), std::move(meaning),
          [part](Scene& scene, std::size_t) -> Part& { return scene.*part; }};
}

/// An array of tables, kept in a list of the scene.
template <typename Item>
KeyTableBuilder<Item> listTable(std::string path, std::string meaning, std::vector<Item> Scene::*list) {
  KeyTableBuilder<Item> table(
      std::move(path), std::move(meaning),
      [list](Scene& scene, std::size_t item) -> Item& { return (scene.*list)[item]; });
  table.listed(list);
  return table;
}

}  // namespace spume::coupling
