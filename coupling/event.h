#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "foam/bubble_store.h"

namespace spume::coupling {

/// Why something happened to a bubble. Births: from an escaped marker, a collapsed pocket, a source, the
/// scene's own bubbles, or a nucleation site. Ends: its time had come, its cluster had lost all support, a
/// region that removes bubbles, dissolved, left the domain.
enum class EventCause {
  none,
  marker,
  pocket,
  source,
  scene,
  nucleation,
  age,
  unsupported,
  region,
  dissolution,
  border
};

/// A row of events.csv.
struct Event {
  enum class Kind { birth, burst, merge, classChange, kill, leave } kind;
  double time;  ///< end of the sub-step of the foam it happened in; of births, kills and leaves that of the
                ///< step [s]
  std::uint64_t id;
  std::uint64_t other = 0;  ///< merge: the bubble that took the gas
  EventCause cause = EventCause::none;
  int origin = -1;  ///< number of the source, nucleation or region that did it, -1 if none
  Eigen::Vector3d position{0, 0, 0};
  double radius = 0, gas = 0, age = 0;
  foam::BubbleClass from = foam::BubbleClass::liquid, to = foam::BubbleClass::liquid;
};

/// An event of bubble i as it is now.
inline Event eventOf(Event::Kind kind, EventCause cause, double time, const foam::BubbleStore& bubbles,
                     std::size_t i) {
  Event event{kind, time, bubbles.id[i]};
  event.cause = cause;
  event.position = bubbles.position[i];
  event.radius = bubbles.radius[i], event.gas = bubbles.gas[i], event.age = bubbles.age[i];
  event.from = event.to = bubbles.type[i];
  return event;
}

}  // namespace spume::coupling
