#include "coupling/first_bubbles.h"

#include <algorithm>
#include <tuple>

#include "coupling/object_label.h"

namespace spume::coupling {
namespace {

/// Half of what the double of a PLY file counts exactly: the rest is for the bubbles of the run.
constexpr std::uint64_t kLargestId = std::uint64_t{1} << 52;

}  // namespace

FirstBubbles::FirstBubbles(const Scene& scene) : scene_(scene), tables_(scene.bubbles.size()) {
  for (std::size_t item = 0; item < tables_.size(); ++item) {
    const std::string& file = scene.bubbles[item].file;
    const auto read = [&] { tables_[item] = readBubbleTable(file); };
    if (!file.empty()) checkItem("bubbles", item, read, objectLabel("bubbles", "", item));
    for (std::size_t row = 0; hasIds(item) && row < sizeOf(item); ++row)
      given_.push_back({tables_[item].id[row], item, row});
  }
  std::sort(given_.begin(), given_.end(), [](const Given& a, const Given& b) {
    return std::tie(a.id, a.item, a.row) < std::tie(b.id, b.item, b.row);
  });
  checkIds();
}

std::size_t FirstBubbles::sizeOf(std::size_t item) const {
  return scene_.bubbles[item].file.empty() ? 1 : tables_[item].size();
}

bool FirstBubbles::hasIds(std::size_t item) const {
  return !scene_.bubbles[item].file.empty() && !tables_[item].isNumbered;
}

foam::NewBubble FirstBubbles::bubble(std::size_t item, std::size_t row) const {
  const BubblesSpec& spec = scene_.bubbles[item];
  if (spec.file.empty()) return spec.bubble;
  const BubbleTable& table = tables_[item];
  return {table.position[row], table.velocity[row], table.radius[row], foam::BubbleClass::liquid,
          table.wetness.empty() ? spec.bubble.wetness : table.wetness[row]};
}

/// Of a bubble of a file.
std::string FirstBubbles::placeOf(std::size_t item, std::size_t row) const {
  return tables_[item].placeOf(scene_.bubbles[item].file, row);
}

void FirstBubbles::refuse(std::size_t item, std::size_t row, const std::string& key,
                          const std::string& words) const {
  if (scene_.bubbles[item].file.empty()) throw KeyFault(key, words);
  throw KeyFault("file", placeOf(item, row) + ": " + key + " ", words);
}

/// Within a file they are checked already.
void FirstBubbles::checkIds() const {
  for (std::size_t k = 0; k < given_.size(); ++k) {
    const auto& [id, item, row] = given_[k];
    const auto check = [&, id = id, item = item, row = row] {
      if (id > kLargestId)
        refuse(item, row, "id",
               "= " + std::to_string(id) + "; a scene may give 0 to " + std::to_string(kLargestId) +
                   ", for the caches of a run to hold it exactly");
      if (k > 0 && given_[k - 1].id == id)
        refuse(item, row, "id",
               "= " + std::to_string(id) + " is already that of " +
                   placeOf(given_[k - 1].item, given_[k - 1].row) +
                   "; every bubble of a scene needs its own");
    };
    checkItem("bubbles", item, check, objectLabel("bubbles", "", item));
  }
}

void FirstBubbles::forEach(const std::function<void(const foam::NewBubble&, const Refuse&)>& visit) const {
  for (std::size_t item = 0; item < tables_.size(); ++item) {
    const auto visitAll = [&] {
      for (std::size_t row = 0; row < sizeOf(item); ++row)
        visit(bubble(item, row),
              [&](const std::string& key, const std::string& words) { refuse(item, row, key, words); });
    };
    checkItem("bubbles", item, visitAll, objectLabel("bubbles", "", item));
  }
}

foam::BubbleStore FirstBubbles::store() const {
  foam::BubbleStore bubbles;
  for (const Given& given : given_) {
    bubbles.nextId = given.id;
    bubbles.add(bubble(given.item, given.row));
  }
  for (std::size_t item = 0; item < tables_.size(); ++item)
    for (std::size_t row = 0; !hasIds(item) && row < sizeOf(item); ++row) bubbles.add(bubble(item, row));
  return bubbles;
}

void FirstBubbles::lint(FindingList& findings) const {
  for (std::size_t item = 0; item < tables_.size(); ++item) {
    const std::string key = "bubbles." + std::to_string(item) + ".file";
    if (const std::string words = wordsOnUnread(scene_.bubbles[item].file, tables_[item]); !words.empty())
      findings.warn(key, words);
    if (!tables_[item].wetness.empty() && scene_.foam.wetnessLaw != foam::WetnessLaw::perBubble)
      findings.note(key, scene_.bubbles[item].file,
                    ": wetness does nothing: foam.wetness_law is not \"per_bubble\"");
  }
}

foam::BubbleStore initialBubbles(const Scene& scene) { return FirstBubbles(scene).store(); }

}  // namespace spume::coupling
