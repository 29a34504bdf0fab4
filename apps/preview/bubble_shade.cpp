#include "apps/preview/bubble_shade.h"

#include <algorithm>
#include <cmath>

#include "foam/forces/strong_spring.h"
#include "foam/power_cells.h"

namespace spume::apps {
namespace {

constexpr double kMostContacts = 14;  // faces of a bubble in a dry foam, about

/// Push of a pair on each other [N], >= 0.
double pushOf(const foam::FoamParams& params, const foam::BubbleStore& bubbles,
              const foam::FoamTopology& topology, const foam::OverlapPair& pair) {
  const double ri = bubbles.radius[pair.i], rj = bubbles.radius[pair.j];
  const double wetness = 0.5 * (bubbles.wetness[pair.i] + bubbles.wetness[pair.j]);
  const double area = pair.film >= 0 ? topology.films[pair.film].area : 0;
  const foam::PairSpring spring =
      foam::strongSpring(foam::springStiffness(params, ri, rj), ri, rj, wetness, pair.distance, area);
  return std::max(0.0, -spring.tension);
}

}  // namespace

std::vector<double> bubbleShade(PreviewStyle style, const foam::FoamParams& params,
                                const foam::BubbleStore& bubbles) {
  const bool contacts = style == PreviewStyle::contacts;
  if (!contacts && style != PreviewStyle::pressure) return {};
  foam::FoamTopology topology;
  foam::PowerCells().compute(bubbles.position, bubbles.radius, bubbles.id, topology);
  std::vector<double> shade(bubbles.size(), 0.0);
  for (const foam::OverlapPair& pair : topology.overlaps)
    for (const std::int32_t b : {pair.i, pair.j}) {
      const double r = bubbles.radius[b];
      if (contacts)
        shade[b] += (pair.film >= 0) / kMostContacts;
      else  // F / (4 pi r^2) over 2 sigma / r
        shade[b] += pushOf(params, bubbles, topology, pair) / (8 * M_PI * params.surfaceTension * r);
    }
  for (double& value : shade) value = std::min(value, 1.0);
  return shade;
}

}  // namespace spume::apps
