// Boxes around rows of balls.
#include <gtest/gtest.h>

#include "foam/row_boxes.h"
#include "tests/support/foam_balls.h"

namespace spume::foam::test {
namespace {

TEST(RowBoxes, FindAllBallsThatMeetAnother) {
  for (const int count : {0, 1, 15, 16, 17, 256, 257, 700}) {
    const Balls balls = count > 0 ? randomFoam(count, 0.5, 4, 0.5, 71) : Balls{};
    RowBoxes boxes;
    boxes.build(balls.position, balls.radius);
    for (const double r : {0.1, 2.0}) {
      for (int k = 0; k < 50; ++k) {
        const Eigen::Vector3d x = 0.2 * k * Eigen::Vector3d(1, 0.7, 0.4);
        std::vector<std::size_t> found, wanted;
        boxes.visitMeeting(x, r, [&](std::size_t j) { found.push_back(j); });
        for (std::size_t j = 0; j < balls.size(); ++j)
          if ((balls.position[j] - x).norm() < r + balls.radius[j]) wanted.push_back(j);
        EXPECT_EQ(found, wanted);
      }
    }
  }
}

}  // namespace
}  // namespace spume::foam::test
