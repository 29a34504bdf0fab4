#pragma once

#include "apps/preview/preview_scene.h"
#include "coupling/run_folder.h"
#include "coupling/simulation.h"

namespace spume::apps {

/// Writes the caches and the picture of the simulation's present frame, as the scene's [output] asks.
/// Throws coupling::FileError.
void writeFrame(const coupling::RunFolder& folder, const coupling::Simulation& simulation);

/// What a picture of a liquid and its bubbles shows; views of `liquid` and `bubbles`, which must outlive it.
PreviewScene previewOf(const coupling::Scene& scene, const fluid::LiquidState& liquid,
                       const foam::BubbleStore& bubbles);

}  // namespace spume::apps
