#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fluid/dense_field.h"
#include "fluid/grid_spec.h"
#include "fluid/solid_boundary.h"

namespace spume::fluid {

/// A region that pours liquid in: inside it phi < 0 and the liquid moves with `velocity`.
struct Inflow {
  std::string name;
  std::function<double(const Eigen::Vector3d& x)> sdf;  ///< < 0 inside the region [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();   ///< [m/s]
  double area = 0;                        ///< true area of the outlet [m^2]; flux is exactly |velocity| area
  std::function<double(double t)> scale;  ///< multiplies the velocity; 0 = closed. Empty: always 1
  double turbulence = 0;                  ///< rms relative fluctuation of the axial speed, 0 to 0.5
};

/// Volume that entered through one inflow in one sub-step.
struct PouredVolume {
  double volume;         ///< flux times dt, and at the opening the liquid that fills the region [m^3]
  Eigen::Vector3i cell;  ///< a cell of the region, to find the body that receives it
};

/// The inflows of a scene on the grid. Each region acts as a nozzle: every face of which its cross-section
/// covers the fraction c is closed and carries c times the inflow velocity; tangential faces inside carry 0,
/// so that the jet does not drift. The region should be at least two cells deep along its velocity. Where the
/// velocity would drain a cell (the back of the nozzle) a source refills it, so the flux that enters the
/// liquid is exactly |velocity| area scale.
class InflowSet {
 public:
  /// Throws InvalidParameter if a region covers no face of the grid or a value is out of range.
  InflowSet(const GridSpec& grid, std::vector<Inflow> inflows, std::uint64_t seed);

  /// Once per sub-step [t - dt, t], after the solids moved and before the velocity is advected: phi =
  /// min(phi, sdf) in the open regions, their faces closed and prescribed in `boundary`, those of closed
  /// regions given back.
  const std::vector<PouredVolume>& stamp(double t, double dt, DenseField<float>& phi,
                                         SolidBoundary& boundary);

  /// Brings released faces to where a stamp at t has left them; phi knows already of the regions.
  void resume(double t, SolidBoundary& boundary);

  /// Gives the faces of all regions back, as before the first stamp.
  void release(SolidBoundary& boundary);

  /// Whether the last stamp turned air into liquid, or opened or closed a region.
  bool reshaped() const { return reshaped_; }

  /// Writes the nozzle's velocity on the faces it covers (full speed also where they are covered in part: the
  /// flux is the boundary's, this is what advection sees). Call after advection, before projection.
  void setVelocity(MacVelocity& velocity) const;

  /// Adds the source that feeds the back of the open nozzles [1/s].
  void addSource(DenseField<float>& divergenceSource) const;

  /// Flux of inflow `n` at time t: |velocity| area scale(t) [m^3/s].
  double flux(std::size_t n, double t) const;
  std::size_t size() const { return inflows_.size(); }

 private:
  struct Face {
    int axis;
    Eigen::Vector3i cell;  // the face is the minus face of this cell across `axis`
    float coverage;        // fraction inside the region, 0..1
    float velocity = 0;    // of the jet there, normalised [m/s]
    float savedOpen = 0, savedVelocity = 0;
  };
  struct Cell {
    Eigen::Vector3i cell;
    float sdf;  // [m]
  };
  struct Source {
    Eigen::Vector3i cell;
    float rate;  // [1/s]
  };
  struct Nozzle {
    std::vector<Face> faces;
    std::vector<Cell> cells;               // where the region lowers phi
    std::vector<Eigen::Vector3i> touched;  // cells whose liquid volume it can change
    std::vector<Source> sources;           // at its back
    Eigen::Vector3i deepest = Eigen::Vector3i::Zero();
    bool open = false;
  };
  double scaleAt(const Inflow& inflow, double t) const;
  Nozzle rasterise(const Inflow& inflow) const;
  void addFace(const Inflow& inflow, int axis, const Eigen::Vector3i& c, Nozzle& nozzle) const;
  void setSpeed(std::size_t n, double t, SolidBoundary& boundary);
  double fluctuation(std::size_t n, double t, const Eigen::Vector3d& x) const;
  void release(Nozzle& nozzle, SolidBoundary& boundary) const;
  void close(Nozzle& nozzle, SolidBoundary& boundary) const;

  GridSpec grid_;
  std::vector<Inflow> inflows_;
  std::vector<Nozzle> nozzles_;
  std::vector<PouredVolume> poured_;
  DenseField<float> balance_;  // net prescribed outflow per cell, zero between calls [m/s]
  std::uint64_t seed_;
  bool reshaped_ = false;
};

}  // namespace spume::fluid
