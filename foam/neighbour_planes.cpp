#include "foam/neighbour_planes.h"

namespace spume::foam {

namespace {

/// As radicalHeight, in lanes.
Lanes heightOf(const Lanes& radius, const Lanes& other, const Lanes& distance) {
  return (distance + (radius - other) * ((radius + other) / distance)) / 2;
}

}  // namespace

TieBrokenBall RankedBalls::ball(std::int32_t s) const {
  TieBrokenBall ball;
  ball.radius = place[s].radius, ball.radiusShift = radiusShift[s], ball.weightShift = weightShift[s];
  return ball;
}

void NeighbourDistances::measure(const RankedBalls& balls, std::int32_t s, const std::int32_t* others,
                                 std::size_t howMany) {
  count = howMany;
  if (const std::size_t padded = paddedToLanes(count); x.size() < padded)
    for (auto* column : {&x, &y, &z, &radius, &distance}) column->resize(padded);
  for (std::size_t k = 0; k < count; ++k) {
    const RankedBalls::Place& other = balls.place[others[k]];
    x[k] = other.x, y[k] = other.y, z[k] = other.z, radius[k] = other.radius;
  }
  const RankedBalls::Place& from = balls.place[s];
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Lanes dx = loadLanes(&x[k]) - from.x, dy = loadLanes(&y[k]) - from.y,
                dz = loadLanes(&z[k]) - from.z;
    storeLanes(&x[k], dx), storeLanes(&y[k], dy), storeLanes(&z[k], dz);
    storeLanes(&distance[k], squareRoot(dx * dx + dy * dy + dz * dz));
  }
}

void NeighbourPlanes::find(const RankedBalls& balls, std::int32_t s, const std::int32_t* others,
                           std::size_t count) {
  to.measure(balls, s, others, count);
  planes.resize(count);
  if (const std::size_t padded = paddedToLanes(count); farHeight.size() < padded)
    farHeight.resize(padded), weightShift.resize(padded);
  for (std::size_t k = 0; k < count; ++k) weightShift[k] = balls.weightShift[others[k]];
  const Lanes radius = Lanes{} + balls.place[s].radius;
  for (std::size_t k = 0; k < count; k += kLanes) {
    const Lanes d = loadLanes(&to.distance[k]), other = loadLanes(&to.radius[k]), inverse = 1 / d;
    storeLanes(&planes.nx[k], loadLanes(&to.x[k]) * inverse);
    storeLanes(&planes.ny[k], loadLanes(&to.y[k]) * inverse);
    storeLanes(&planes.nz[k], loadLanes(&to.z[k]) * inverse);
    storeLanes(&planes.height[k], heightOf(radius, other, d)),
        storeLanes(&farHeight[k], heightOf(other, radius, d));
    const Lanes shift = (balls.weightShift[s] - loadLanes(&weightShift[k])) / (2 * d);
    const Lanes size = shift < 0 ? -shift : shift, smaller = radius < other ? radius : other;
    storeLanes(&planes.heightShift[k], size < kMaxRelativeShift * smaller ? shift : Lanes{});
  }
}

}  // namespace spume::foam
