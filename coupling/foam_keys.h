#pragma once

#include "coupling/key_table_builder.h"

namespace spume::coupling {

// The tables of a scene file that are about bubbles.

KeyTable stillPoolTable();
KeyTable liquidCacheTable();
KeyTable foamTable();
KeyTable wallTable();
KeyTable dissolvedGasTable();
KeyTable bubblesTable();
KeyTable nucleationTable();

/// Keys of a source of bubbles beside its name and shape.
void addSourceKeys(KeyTableBuilder<BubbleSourceSpec>& table);

/// How bubbles take to a solid; `place` finds the surface in an object.
template <typename Object, typename Place>
void addSurfaceKeys(KeyTableBuilder<Object>& table, const Place& place) {
  table.key(
      "adhesion", [place](Object & o) -> auto& { return place(o).adhesion; }, {0, 100, "N/m"},
      "s_sad of Eq. 7, of bubbles that have touched it");
  table.key(
      "detach_radius", [place](Object & o) -> auto& { return place(o).detachRadius; }, {0, 1, "m"},
      "largest bubble it holds against its buoyancy; 0: nothing sticks");
  table.key(
      "attraction", [place](Object & o) -> auto& { return place(o).attraction; }, {0, 1, "N m"},
      "beta of Eq. 8, in attraction_law \"coefficient\"");
  table.key(
      "contact_angle", [place](Object & o) -> auto& { return place(o).contactAngle; }, {0, 180, "degrees"},
      "through the liquid, in attraction_law \"capillary\"; under 90 draws bubbles, over 90 repels them");
}

/// `start` and `stop` of an object that has them.
template <typename Object>
void addTimeKeys(KeyTableBuilder<Object>& table) {
  table.key("start", &Object::start, {0, 1e9, "s"}, "on from")
      .key("stop", &Object::stop, {0, 1e9, "s"}, "on until");
}

}  // namespace spume::coupling
