#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <span>

#include "coupling/scene.h"
#include "fluid/dense_field.h"
#include "fluid/drop.h"
#include "fluid/grid_spec.h"
#include "foam/bubble_store.h"

namespace spume::apps {

using Vec3 = Eigen::Vector3f;  ///< positions [m], directions [-] and linear RGB of the preview

/// What one picture shows. Holds views only: the fields and columns must outlive the call to `renderPreview`.
struct PreviewScene {
  fluid::GridSpec grid;
  const fluid::DenseField<float>& phi;                              ///< at cell centres [m], < 0 in liquid
  Eigen::Vector3d lower, upper;                                     ///< the box of glass [m]
  std::array<bool, 6> closed{true, true, true, false, true, true};  ///< panes: -x +x -y +y -z +z
  std::function<double(const Eigen::Vector3d&)> solid;  ///< psi of the solids [m], > 0 free; empty: none
  std::span<const Eigen::Vector3d> bubblePosition;      ///< [m]
  std::span<const double> bubbleRadius;                 ///< [m]
  std::span<const foam::BubbleClass> bubbleType;
  std::span<const fluid::Drop> drops;  ///< water in flight, drawn as balls
  coupling::CameraSpec camera;         ///< eye == target: placed to show the whole box
};

/// `beauty` shades bubbles as films of water; `classes` paints them by class.
enum class PreviewStyle { beauty, classes };

/// How one picture is computed.
struct PreviewSettings {
  int width = 480, height = 360;  ///< [pixels], 16 to 16384
  int samples = 1;                ///< per pixel and axis before refinement of edges, 1 to 8
  PreviewStyle style = PreviewStyle::beauty;
};

}  // namespace spume::apps
