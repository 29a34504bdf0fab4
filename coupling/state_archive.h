#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "coupling/simulation.h"

namespace spume::coupling {

/// Bytes that are not what was written.
class DamagedData : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

static_assert(std::endian::native == std::endian::little, "checkpoints are written as they lie in memory");

/// Appends values to a string, bit for bit.
class ArchiveWriter {
 public:
  static constexpr bool kReads = false;
  std::string bytes;

  void block(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
  std::size_t length(std::size_t n) {
    const std::uint64_t stored = n;
    block(&stored, sizeof stored);
    return n;
  }
};

/// Takes them back. Throws DamagedData where they end too soon.
class ArchiveReader {
 public:
  static constexpr bool kReads = true;
  explicit ArchiveReader(std::string_view bytes) : rest_(bytes) {}

  void block(void* data, std::size_t size) {
    if (size > rest_.size()) throw DamagedData("the data end too soon");
    std::memcpy(data, rest_.data(), size);
    rest_.remove_prefix(size);
  }
  /// A stored length; the argument is only there for the writer.
  std::size_t length(std::size_t) {
    std::uint64_t stored = 0;
    block(&stored, sizeof stored);
    if (stored > rest_.size())
      throw DamagedData("a length exceeds the data");  // an item takes a byte at least
    return stored;
  }
  bool atEnd() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

// archive(a, value) writes or reads a value. Structures are unpacked by structured bindings, so that one that
// gains a member does not compile until the member is archived too.

template <typename Archive, typename Value>
requires(std::is_arithmetic_v<Value> || std::is_enum_v<Value>) void archive(Archive& a, Value& value) {
  a.block(&value, sizeof value);
}

template <typename Archive, typename Scalar, int rows>
void archive(Archive& a, Eigen::Matrix<Scalar, rows, 1>& value) {
  a.block(value.data(), sizeof(Scalar) * rows);
}

template <typename Archive>
void archive(Archive& a, std::string& text) {
  text.resize(a.length(text.size()));
  a.block(text.data(), text.size());
}

template <typename Archive, typename Value, typename Allocator>
void archive(Archive& a, std::vector<Value, Allocator>& values) {
  values.resize(a.length(values.size()));
  if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
    a.block(values.data(), values.size() * sizeof(Value));
  } else {
    for (Value& value : values) archive(a, value);
  }
}

template <typename Archive, typename Value>
void archive(Archive& a, fluid::DenseField<Value>& field) {
  Eigen::Vector3i size = field.size();
  archive(a, size);
  if constexpr (Archive::kReads) {
    constexpr int kLargest = 1 << 14;
    if ((size.array() < 0).any() || (size.array() > kLargest).any())
      throw DamagedData("a field has an absurd size");
    field = size.isZero() ? fluid::DenseField<Value>() : fluid::DenseField<Value>(size);
  }
  a.block(field.data(), field.count() * sizeof(Value));
}

template <typename Archive, typename Value>
void archive(Archive& a, fluid::MacField<Value>& field) {
  for (auto& axis : field.axis) archive(a, axis);
}

template <typename Archive>
void archive(Archive& a, Reservoirs& reservoirs) {
  const std::size_t count = a.length(reservoirs.size());
  const auto entry = [&a](BlockIndex& block, Reservoir& reservoir) {
    auto& [gas, draws] = reservoir;
    for (int& index : block) archive(a, index);
    archiveAll(a, gas, draws);
  };
  if constexpr (Archive::kReads) {
    reservoirs.clear();
    for (std::size_t n = 0; n < count; ++n) {
      BlockIndex block;
      Reservoir reservoir;
      entry(block, reservoir);
      reservoirs.emplace_hint(reservoirs.end(), block, reservoir);
    }
  } else {
    for (auto& [key, reservoir] : reservoirs) {
      BlockIndex block = key;
      entry(block, reservoir);
    }
  }
}

template <typename Archive, typename... Values>
void archiveAll(Archive& a, Values&... values) {
  (archive(a, values), ...);
}

template <typename Archive>
void archive(Archive& a, fluid::MarkerSet& markers) {
  markers.forEachColumn([&a](auto& column) { archive(a, column); });
}

template <typename Archive>
void archive(Archive& a, fluid::Drop& drop) {
  auto& [position, velocity, volume, id] = drop;
  archiveAll(a, position, velocity, volume, id);
}

template <typename Archive>
void archive(Archive& a, fluid::LiquidState& liquid) {
  auto& [grid, time, subSteps, phi, velocity, lead, pressureGradient, positive, negative, volume, drops,
         dropsEver] = liquid;
  auto& [cells, dx, origin] = grid;
  auto& [target, loss, unassigned, pocketGas] = volume;
  archiveAll(a, cells, dx, origin, time, subSteps, phi, velocity, lead, pressureGradient, positive, negative,
             target, loss, unassigned, pocketGas, drops, dropsEver);
}

template <typename Archive>
void archive(Archive& a, foam::BubbleStore& bubbles) {
  auto& [id, position, velocity, radius, gas, age, exposure, volume, wetness, surfaceWeight, type, hidden,
         clamped, touchedSolid, nextId] = bubbles;
  archiveAll(a, id, position, velocity, radius, gas, age, exposure, volume, wetness, surfaceWeight, type,
             hidden, clamped, touchedSolid, nextId);
}

template <typename Archive>
void archive(Archive& a, GasLedger& gas) {
  auto& [bornMarkers, bornPockets, bornSources, bornNucleation, grown, burst, killed, left, notEntrained,
         unplaced, inBubbles, inReservoirs] = gas;
  archiveAll(a, bornMarkers, bornPockets, bornSources, bornNucleation, grown, burst, killed, left,
             notEntrained, unplaced, inBubbles, inReservoirs);
}

template <typename Archive>
void archive(Archive& a, SourceProgress& progress) {
  auto& [births, gas, unplaced] = progress;
  archiveAll(a, births, gas, unplaced);
}

template <typename Archive>
void archive(Archive& a, foam::NucleationSite& site) {
  auto& [position, away, bubble, ready, births, params] = site;
  archiveAll(a, position, away, bubble, ready, births, params);
}

template <typename Archive>
void archive(Archive& a, SupplyState& supply) {
  auto& [sources, sites, dissolved] = supply;
  archiveAll(a, sources, sites, dissolved);
}

template <typename Archive>
void archive(Archive& a, fluid::Push& push) {
  auto& [position, impulse, resistance] = push;
  archiveAll(a, position, impulse, resistance);
}

template <typename Archive>
void archive(Archive& a, SimulationState& state) {
  auto& [frame, step, time, liquid, bubbles, reservoirs, supply, pushes, gas, initialVolume, poured, drained,
         foamDt] = state;
  archiveAll(a, frame, step, time, liquid, bubbles, reservoirs, supply, pushes, gas, initialVolume, poured,
             drained, foamDt);
}

}  // namespace spume::coupling
