#pragma once

#include "foam/bubble_store.h"
#include "foam/foam_topology.h"
#include "foam/neighbours.h"
#include "foam/surroundings.h"

namespace spume::foam {

/// Share of its sphere that must be wet and uncovered for the surface to hold a bubble with full strength
/// (model, "Surface weight").
inline constexpr double kFullWetShare = 0.1;

/// Label of a bubble: liquid phi < -r; surface |phi| <= r if the liquid touches it (w > 0), else air; air phi
/// > r.
BubbleClass classify(double phi, double radius, double surfaceWeight);

/// How far above -r a liquid bubble must rise to be called surface, and above r a surface bubble to be called
/// air, in radii: a bubble at the border of two classes keeps its label while waves rock it.
inline constexpr double kClassMargin = 0.25;

/// The same with a memory: leaves a class only by a margin, and comes down from the air only to full surface
/// weight. Labels alone: no force depends on them.
BubbleClass reclassify(BubbleClass before, double phi, double radius, double surfaceWeight);

/// Sets `surfaceWeight` of every bubble from the geometry of the step's start, 1 for a liquid one,
/// w = min(1, uncovered wet area / (0.1 x 4 pi r^2)) afloat, 0 aloft [-]. The surface is taken flat across a
/// bubble. O(pairs), and 512 sample points x neighbours for the few bubbles whose covering decides.
void weighSurface(const Surroundings& around, const FoamTopology& topology, const Neighbours& neighbours,
                  BubbleStore& bubbles);

/// Sets `type` from the distances `phi` [m] to the surface, the weights and the labels so far.
void relabel(const Eigen::VectorXd& phi, BubbleStore& bubbles);

}  // namespace spume::foam
