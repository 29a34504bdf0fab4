#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace spume::foam {

/// Where a bubble is: a label only, the forces use continuous weights (model: "Classes").
enum class BubbleClass : std::uint8_t { liquid = 0, surface = 1, air = 2 };

/// What a new bubble brings with it.
struct NewBubble {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  double radius = 0;                                   ///< [m], > 0
  BubbleClass type = BubbleClass::liquid;
  double wetness = -1;  ///< lambda of Eq. 1 where it is the bubble's own, 0 to 1; < 0: as the parameters say
};

/// All bubbles as columns of equal length, ordered by id. Ids are 64-bit, start at 0, and are never used
/// twice.
struct BubbleStore {
  std::vector<std::uint64_t> id;
  std::vector<Eigen::Vector3d> position;  ///< [m]
  std::vector<Eigen::Vector3d> velocity;  ///< [m/s]
  std::vector<double> radius;             ///< of the ball, corrected to hold the gas [m]
  std::vector<double> gas;                ///< V0, the volume the cell must have [m^3]
  std::vector<double> age;                ///< since birth [s]
  std::vector<double> exposure;           ///< integral of the bursting hazard so far [-]
  std::vector<double> volume;             ///< of the power cell at the last geometry update [m^3]
  std::vector<double> wetness;            ///< lambda of Eq. 1 [-]; < 0 until the first step asks for it
  std::vector<double> surfaceWeight;      ///< w, 0..1
  std::vector<BubbleClass> type;
  std::vector<std::uint8_t> hidden;        ///< 1: swallowed by another ball, no cell
  std::vector<std::uint8_t> clamped;       ///< 1: radius at its limit 2 r0
  std::vector<std::uint8_t> touchedSolid;  ///< 1: adhering to a solid
  std::uint64_t nextId = 0;

  std::size_t size() const { return id.size(); }
  /// Appends a bubble, radius = (3 gas / 4 pi)^(1/3), and returns its id.
  std::uint64_t add(const NewBubble& bubble);
  /// Removes the bubbles whose flag is non-zero (one flag per bubble); keeps the order of the rest.
  void remove(const std::vector<std::uint8_t>& flags);
  /// Becomes those rows of `from`, in that order; `from` is another store.
  void gather(const BubbleStore& from, const std::vector<std::int32_t>& rows);
  /// Index of `wanted`, or -1.
  std::ptrdiff_t find(std::uint64_t wanted) const;

  Eigen::Map<const Eigen::Matrix3Xd> positions() const {
    return {size() ? position.front().data() : nullptr, 3, static_cast<Eigen::Index>(size())};
  }
};

}  // namespace spume::foam
