#include <algorithm>
#include <cmath>
#include <limits>

#include "fluid/counter_random.h"
#include "fluid/marker_particles.h"
#include "fluid/marker_sampling.h"
#include "fluid/parallel.h"
#include "fluid/sampling.h"

namespace spume::fluid {
namespace {

/// Random numbers for marker positions; the sign is added to keep the two sets apart.
constexpr std::uint64_t kSeedPurpose = 0x6d61726b;
/// Attempts per missing marker to find a place in its cell and on its side, each one attracted to a target
/// distance.
constexpr int kAttempts = 6;
/// Newton steps of one attraction; phi is a distance, so one nearly always does [Enright 2002].
constexpr int kAttractions = 3;
/// Markers by a solid stay this far from it [cells]: as far as their motion keeps them.
constexpr float kMarkerWallGap = 0.1f;
/// Cells whose centre lies deeper than this behind a wall get no markers [cells].
constexpr float kWallDepth = 0.5f;

/// No point of a cell is further from its centre than this [cells].
constexpr float kCellReach = 1;

/// A cell may hold this many times markersPerCell before some go: markers of one cell differ in age, and the
/// young ones, which go first, were drawn from a younger phi.
constexpr float kSurplus = 1.5f;

/// Part 0..1 of a cell on the marker's side, from the distance of its centre to that side [cells].
float sideFraction(float depth) { return std::clamp(0.5f + depth, 0.0f, 1.0f); }

}  // namespace

/// What seeding a set of one sign reads at every marker.
struct MarkerSeeder::Side {
  const MarkerScene& scene;
  const DenseField<float>& phi;
  FieldView view;
  float toCells;        ///< phi times this: distance into the marker's side [cells]
  float nearest, band;  ///< [cells]
  std::uint64_t purpose;

  Side(const MarkerScene& s, const DenseField<float>& f, MarkerSign sign)
      : scene(s),
        phi(f),
        view(f),
        toCells(static_cast<float>(static_cast<int>(sign) / s.grid.dx)),
        nearest(static_cast<float>(s.params.markerRadiusMin)),
        band(static_cast<float>(s.params.markerBand)),
        purpose(kSeedPurpose + static_cast<std::uint64_t>(sign == MarkerSign::positive)) {}

  /// Depth of a point in cell `c` [cells].
  float depth(const Eigen::Vector3i& c, float x, float y, float z) const {
    const WallSides& sides = scene.solids.sides;
    const bool besideWall = sides.guard(c) & WallSides::kBeside;
    return toCells * (besideWall ? sides.valueIn(phi, c, {x, y, z}) : sampleCentred(view, x, y, z));
  }
  ValueAndGradient slope(const Eigen::Vector3i& c, float x, float y, float z) const {
    return sampleOnSide(phi, view, scene.solids.sides, c, {x, y, z});
  }
  /// The volume of air markers is read anew from the grid in each sub-step, that of liquid may be theirs
  /// alone.
  bool holdsLiquid() const { return toCells < 0; }
  /// Markers cell (i, j, k) may keep: near the surface as many as a full cell, whatever part of it phi sees
  /// on their side, because where phi has lost a film the markers are what restores it.
  int allowed(int i, int j, int k) const {
    return toCells * phi(i, j, k) > band ? 0 : static_cast<int>(kSurplus * scene.params.markersPerCell);
  }
  /// False if all of a cell is within the band: phi is a distance there.
  bool mayStray(int i, int j, int k) const { return toCells * phi(i, j, k) > band - kCellReach; }
  /// Markers cell (i, j, k) should have.
  int wanted(int i, int j, int k) const {
    if (scene.solids.psi(i, j, k) < -kWallDepth * scene.grid.dx) return 0;
    if (scene.solids.sides.any() && !scene.solids.hasOpenFace(i, j, k)) return 0;
    const float depth = toCells * phi(i, j, k);
    if (depth > band) return 0;
    return static_cast<int>(std::lround(scene.params.markersPerCell * sideFraction(depth)));
  }
  /// True if a point of cell `c` lies in a solid or so near that the next sub-step would push it away, maybe
  /// through the surface.
  bool touchesSolid(const Eigen::Vector3i& c, float x, float y, float z) const {
    if (!scene.solids.sides.guard(c)) return false;
    const Eigen::Vector3f top = scene.grid.cells.cast<float>() - Eigen::Vector3f::Constant(0.5f);
    const Eigen::Vector3f at = Eigen::Vector3f(x, y, z).cwiseMax(0.5f).cwiseMin(top);
    const float gap = kMarkerWallGap * static_cast<float>(scene.grid.dx);
    return sampleCentred(FieldView(scene.solids.psi), at.x(), at.y(), at.z()) < gap ||
           sampleIndex(FieldView(scene.solids.nodePsi), x, y, z) < gap;
  }
  bool attract(CounterRandom& random, const Eigen::Vector3i& c, float& x, float& y, float& z) const;
};

/// Draws the point towards a random distance of its own side and says whether it got there.
bool MarkerSeeder::Side::attract(CounterRandom& random, const Eigen::Vector3i& c, float& x, float& y,
                                 float& z) const {
  const float goal = nearest + (0.5f - nearest) * static_cast<float>(random.uniform());
  const Eigen::Vector3f top = scene.grid.cells.cast<float>();
  for (int step = 0; step <= kAttractions; ++step) {
    const ValueAndGradient f = slope(c, x, y, z);
    const float here = toCells * f.value;
    if (here >= nearest && here <= band) return true;
    const float gx = toCells * f.gx, gy = toCells * f.gy, gz = toCells * f.gz;
    const float pull = (goal - here) / std::max(gx * gx + gy * gy + gz * gz, 0.25f);
    x = std::clamp(x + pull * gx, 0.0f, top.x());
    y = std::clamp(y + pull * gy, 0.0f, top.y());
    z = std::clamp(z + pull * gz, 0.0f, top.z());
  }
  return false;
}

/// Adds a volume to every marker of a cell that stays and has not escaped.
void MarkerSeeder::handOver(float volume, std::int32_t begin, std::int32_t end, MarkerSet& markers) {
  for (std::int32_t n = begin; n < end; ++n)
    if (!markers.escaped[n] && !std::isnan(markers.x[n])) markers.gas[n] += volume;
}

void MarkerSeeder::removeSurplus(const Side& side, MarkerSet& markers) {
  const Eigen::Vector3i cells = side.scene.grid.cells;
  const LargeVector<std::int32_t>& start = sorter_.cellStart();
  missing_.assign(cells.prod(), 0);
  forEachRow(cells, [&](int i, int j) {
    for (int k = 0; k < cells.z(); ++k) {
      const std::int32_t cell = (i * cells.y() + j) * cells.z() + k;
      int room = side.allowed(i, j, k);
      int present = 0;
      float left = 0;  // volume of those that are too many
      const bool mayStray = side.mayStray(i, j, k);
      for (std::int32_t n = start[cell]; n < start[cell + 1]; ++n) {
        if (markers.escaped[n]) continue;
        const bool strayed =
            mayStray && side.depth({i, j, k}, markers.x[n], markers.y[n], markers.z[n]) > side.band;
        if (strayed || room == 0) {
          if (!strayed) left += markers.gas[n];
          markers.x[n] = std::numeric_limits<float>::quiet_NaN();
        } else {
          --room;
          ++present;
        }
      }
      if (side.holdsLiquid() && left > 0 && present > 0)
        handOver(left / present, start[cell], start[cell + 1], markers);
      missing_[cell] = doubt_(i, j, k) ? 0 : std::max(0, side.wanted(i, j, k) - present);
    }
  });
}

void MarkerSeeder::addMissing(const Side& side, std::int64_t subStep, MarkerSet& markers) {
  const Eigen::Vector3i cells = side.scene.grid.cells;
  const auto placed = [&](int i, int j, int k, std::int32_t cell, MarkerSet& out) {
    CounterRandom random(side.scene.params.seed ^ static_cast<std::uint64_t>(subStep) << 32, cell,
                         side.purpose);
    for (int left = missing_[cell], attempt = 0; left > 0 && attempt < kAttempts * missing_[cell];
         ++attempt) {
      float x = static_cast<float>(i + random.uniform());
      float y = static_cast<float>(j + random.uniform());
      float z = static_cast<float>(k + random.uniform());
      if (!side.attract(random, {i, j, k}, x, y, z) || sorter_.cellNumber(x, y, z) != cell) continue;
      if (side.touchesSolid({i, j, k}, x, y, z)) continue;
      const float radius = std::clamp(side.depth({i, j, k}, x, y, z), side.nearest,
                                      static_cast<float>(side.scene.params.markerRadiusMax));
      out.append(x, y, z, radius);
      --left;
    }
  };
  slabs_.resize(cells.x());
  tbb::parallel_for(0, cells.x(), [&](int i) {
    slabs_[i].resize(0);
    for (int j = 0; j < cells.y(); ++j)
      for (int k = 0; k < cells.z(); ++k) {
        const std::int32_t cell = (i * cells.y() + j) * cells.z() + k;
        if (missing_[cell] > 0) placed(i, j, k, cell, slabs_[i]);
      }
  });
  sorter_.insert(slabs_, markers);
}

void MarkerSeeder::reseed(const MarkerScene& scene, const DenseField<float>& phi, std::int64_t subStep,
                          MarkerSet& positive, MarkerSet& negative) {
  doubt_.clear();
  doubt_.add(positive);
  doubt_.add(negative);
  for (const MarkerSign sign : {MarkerSign::positive, MarkerSign::negative}) {
    MarkerSet& markers = sign == MarkerSign::positive ? positive : negative;
    const Side side(scene, phi, sign);
    sorter_.sort(markers);
    removeSurplus(side, markers);
    addMissing(side, subStep, markers);
  }
}

}  // namespace spume::fluid
