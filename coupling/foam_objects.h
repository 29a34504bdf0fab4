#pragma once

#include <vector>

#include "coupling/domain_box.h"
#include "coupling/errors.h"
#include "coupling/scene.h"
#include "coupling/scene_builder.h"
#include "foam/nucleation.h"

namespace spume::coupling {

/// The parameters of the foam with the surface of every solid of the scene.
foam::FoamParams foamParamsOf(const Scene& scene);

/// The scene's nucleation with solids by index.
std::vector<foam::NucleationParams> nucleationParamsOf(const Scene& scene);

/// What [[nucleation]] calls the walls of the domain.
inline constexpr char kWallsOfDomain[] = "walls";

/// Share of a region in the domain that is outside the solids, 0..1, of points drawn in it; finds 0.3 % for
/// sure.
double roomShare(const ShapeSpec& shape, const DomainBox& domain, const SignedDistance& psi);

/// Throws SceneError naming the first object about bubbles that cannot be simulated, of a file with its line,
/// and the remedy: a bubble outside the domain, inside a solid or larger than the domain; a source or a
/// region without a proper shape or outside the domain; a source with no room outside the
/// solids or of bubbles that no edge of the domain can hold.
void checkFoamObjects(const Scene& scene);

}  // namespace spume::coupling
