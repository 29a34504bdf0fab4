#pragma once

#include <memory>
#include <vector>

#include "coupling/liquid_part.h"
#include "coupling/scene.h"
#include "coupling/statistics.h"

namespace spume::coupling {

/// Columns that the probes of a scene fill, in order: of a probe called `gauge` [m] `gauge_surface` (the
/// topmost surface over its foot along the vertical) and `gauge_wet` (length of liquid there); of a pressure
/// point [Pa] its name; of a velocity point [m/s] `_x`, `_y`, `_z`; of a region [m^3] its name. A probe
/// without a name is called `probe0` and so on. Upwards is against gravity, or +y without any.
std::vector<ColumnInfo> probeColumns(const Scene& scene);

/// The probes of a scene, set up once.
class Probes {
 public:
  explicit Probes(const Scene& scene);
  ~Probes();
  Probes(Probes&&) noexcept;

  /// What they read now, one value a column. Pressure is relative to the air: 0 outside the liquid, and just
  /// under the surface and beside walls continued from the nearest cells by their gradients.
  std::vector<double> read(const LiquidPart& liquid) const;

 private:
  struct Internals;
  std::unique_ptr<const Internals> internals_;
};

}  // namespace spume::coupling
