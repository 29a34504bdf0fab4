#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coupling/bubble_table.h"
#include "coupling/finding_list.h"
#include "coupling/scene.h"
#include "foam/bubble_store.h"

namespace spume::coupling {

/// The bubbles a scene starts with, one of each [[bubbles]] or those of its file, and where each is written.
class FirstBubbles {
 public:
  /// Reads the files. Throws FileError or SceneError as readBubbleTable does, and SceneError, with both
  /// places, if two files give the same id, or an id is larger than the caches of a run can hold. `scene`
  /// must outlive the object.
  explicit FirstBubbles(const Scene& scene);

  /// Calls visit(bubble, refuse) for each in the order of the scene. refuse(key, words) throws a fault of the
  /// bubble's "position", "velocity" or "radius", at that key or at its line of a file.
  using Refuse = std::function<void(const std::string& key, const std::string& words)>;
  void forEach(const std::function<void(const foam::NewBubble&, const Refuse&)>& visit) const;

  /// Ordered by id: bubbles of files keep the ids given there; all others are numbered in the order of the
  /// scene, on from the largest given one, or from 0.
  foam::BubbleStore store() const;

  /// Columns that are not read, and wetness that does not count.
  void lint(FindingList& findings) const;

 private:
  std::size_t sizeOf(std::size_t item) const;
  bool hasIds(std::size_t item) const;
  foam::NewBubble bubble(std::size_t item, std::size_t row) const;
  std::string placeOf(std::size_t item, std::size_t row) const;
  [[noreturn]] void refuse(std::size_t item, std::size_t row, const std::string& key,
                           const std::string& words) const;
  void checkIds() const;

  /// A bubble whose file gives its id.
  struct Given {
    std::uint64_t id;
    std::size_t item, row;
  };
  const Scene& scene_;
  std::vector<BubbleTable> tables_;  ///< by item of [[bubbles]]; empty where it has no file
  std::vector<Given> given_;         ///< ordered by id
};

/// FirstBubbles(scene).store().
foam::BubbleStore initialBubbles(const Scene& scene);

}  // namespace spume::coupling
