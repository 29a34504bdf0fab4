#include "fluid/paths.h"

#include <algorithm>
#include <cmath>

#include "fluid/parallel.h"

namespace spume::fluid {
namespace {

void placeRun(float x, float y, float z, PathPoints& points) {
  for (int n = 0; n < kPathChunk; ++n) {
    points.x[n] = x;
    points.y[n] = y;
    points.z[n] = z + static_cast<float>(n);
  }
}

/// Mean of the values at p and p + step.
void meanOfTwo(const float* __restrict p, std::ptrdiff_t step, float* __restrict mean) {
  for (int n = 0; n < kPathChunk; ++n) mean[n] = 0.5f * (p[n] + p[n + step]);
}

/// Mean of the values at p, p - back, p + ahead and p - back + ahead.
void meanOfFour(const float* __restrict p, std::ptrdiff_t back, std::ptrdiff_t ahead,
                float* __restrict mean) {
  for (int n = 0; n < kPathChunk; ++n)
    mean[n] = 0.25f * (p[n] + p[n - back] + p[n + ahead] + p[n - back + ahead]);
}

void copyRun(const float* __restrict p, float* __restrict out) {
  for (int n = 0; n < kPathChunk; ++n) out[n] = p[n];
}

/// Largest magnitude in one slab of a component. Runs past the end of a row see ghosts, copies of inner
/// values.
float largestInSlab(const DenseField<float>& component, int i) {
  float lane[kPathChunk] = {};
  for (int j = 0; j < component.size().y(); ++j)
    for (int k = 0; k < component.size().z(); k += kPathChunk) {
      const float* __restrict p = &component(i, j, k);
      for (int n = 0; n < kPathChunk; ++n) lane[n] = larger(std::abs(p[n]), lane[n]);
    }
  return *std::max_element(lane, lane + kPathChunk);
}

}  // namespace

void cellStarts(const MacVelocity& velocity, int i, int j, int k, PathPoints& centre, PathPoints& wind) {
  placeRun(static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f, static_cast<float>(k) + 0.5f, centre);
  float* const component[3] = {wind.x, wind.y, wind.z};
  for (int a = 0; a < 3; ++a) meanOfTwo(&velocity[a](i, j, k), velocity[a].stride(a), component[a]);
}

void faceStarts(const MacVelocity& velocity, int axis, int i, int j, int k, PathPoints& centre,
                PathPoints& wind) {
  const auto shift = [axis](int a) { return a == axis ? 0.0f : 0.5f; };
  placeRun(static_cast<float>(i) + shift(0), static_cast<float>(j) + shift(1),
           static_cast<float>(k) + shift(2), centre);
  float* const component[3] = {wind.x, wind.y, wind.z};
  for (int a = 0; a < 3; ++a) {
    const DenseField<float>& u = velocity[a];
    if (a == axis)
      copyRun(&u(i, j, k), component[a]);
    else
      meanOfFour(&u(i, j, k), u.stride(axis), u.stride(a), component[a]);
  }
}

void tracePaths(const MacView& wind, const Eigen::Vector3f& top, float cellsPerSpeed,
                const PathPoints& __restrict centre, const PathPoints& __restrict startWind,
                PathPoints& __restrict end) {
  const float topX = top.x(), topY = top.y(), topZ = top.z(), half = 0.5f * cellsPerSpeed;
  for (int n = 0; n < kPathChunk; ++n) {
    const Velocity3f u = sampleInnerVelocity(wind, keptInside(centre.x[n] + half * startWind.x[n], topX),
                                             keptInside(centre.y[n] + half * startWind.y[n], topY),
                                             keptInside(centre.z[n] + half * startWind.z[n], topZ));
    end.x[n] = keptInside(centre.x[n] + cellsPerSpeed * u.x, topX);
    end.y[n] = keptInside(centre.y[n] + cellsPerSpeed * u.y, topY);
    end.z[n] = keptInside(centre.z[n] + cellsPerSpeed * u.z, topZ);
  }
}

void sampleRun(const FieldView& field, const PathPoints& __restrict at, float* __restrict value) {
  for (int n = 0; n < kPathChunk; ++n)
    value[n] = sampleInner(field, at.x[n] - 0.5f, at.y[n] - 0.5f, at.z[n] - 0.5f);
}

float largestSpeed(const MacVelocity& velocity) {
  float largest = 0;
  for (const DenseField<float>& component : velocity.axis)
    largest = larger(largest, reduceSlabs(
                                  component.size().x(), 0.0f,
                                  [&](int i) { return largestInSlab(component, i); }, &larger));
  return largest;
}

}  // namespace spume::fluid
