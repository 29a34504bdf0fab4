#include "foam/block_system.h"

namespace spume::foam {

Eigen::Matrix3d BlockSystem::diagonal(std::size_t i) const {
  Eigen::Matrix3d sum = own[i];
  for (std::int32_t e = start[i]; e < start[i + 1]; ++e) {
    sum += block[e].along() * block[e].along().transpose();
    sum.diagonal().array() += block[e].across();
  }
  return sum;
}

}  // namespace spume::foam
