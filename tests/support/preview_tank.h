#pragma once

#include <functional>
#include <vector>

#include "apps/preview/preview_scene.h"

namespace spume {

/// A box of 0.1 m with liquid below a level, a grid of n^3 cells.
struct Tank {
  fluid::GridSpec grid;
  fluid::DenseField<float> phi;
  std::vector<Eigen::Vector3d> position;
  std::vector<double> radius;
  std::vector<foam::BubbleClass> type;

  explicit Tank(int n, const std::function<double(const Eigen::Vector3d&)>& distance) {
    grid.cells = Eigen::Vector3i::Constant(n);
    grid.dx = 0.1 / n;
    phi = fluid::DenseField<float>(grid.cells);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) phi(i, j, k) = static_cast<float>(distance(grid.cellCentre(i, j, k)));
  }
  void addBubble(const Eigen::Vector3d& x, double r) {
    position.push_back(x);
    radius.push_back(r);
    type.push_back(foam::BubbleClass::liquid);
  }
  apps::PreviewScene scene() const {
    return {.grid = grid,
            .phi = phi,
            .lower = grid.origin,
            .upper = grid.upper(),
            .solids = {},
            .bubblePosition = position,
            .bubbleRadius = radius,
            .bubbleType = type,
            .bubbleId = {},
            .bubbleAge = {},
            .bubbleShade = {},
            .drops = {},
            .camera = {},
            .look = {}};
  }
};

}  // namespace spume
