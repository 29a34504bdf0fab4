#include "coupling/bubble_record.h"

#include <algorithm>

#include "coupling/errors.h"

namespace spume::coupling {

std::int32_t flagsOf(const foam::BubbleStore& bubbles, std::size_t n) {
  return (bubbles.hidden[n] ? kHiddenFlag : 0) | (bubbles.clamped[n] ? kClampedFlag : 0);
}

foam::BubbleStore storeOf(std::vector<BubbleRecord> records, const std::string& path) {
  std::sort(records.begin(), records.end(),
            [](const BubbleRecord& a, const BubbleRecord& b) { return a.id < b.id; });
  foam::BubbleStore store;
  for (const BubbleRecord& record : records) {
    if (record.id < 0 || record.type < 0 || record.type > 2)
      throw SceneError(path + ": bubble id " + std::to_string(record.id) + " with type " +
                       std::to_string(record.type) + ": ids are not negative, types are 0, 1 or 2");
    if (record.flags & ~(kHiddenFlag | kClampedFlag))
      throw SceneError(path + ": bubble id " + std::to_string(record.id) + " with flags " +
                       std::to_string(record.flags) +
                       ": 1 is hidden, 2 at its radius limit, 3 both, 0 neither");
    if (store.size() && store.id.back() == static_cast<std::uint64_t>(record.id))
      throw SceneError(path + ": bubble id " + std::to_string(record.id) + " appears twice");
    foam::NewBubble bubble;
    bubble.position = Eigen::Map<const Eigen::Vector3d>(record.position);
    bubble.velocity = Eigen::Map<const Eigen::Vector3f>(record.velocity).cast<double>();
    bubble.radius = record.radius;
    bubble.type = static_cast<foam::BubbleClass>(record.type);
    store.add(bubble);
    store.id.back() = static_cast<std::uint64_t>(record.id);
    store.radius.back() = record.radius;
    store.age.back() = record.age;
    store.gas.back() = store.volume.back() = record.gas;
    store.wetness.back() = record.wetness;
    store.hidden.back() = (record.flags & kHiddenFlag) != 0;
    store.clamped.back() = (record.flags & kClampedFlag) != 0;
  }
  store.nextId = store.size() ? store.id.back() + 1 : 0;
  return store;
}

}  // namespace spume::coupling
