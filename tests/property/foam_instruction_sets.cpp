// Programs for any x86-64 and for the wider registers of this machine give the same to round-off.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "tests/support/foam_sample.h"

namespace spume::foam::test {
namespace {

/// The sample as the portable program prints it.
class PortableSample {
 public:
  PortableSample() : pipe_(popen(SPUME_FOAM_PORTABLE, "r"), pclose) {
    std::size_t sizes[2] = {};
    EXPECT_EQ(std::fscanf(pipe_.get(), "%zu %zu", &sizes[0], &sizes[1]), 2);
    cells = read(sizes[0]), motion = read(sizes[1]);
  }
  std::vector<double> cells, motion;

 private:
  std::vector<double> read(std::size_t count) {
    std::vector<double> values(count);
    for (double& value : values) EXPECT_EQ(std::fscanf(pipe_.get(), "%lf", &value), 1);
    return values;
  }
  std::unique_ptr<FILE, int (*)(FILE*)> pipe_;
};

double largestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double largest = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

TEST(InstructionSets, AgreeToRoundOff) {
  constexpr double kCells = 1e-10;  // of radii about 1; some volumes are small differences of large ones
  constexpr double kMotion = 1e-5;  // [mm] 1e-5 of a radius: what bubbles that run into each other make of it
  const FoamSample here;
  const PortableSample portable;
  EXPECT_LT(largestDifference(here.cells, portable.cells), kCells);
  EXPECT_LT(largestDifference(here.motion, portable.motion), kMotion);
}

}  // namespace
}  // namespace spume::foam::test
