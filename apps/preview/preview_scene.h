#pragma once

#include <Eigen/Geometry>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "coupling/scene.h"
#include "fluid/dense_field.h"
#include "fluid/drop.h"
#include "fluid/grid_spec.h"
#include "foam/bubble_store.h"
#include "foam/soap_films.h"

namespace spume::apps {

using Vec3 = Eigen::Vector3f;  ///< positions [m], directions [-] and linear RGB of the preview

enum class Material { matte, glass };

/// A solid object of a picture.
struct PreviewSolid {
  std::function<double(const Eigen::Vector3d&)> distance;  ///< psi [m], > 0 in free space
  Material material = Material::matte;
};

/// What one picture shows. Holds views only: the fields and columns must outlive the call to `renderPreview`.
/// Columns of bubbles are of equal length or, where that is said, empty.
struct PreviewScene {
  fluid::GridSpec grid;
  const fluid::DenseField<float>& phi;                              ///< at cell centres [m], < 0 in liquid
  Eigen::Vector3d lower, upper;                                     ///< the box of the domain [m]
  std::array<bool, 6> closed{true, true, true, false, true, true};  ///< walls: -x +x -y +y -z +z
  std::vector<PreviewSolid> solids;
  std::span<const Eigen::Vector3d> bubblePosition;  ///< [m]
  std::span<const double> bubbleRadius;             ///< [m]
  std::span<const foam::BubbleClass> bubbleType;
  std::span<const std::uint64_t> bubbleId;  ///< sets the films' thickness; empty: the index
  std::span<const double> bubbleAge;        ///< [s]; empty: 0
  std::span<const double> bubbleShade;      ///< 0..1 for the styles contacts and pressure; empty: 0
  const foam::SoapFilms* films = nullptr;   ///< of these bubbles, for `beauty`; null: plane films
  std::span<const fluid::Drop> drops;       ///< liquid in flight, drawn as balls
  coupling::CameraSpec camera;              ///< eye == target: placed to show the whole box
  coupling::LookSpec look;
};

/// `beauty` is as light would show it; the others are diagrams of solid bubbles: coloured by class, by the
/// number of contacts, by the pressure of the neighbours.
enum class PreviewStyle { beauty, classes, contacts, pressure };

/// How one picture is computed.
struct PreviewSettings {
  int width = 480, height = 360;  ///< [pixels], 16 to 16384
  int samples = 1;                ///< per pixel and axis before refinement of edges, 1 to 8
  PreviewStyle style = PreviewStyle::beauty;
};

}  // namespace spume::apps
