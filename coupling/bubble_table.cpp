#include "coupling/bubble_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <numeric>
#include <utility>

#include "coupling/atomic_file.h"
#include "coupling/bubble_cache.h"
#include "coupling/bubble_columns.h"
#include "coupling/text_fields.h"

namespace spume::coupling {
namespace {

using PlaceOf = std::function<std::string(std::size_t row, std::string_view column)>;

constexpr const char* kAxis[] = {"x", "y", "z"};
constexpr const char* kVelocity[] = {"vx", "vy", "vz"};

/// Volumes and products of areas of longer ones overflow [m]; those of radii below its inverse vanish.
constexpr double kLargestLength = 1e50;

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

[[noreturn]] void failRadius(const BubbleTable& bubbles, std::size_t row, const std::string& what,
                             const PlaceOf& placeOf) {
  throw SceneError(placeOf(row, "r") + ": radius r = " + shown(bubbles.radius[row]) + " of bubble " +
                   std::to_string(bubbles.id[row]) + what);
}

void checkRadius(const BubbleTable& bubbles, std::size_t row, const PlaceOf& placeOf) {
  const double r = bubbles.radius[row], farthest = bubbles.position[row].cwiseAbs().maxCoeff();
  if (!std::isfinite(r) || !(r > 0)) failRadius(bubbles, row, "; it must be finite and > 0 [m]", placeOf);
  if (r < 1 / kLargestLength || r > kLargestLength)
    failRadius(bubbles, row, "; it must lie in 1e-50 to 1e50 m", placeOf);
  if (farthest * std::numeric_limits<double>::epsilon() > r)
    failRadius(bubbles, row,
               ": double precision cannot tell its centre from its surface at " + shown(farthest) +
                   " m from the origin; move the bubbles nearer",
               placeOf);
}

void checkVector(const Eigen::Vector3d& value, const char* const (&column)[3], const char* unit,
                 std::size_t row, const PlaceOf& placeOf) {
  if (value.allFinite()) return;
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(value[axis]))
      throw SceneError(placeOf(row, column[axis]) + ": " + column[axis] + " = " + shown(value[axis]) +
                       "; it must be finite [" + unit + "]");
}

void checkWetness(const BubbleTable& bubbles, std::size_t row, const PlaceOf& placeOf) {
  const double wetness = bubbles.wetness[row];
  if (!(wetness >= 0 && wetness <= 1))
    throw SceneError(placeOf(row, "wetness") + ": wetness = " + shown(wetness) + " of bubble " +
                     std::to_string(bubbles.id[row]) + "; allowed: 0 (dry) to 1 (wet) [-]");
}

/// Names the earliest row that repeats an id, and the row it repeats.
void checkIds(const BubbleTable& bubbles, const PlaceOf& placeOf) {
  const std::vector<std::uint64_t>& id = bubbles.id;
  if (std::adjacent_find(id.begin(), id.end(), std::greater_equal<>()) == id.end()) return;  // increasing
  std::vector<std::size_t> order(id.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return id[a] != id[b] ? id[a] < id[b] : a < b; });
  std::size_t first = 0, again = id.size();
  for (std::size_t k = 1; k < order.size(); ++k)
    if (id[order[k]] == id[order[k - 1]] && order[k] < again) first = order[k - 1], again = order[k];
  if (again == id.size()) return;
  throw SceneError(placeOf(again, "id") + ": id " + std::to_string(id[again]) + " is already that of " +
                   placeOf(first, "id") + "; every bubble needs its own");
}

/// A cache of a run holds float numbers and no line to point at.
BubbleTable readVdbTable(const std::string& path) {
  foam::BubbleStore bubbles = readBubblesVdb(path).bubbles;
  BubbleTable table;
  table.id = std::move(bubbles.id), table.position = std::move(bubbles.position);
  table.radius = std::move(bubbles.radius), table.velocity = std::move(bubbles.velocity);
  table.wetness = std::move(bubbles.wetness);
  checkBubbles(table, [&](std::size_t row, std::string_view) {
    return path + ": point with id " + std::to_string(table.id[row]);
  });
  return table;
}

std::string endingOf(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace

void BubbleTable::resize(std::size_t count) {
  id.resize(count);
  position.resize(count, Eigen::Vector3d::Zero());
  radius.resize(count);
  velocity.resize(count, Eigen::Vector3d::Zero());
}

std::string BubbleTable::placeOf(const std::string& path, std::size_t row) const {
  return line.empty() ? path + ": bubble " + std::to_string(id[row]) : path + ":" + std::to_string(line[row]);
}

void checkBubbles(const BubbleTable& bubbles, const PlaceOf& placeOf) {
  for (std::size_t row = 0; row < bubbles.size(); ++row) {
    checkVector(bubbles.position[row], kAxis, "m", row, placeOf);
    checkRadius(bubbles, row, placeOf);
    checkVector(bubbles.velocity[row], kVelocity, "m/s", row, placeOf);
    if (!bubbles.wetness.empty()) checkWetness(bubbles, row, placeOf);
  }
  checkIds(bubbles, placeOf);
}

std::string wordsOnUnread(const std::string& path, const BubbleTable& bubbles) {
  if (bubbles.unread.empty()) return "";
  std::string names;
  for (const std::string& name : bubbles.unread)
    names += (names.empty() ? "" : ", ") + coupling::quoted(name);
  std::string known;
  for (const std::string_view name : kBubbleColumnName) known.append(known.empty() ? "" : ", ").append(name);
  const bool one = bubbles.unread.size() == 1;
  return path + (one ? ": column " : ": columns ") + names + (one ? " is" : " are") +
         " not read; those that are: " + known;
}

BubbleTable readBubbleTable(const std::string& path) {
  const std::string ending = endingOf(path);
  if (ending == ".csv") return parseBubbleCsv(path, readFile(path));
  if (ending == ".ply") return parseBubblePly(path, readFile(path));
  if (ending == ".vdb") return readVdbTable(path);
  throw SceneError(path + ": expected a .csv, .ply or .vdb file of bubbles");
}

}  // namespace spume::coupling
