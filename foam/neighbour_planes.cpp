#include "foam/neighbour_planes.h"

#include <bit>

namespace spume::foam {

namespace {

/// As radicalHeight, in lanes.
Lanes heightOf(const Lanes& radius, const Lanes& other, const Lanes& distance, const Lanes& inverse) {
  return (distance + (radius - other) * ((radius + other) * inverse)) / 2;
}

}  // namespace

void NeighbourPlanes::reserve(std::size_t count) {
  const std::size_t room = paddedToLanes(count) + kLanes;  // closing gaps writes whole blocks
  planes.resize(room);
  if (radius.size() >= room) return;
  for (auto* column : {&from_.x, &from_.y, &from_.z, &from_.radius, &from_.weightShift, &from_.visible,
                       &distance, &radius, &farHeight})
    column->resize(room);
  for (auto* column : {&from_.index, &from_.link, &index, &link, &planeOf}) column->resize(room);
}

void NeighbourPlanes::gather(const RawBuffer<RankedBall>& balls, const Candidates& candidates) {
  for (std::size_t k = 0; k < candidates.count; ++k) {
    const RankedBall& other = balls[candidates.rank[k]];
    from_.x[k] = other.x, from_.y[k] = other.y, from_.z[k] = other.z;
    from_.radius[k] = other.ball.radius, from_.weightShift[k] = other.ball.weightShift;
    from_.visible[k] = other.visible, from_.index[k] = other.index;
  }
}

void NeighbourPlanes::find(const RawBuffer<RankedBall>& balls, std::int32_t s, const Candidates& candidates) {
  reserve(candidates.count);
  gather(balls, candidates);
  const RankedBall& own = balls[s];
  overlaps = lower = planes.count = 0, centreInside = true;
  for (std::size_t k = 0; k < candidates.count; k += kLanes) {
    Block to{loadLanes(&from_.x[k]) - own.x,
             loadLanes(&from_.y[k]) - own.y,
             loadLanes(&from_.z[k]) - own.z,
             {},
             loadLanes(&from_.radius[k])};
    to.distance = squareRoot(to.x * to.x + to.y * to.y + to.z * to.z);
    touching_ = bitsOf(to.distance < own.ball.radius + to.radius) & lanesBelow(candidates.count - k);
    const std::uint32_t cutting = own.visible > 0 ? touching_ & bitsOf(loadLanes(&from_.visible[k]) > 0) : 0;
    for (std::uint32_t left = touching_, plane = planes.count, place = overlaps; left != 0; left &= left - 1)
      planeOf[place++] = cutting >> std::countr_zero(left) & 1 ? static_cast<std::int32_t>(plane++) : -1;
    addOverlaps(k, to, own.ball.radius, candidates);
    addPlanes(k, to, own.ball, cutting);
  }
}

void NeighbourPlanes::addOverlaps(std::size_t k, const Block& to, double ownRadius,
                                  const Candidates& candidates) {
  const std::uint32_t below = k < candidates.lower ? lanesBelow(candidates.lower - k) : 0;
  const std::uint32_t bubbles = k < candidates.bubbles ? lanesBelow(candidates.bubbles - k) : 0;
  const std::uint32_t owned =
      bitsOf(ownRadius < to.radius) | (bitsOf(ownRadius == to.radius) & ~below) | ~bubbles;
  for (std::size_t l = 0; l < kLanes; ++l)
    from_.link[k + l] = 2 * candidates.pair[k + l] + static_cast<std::int32_t>(owned >> l & 1);
  storeSelected(touching_, &from_.index[k], &index[overlaps]);
  storeSelected(touching_, &from_.link[k], &link[overlaps]);
  lower += static_cast<std::size_t>(std::popcount(touching_ & below));
  overlaps += storeSelected(touching_, to.distance, &distance[overlaps]);
}

void NeighbourPlanes::addPlanes(std::size_t k, const Block& to, const TieBrokenBall& own,
                                std::uint32_t cutting) {
  const std::size_t end = planes.count;
  const Lanes ownRadius = Lanes{} + own.radius, inverse = 1 / to.distance;
  const Lanes height = heightOf(ownRadius, to.radius, to.distance, inverse);
  const Lanes shift = (own.weightShift - loadLanes(&from_.weightShift[k])) * inverse / 2;
  const Lanes size = shift < 0 ? -shift : shift, smaller = ownRadius < to.radius ? ownRadius : to.radius;
  storeSelected(cutting, to.x * inverse, &planes.nx[end]);
  storeSelected(cutting, to.y * inverse, &planes.ny[end]);
  storeSelected(cutting, to.z * inverse, &planes.nz[end]);
  storeSelected(cutting, height, &planes.height[end]);
  storeSelected(cutting, size < kMaxRelativeShift * smaller ? shift : Lanes{}, &planes.heightShift[end]);
  storeSelected(cutting, to.radius, &radius[end]);
  planes.count +=
      storeSelected(cutting, heightOf(to.radius, ownRadius, to.distance, inverse), &farHeight[end]);
  centreInside = centreInside && (bitsOf(height < 0) & cutting) == 0;
}

}  // namespace spume::foam
