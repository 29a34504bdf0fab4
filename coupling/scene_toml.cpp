#include "coupling/scene_toml.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "coupling/nearest_key.h"
#include "coupling/object_label.h"
#include "coupling/scene_builder.h"
#include "coupling/scene_document.h"
#include "coupling/scene_keys.h"
#include "coupling/scene_relations.h"
#include "coupling/toml_slot.h"
#include "foam/presets.h"

namespace spume::coupling {
namespace {

std::string dotted(const std::string& table, const std::string& key) {
  return table.empty() ? key : table + "." + key;
}

/// What to write instead of an unknown key: the nearest one, where it is near enough to be meant.
std::string suggestion(const std::string& key, const std::vector<std::string>& valid) {
  const std::string nearest = nearestOf(key, valid);
  const std::string name = key.substr(key.rfind('.') + 1);
  const bool isNear = 2 * editDistance(key, nearest) <= static_cast<int>(name.size());
  return "the nearest valid one is " + nearest + (isNear ? "" : "; `spume check --keys` explains all");
}

/// Fills a scene from a document by the table of keys.
class SceneReader {
 public:
  explicit SceneReader(const SceneDocument& document) : document_(document) {
    scene_.foam = foam::makePreset(scene_.preset);
  }

  Scene read() {
    rejectUnknown(document_.root(), "", "");
    for (const KeyTable& table : sceneTables()) {
      const toml::node* node = document_.root().at_path(table.path).node();
      table.isArray() ? readArray(table, node)
                      : readItem(table, table.path, 0, node ? node->as_table() : nullptr);
    }
    return std::move(scene_);
  }

 private:
  [[noreturn]] void fail(const std::string& key, const toml::node& node, const std::string& message) const {
    throw SceneError(document_.place(key, node.source()) + ": " + key + " " + message);
  }

  static const KeyTable* findTable(const std::string& path) {
    const auto& tables = sceneTables();
    const auto found =
        std::find_if(tables.begin(), tables.end(), [&](const auto& t) { return t.path == path; });
    return found == tables.end() ? nullptr : &*found;
  }
  static bool isKey(const KeyTable* table, const std::string& name) {
    const auto named = [&](const KeyRow& row) { return row.name == name; };
    return table && std::any_of(table->keys.begin(), table->keys.end(), named);
  }

  /// `path` is the table's in the table of keys, `here` the same with the numbers of array items in it.
  void rejectUnknown(const toml::table& table, const std::string& path, const std::string& here) const {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      const KeyTable* child = findTable(dotted(path, name));
      if (child) {
        rejectUnknownIn(*child, node, dotted(here, name));
      } else if (!isKey(findTable(path), name)) {
        rejectKey(path, dotted(here, name), name, key.source());
      }
    }
  }
  void rejectUnknownIn(const KeyTable& child, const toml::node& node, const std::string& here) const {
    if (!child.isArray()) {
      if (!node.is_table()) fail(here, node, "is not a table; write [" + child.path + "]");
      return rejectUnknown(*node.as_table(), child.path, here);
    }
    const toml::array* items = node.as_array();
    if (!items || (!items->empty() && !node.is_array_of_tables()))
      fail(here, node, "is not an array of tables; write [[" + child.path + "]]");
    for (std::size_t i = 0; i < items->size(); ++i)
      rejectUnknown(*items->get(i)->as_table(), child.path, here + "." + std::to_string(i));
  }
  [[noreturn]] void rejectKey(const std::string& path, const std::string& key, const std::string& name,
                              const toml::source_region& source) const {
    std::vector<std::string> valid;
    for (const KeyTable& table : sceneTables()) {
      valid.push_back(table.path);
      for (const KeyRow& row : table.keys) valid.push_back(dotted(table.path, row.name));
    }
    throw SceneError(document_.place(key, source) + ": unknown key " + key + "; " +
                     suggestion(dotted(path, name), valid));
  }

  void readArray(const KeyTable& table, const toml::node* node) {
    const toml::array* items = node ? node->as_array() : nullptr;
    table.resize(scene_, items ? items->size() : 0);
    for (std::size_t i = 0; items && i < items->size(); ++i)
      readItem(table, table.path + "." + std::to_string(i), i, items->get(i)->as_table());
  }
  /// `values` is null where the file leaves the table out.
  void readItem(const KeyTable& table, const std::string& here, std::size_t item, const toml::table* values) {
    for (const KeyRow& row : table.keys) {
      const toml::node* node = values ? values->get(row.name) : nullptr;
      const std::string key = dotted(here, row.name);
      if (node) {
        readKey(row, key, item, *node);
      } else if (row.required && (!row.applies || row.applies(scene_, item))) {
        throw SceneError(document_.place(key) + ": " + key + " is missing; it has no default; expected " +
                         typeName(row.slot(scene_, item)) + ", " +
                         rangeText(row.slot(scene_, item), row.range));
      }
    }
  }
  void readKey(const KeyRow& row, const std::string& key, std::size_t item, const toml::node& node) {
    if (row.applies && !row.applies(scene_, item))
      fail(key, node, "does not apply here; it is a key of: " + row.appliesTo);
    try {
      assign(row.slot(scene_, item), row.range, node);
    } catch (const BadValue& error) {
      fail(key, node, error.what());
    }
  }

  const SceneDocument& document_;
  Scene scene_;
};

void fillWetness(const Scene& scene, double& wetness) {
  if (wetness < 0) wetness = scene.foam.wetness;
}

/// What several modules need is one key in the file.
void shareCommonValues(Scene& scene) {
  scene.liquid.seed = scene.foam.seed = scene.seed;
  scene.foam.gravity = scene.liquid.gravity;
  scene.foam.density = scene.liquid.density;
  scene.dissolvedGas.surfaceTension = scene.foam.surfaceTension;
  for (BubblesSpec& bubbles : scene.bubbles) fillWetness(scene, bubbles.bubble.wetness);
  for (BubbleSourceSpec& source : scene.bubbleSources) fillWetness(scene, source.wetness);
}

/// Files of a scene lie beside it; where the resolved scene is copied to, they must be found too.
void findFiles(Scene& scene, const std::string& scenePath) {
  namespace fs = std::filesystem;
  const auto place = [&](std::string& file) {
    if (!file.empty())
      file = fs::absolute(fs::path(scenePath).parent_path() / file).lexically_normal().string();
  };
  for (SolidSpec& solid : scene.solids) place(solid.shape.file);
  for (BubblesSpec& bubbles : scene.bubbles) place(bubbles.file);
  place(scene.liquidCache.run);
}

void checkTogether(const Scene& scene, const SceneDocument& document, const std::string& path) {
  if (const auto conflict = findConflict(scene))
    throw SceneError(document.place(conflict->key) + ": " + conflict->key + " " + conflict->message);
  try {
    checkObjects(scene);
  } catch (const ObjectError& error) {
    throw SceneError(document.place(error.key()) + ": " + error.what());
  } catch (const ObjectFileError& error) {
    throw FileError(document.place(error.key()) + ": " + error.what());
  } catch (const SceneError& error) {
    throw SceneError(path + ": " + error.what());
  }
}

/// A file's name as the name of a scene: what is no letter, digit, _ or - becomes _.
std::string fileSafe(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  return name;
}

Scene presetScene(foam::Preset preset) {
  Scene scene;
  scene.preset = preset;
  scene.foam = foam::makePreset(preset);
  return scene;
}

/// "[domain]" or "[[inflow]]".
std::string header(const KeyTable& table) {
  std::string text = table.isArray() ? "[[" : "[";
  text += table.path;
  return text += table.isArray() ? "]]" : "]";
}

std::string writeItem(const KeyTable& table, Scene& scene, std::size_t item) {
  std::string text = header(table) + "\n";
  for (const KeyRow& row : table.keys) {
    if (row.applies && !row.applies(scene, item)) continue;
    text += row.name + " = " + toToml(row.slot(scene, item));
    text += (row.range.unit.empty() || row.range.unit == "-" ? "" : "   # " + row.range.unit) + "\n";
  }
  return text;
}

/// `paper` holds the defaults of that preset, to be named where they are others.
std::string describeRow(const KeyRow& row, Scene& defaults, Scene& paper) {
  const Slot slot = row.slot(defaults, 0);
  const std::string range = rangeText(slot, row.range);
  std::string text = "  " + row.name + ": " + typeName(slot) + (range.empty() ? "" : ", " + range);
  text += row.required ? ", required" : ", default " + toToml(slot);
  if (const std::string other = toToml(row.slot(paper, 0)); row.name != "preset" && other != toToml(slot))
    text += " (preset paper: " + other + ")";
  if (!row.appliesTo.empty()) text += ", for " + row.appliesTo;
  return text + "\n      " + row.meaning + "\n";
}

}  // namespace

Scene readScene(const std::string& path, const Overrides& overrides) {
  const SceneDocument document(path, overrides);
  Scene scene = SceneReader(document).read();
  if (!document.root().at_path("scene.name"))
    scene.name = fileSafe(std::filesystem::path(path).stem().string());
  shareCommonValues(scene);
  findFiles(scene, path);
  checkTogether(scene, document, path);
  return scene;
}

std::string writeScene(const Scene& scene) {
  Scene copy = scene;  // slots are writable, so the scene must be
  std::string text;
  for (const KeyTable& table : sceneTables())
    for (std::size_t item = 0; item < (table.isArray() ? table.count(copy) : 1); ++item)
      text.append(text.empty() ? "" : "\n").append(writeItem(table, copy, item));
  return text;
}

std::string describeSceneKeys() {
  Scene defaults = presetScene(foam::Preset::physical), paper = presetScene(foam::Preset::paper);
  std::string text;
  for (const KeyTable& table : sceneTables()) {
    if (table.isArray()) table.resize(defaults, 1), table.resize(paper, 1);
    text.append(text.empty() ? "" : "\n")
        .append(header(table))
        .append("  ")
        .append(table.meaning)
        .append("\n");
    for (const KeyRow& row : table.keys) text += describeRow(row, defaults, paper);
  }
  return text;
}

}  // namespace spume::coupling
