#include "foam/row_boxes.h"

#include "foam/parallel.h"

namespace spume::foam {

void RowBoxes::build(const std::vector<Eigen::Vector3d>& centre, const std::vector<double>& radius) {
  centre_ = &centre, radius_ = &radius;
  fine_.resize((radius.size() + kFan - 1) / kFan), coarse_.resize((fine_.size() + kFan - 1) / kFan);
  forEachIndex(fine_.size(), [&](std::size_t box) {
    const std::size_t first = box * kFan, end = std::min(first + kFan, radius.size());
    Box around{centre[first], centre[first]};
    for (std::size_t k = first; k < end; ++k) {
      const double r = kSpare * radius[k];
      around.low = around.low.cwiseMin(centre[k] - Eigen::Vector3d::Constant(r));
      around.high = around.high.cwiseMax(centre[k] + Eigen::Vector3d::Constant(r));
    }
    fine_[box] = around;
  });
  for (std::size_t group = 0; group < coarse_.size(); ++group) {
    const std::size_t end = std::min((group + 1) * kFan, fine_.size());
    coarse_[group] = fine_[group * kFan];
    for (std::size_t box = group * kFan; box < end; ++box) {
      coarse_[group].low = coarse_[group].low.cwiseMin(fine_[box].low);
      coarse_[group].high = coarse_[group].high.cwiseMax(fine_[box].high);
    }
  }
}

}  // namespace spume::foam
