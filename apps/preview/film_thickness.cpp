#include "apps/preview/film_thickness.h"

#include <algorithm>
#include <cmath>

#include "foam/counter_random.h"

namespace spume::apps {

float filmThickness(const coupling::LookSpec& look, std::uint64_t idA, std::uint64_t idB, float age,
                    const Vec3& place) {
  constexpr std::uint64_t kPurpose = 0x66696c6d;
  constexpr float kThinTop = 0.6f;  // share of its thickness a film has lost at the top
  constexpr float kSwirl = 0.12f;   // of the thickness, moved by the flow in the film
  const auto thin = static_cast<float>(look.filmThin), thick = static_cast<float>(look.filmThick);
  const auto drawn =
      static_cast<float>(foam::CounterRandom(kPurpose, std::min(idA, idB), std::max(idA, idB)).uniform());
  const float excess = (thick - thin) * drawn * std::exp(-age / static_cast<float>(look.filmDrainage));
  const float height = std::clamp(0.5f + 0.5f * place.y(), 0.0f, 1.0f);
  const float swirl =
      std::sin(5 * place.x() + 3 * place.y() + 6.28f * drawn) * std::sin(4 * place.z() + 2 * place.y());
  return thin + excess * (1 - kThinTop * height) * (1 + kSwirl * swirl);
}

}  // namespace spume::apps
