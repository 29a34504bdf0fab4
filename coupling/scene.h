#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/look_spec.h"
#include "fluid/fluid_params.h"
#include "foam/bubble_store.h"
#include "foam/foam_params.h"
#include "foam/gas_exchange.h"
#include "foam/radius_distribution.h"

namespace spume::coupling {

/// A number that may be animated: constant, or piecewise linear in time between keys, held beyond them.
struct Animated {
  std::vector<std::pair<double, double>> keys{{0.0, 0.0}};  ///< (t [s], value), times increasing
  Animated() = default;
  Animated(double constant) : keys{{0.0, constant}} {}  // NOLINT: a number is the constant animation
  double at(double t) const;
  double rate(double t) const;  ///< per second, of the stretch that ends at t; 0 beyond the keys
  double integral(double from, double to) const;  ///< over time, from <= to
  double largest() const;                         ///< over all times
  bool operator==(const Animated&) const = default;
};

/// The same for a vector.
struct AnimatedVector {
  std::vector<std::pair<double, Eigen::Vector3d>> keys{{0.0, Eigen::Vector3d::Zero()}};
  AnimatedVector() = default;
  AnimatedVector(const Eigen::Vector3d& constant) : keys{{0.0, constant}} {}  // NOLINT: as Animated
  Eigen::Vector3d at(double t) const;
  Eigen::Vector3d rate(double t) const;
};

enum class ShapeKind { box, sphere, cylinder, halfSpace, vessel, mesh, levelSet };

/// A solid or region given by its signed distance. Unused fields are ignored.
struct ShapeSpec {
  ShapeKind kind = ShapeKind::box;
  Eigen::Vector3d lower{0, 0, 0}, upper{0, 0, 0};  ///< box corners [m]
  /// [m] sphere, cylinder: centre; halfSpace: a point of the plane; vessel: middle of its inner bottom
  Eigen::Vector3d centre{0, 0, 0};
  Eigen::Vector3d axis{0, 1, 0};  ///< cylinder axis; halfSpace normal, out of it; vessel: towards its mouth
  double radius = 0;              ///< [m]
  double height = 0;              ///< cylinder length along its axis [m]
  double innerDiameter = 0.08, innerHeight = 0.1;         ///< of a vessel, a round mug or glass [m]
  double wallThickness = 0.005, bottomThickness = 0.005;  ///< of it [m]
  std::string file = {};  ///< mesh: closed OBJ or PLY; levelSet: VDB; < 0 inside
  double scale = 1;       ///< [m] per unit of the file
};

struct DomainSpec {
  Eigen::Vector3d lower{0, 0, 0};  ///< [m]
  Eigen::Vector3d size{0, 0, 0};   ///< [m], > 0; the only key without a default
  int resolution = 64;             ///< cells along the longest edge, 8 to 1024
  std::array<bool, 6> closed{true, true, true, false, true, true};  ///< walls: -x +x -y +y -z +z
};

struct TimeSpec {
  double fps = 30;       ///< frames a second, 1 to 1000
  int frames = 150;      ///< 1 to 1000000
  double minDt = 0.005;  ///< shortest shared step [s], 1e-6 to 1
  double maxDt = 0.02;   ///< longest shared step [s], 1e-6 to 1
  int maxSubSteps = 4;   ///< liquid sub-steps the shared step is sized for, 1 to 100
};

/// A rigid motion from where the shape was placed: turned about the line through `pivot`, then shifted.
struct MotionSpec {
  AnimatedVector position;                ///< shift [m]
  Animated rotation{0.0};                 ///< [degrees], right-handed about `rotationAxis`
  Eigen::Vector3d rotationAxis{0, 0, 1};  ///< any length > 0
  Eigen::Vector3d pivot{0, 0, 0};         ///< [m]
};

struct SolidSpec {
  std::string name;
  ShapeSpec shape;
  MotionSpec motion = {};
  foam::SolidSurface surface = {};  ///< how bubbles take to it
};

/// Liquid that is there at the start: a shape, or the inside of a vessel up to a depth.
struct LiquidBodySpec {
  std::string name;
  ShapeSpec shape;
  std::string vessel = {};  ///< name of the solid it fills instead; empty: `shape`
  double depth = 0;         ///< of the liquid above the middle of the vessel's bottom [m]
};

/// Liquid that rests, in closed form: a flat surface square to gravity, and no liquid solver. Solids and
/// walls are the scene's.
struct StillPoolSpec {
  bool enabled = false;
  double level = 0;  ///< height of the surface against gravity, along y without it [m]
};

/// The liquid of an earlier run, from its caches, instead of one that is solved.
struct LiquidCacheSpec {
  std::string run;  ///< folder of that run; empty: the liquid is solved
};

/// Bubbles the scene starts with: one, or those of a file.
struct BubblesSpec {
  std::string file;  ///< .csv, .ply or .vdb; where it is given the bubble does not count
  foam::NewBubble bubble;
};

enum class SourceMeasure { number, gas };

/// Blows bubbles into a region.
struct BubbleSourceSpec {
  std::string name;
  ShapeSpec shape;
  SourceMeasure measure = SourceMeasure::number;
  Animated rate{100};      ///< in SourceMeasure::number [1/s]
  Animated gasRate{1e-6};  ///< in SourceMeasure::gas [m^3/s]
  foam::RadiusDistribution radius;
  Eigen::Vector3d velocity{0, 0, 0};  ///< of the new bubbles [m/s]
  double wetness = -1;                ///< lambda of the new bubbles, < 0: as [foam] says
  bool immersed = true;               ///< blows only where there is liquid
  double start = 0, stop = 1e9;       ///< on between [s]
};

/// Sites on solids where bubbles come out of solution, one after the other.
struct NucleationSpec {
  std::string name;
  std::string solid;     ///< name of one, "walls" of the domain, or empty: all
  double density = 1e4;  ///< of the sites [1/m^2]
  double waiting = 0.5;  ///< mean time between a bubble's leaving and the next one [s]
  foam::RadiusDistribution radius{foam::RadiusLaw::uniform, 1e-4, 0, 0, 1e-4, 1e-4};  ///< when it appears
  double start = 0, stop = 1e9;                                                       ///< active between [s]
};

/// Removes the bubbles whose centre is inside.
struct BubbleKillSpec {
  std::string name;
  ShapeSpec shape;
  double start = 0, stop = 1e9;  ///< on between [s]
};

struct InflowSpec {
  std::string name;
  Eigen::Vector3d centre{0, 0, 0};  ///< of the outlet disc [m]
  Eigen::Vector3d direction{0, -1, 0};
  double radius = 0.01;          ///< of the outlet disc [m]
  Animated speed{0.5};           ///< along `direction` [m/s]
  double turbulence = 0;         ///< rms relative fluctuation of the speed, 0 to 0.5
  double start = 0, stop = 1e9;  ///< open between [s]
};

enum class DrainMode { free, rate };

/// A region that takes liquid out, booked as drained.
struct OutflowSpec {
  std::string name;
  ShapeSpec shape;
  DrainMode mode = DrainMode::free;  ///< free: open to the air at p = 0; rate: a pump
  Animated rate{1e-4};               ///< of a pump [m^3/s]
  double start = 0, stop = 1e9;      ///< open between [s]
};

enum class ProbeKind { height, pressure, velocity, volume };

/// A measurement, one row of probes.csv a step.
struct ProbeSpec {
  std::string name;
  ProbeKind kind = ProbeKind::height;
  Eigen::Vector3d position{0, 0,
                           0};  ///< height: where the gauge's foot stands; pressure, velocity: the point
  ShapeSpec shape;              ///< volume: the region
};

/// Where escaped markers become bubbles (model, Section 4: rules 2 to 5).
struct EntrainmentSpec {
  bool enabled = true;
  /// L_e: gas of a marker is multiplied by L_e/dx [m], 1e-5 to 0.1. 3.6 mm gives the pouring scene 0.9 of the
  /// gas that plunging jets entrain, Qa/Qw = 0.04 Fr^0.28 (L/d)^0.4 (model, Section 4).
  double length = 3.6e-3;
  /// Smallest impact speed that entrains [m/s], 0 to 10 (fluid/impact_speed.h). Water entrains from about
  /// 1 m/s on. Measured at 64^3: a soft jet and a drop that land at 0.8 to 0.9 m/s stay below 1.0, of the
  /// pouring scene's leavers the calm pool's stay below 0.7 and the jet's come at 1.2 to 1.7.
  double onset = 1.1;
  double blockSize = 1e-2;                           ///< edge of a gas reservoir [m], 1e-4 to 0.1
  double medianRadius = 0.75e-3;                     ///< lognormal radius distribution: median [m]
  double sigma = 0.3;                                ///< of ln r [-], 0 to 2
  double minRadius = 0.375e-3, maxRadius = 1.25e-3;  ///< cut [m]
};

struct CouplingSpec {
  EntrainmentSpec entrainment;
  bool immersedGas = true;  ///< bubbles under the surface raise it
  bool twoWay = false;      ///< the liquid feels the drag of the bubbles
};

struct OutputSpec {
  bool liquid = true, bubblesVdb = true, bubblesPly = true, preview = true;
  bool dropsVdb = true, dropsPly = true;
  bool films = false;  ///< soap films as a mesh; costs seconds a frame
  bool staggeredVelocity = false;
  int every = 1;             ///< caches every n-th frame, 1 to 1000
  int checkpointEvery = 10;  ///< frames between checkpoints, 1 to 10000
  Eigen::Vector2i previewSize{480, 360};
};

struct CameraSpec {
  Eigen::Vector3d eye{0, 0, 0};     ///< [m]; eye == target: placed automatically from the domain
  Eigen::Vector3d target{0, 0, 0};  ///< [m]
  double fieldOfView = 35;          ///< vertical [degrees], 5 to 120
};

class SolidFileStore;
std::shared_ptr<SolidFileStore> makeSolidFileStore();

/// A scene with every value resolved; `scene_toml.h` reads and writes it.
struct Scene {
  std::string name = "scene";  ///< file-name safe
  std::string title;
  std::uint64_t seed = 1;
  DomainSpec domain;
  TimeSpec time;
  fluid::FluidParams liquid;
  foam::Preset preset = foam::Preset::physical;
  foam::FoamParams foam;
  StillPoolSpec stillPool;
  LiquidCacheSpec liquidCache;
  foam::DissolvedGasParams dissolvedGas;
  CouplingSpec coupling;
  OutputSpec output;
  CameraSpec camera;
  LookSpec look;
  std::vector<SolidSpec> solids;
  std::vector<InflowSpec> inflows;
  std::vector<OutflowSpec> outflows;
  std::vector<ProbeSpec> probes;
  std::vector<LiquidBodySpec> liquidBodies;
  std::vector<BubblesSpec> bubbles;
  std::vector<BubbleSourceSpec> bubbleSources;
  std::vector<NucleationSpec> nucleation;
  std::vector<BubbleKillSpec> bubbleKills;
  std::shared_ptr<SolidFileStore> solidFiles =
      makeSolidFileStore();  ///< what was read of them; copies share it

  double dx() const { return domain.size.maxCoeff() / domain.resolution; }
  /// Whether the liquid is computed: not where it rests or is an earlier run's.
  bool solvesLiquid() const { return !stillPool.enabled && liquidCache.run.empty(); }
};

}  // namespace spume::coupling
