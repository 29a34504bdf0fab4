#include "coupling/vdb_liquid_sampler.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <mutex>

#include "coupling/trilinear.h"
#include "fluid/parallel.h"

namespace spume::coupling {
namespace {

constexpr Eigen::Index kBatch = 512;  // points a task: some 50 us of work
constexpr double kDepthOfPressure =
    0.5;                               // [dx] under the surface, where all pressures round a point are known
constexpr double kLeastWeight = 1e-3;  // of a face, so that a point on a closed one still asks its neighbours
constexpr Eigen::Index kManyPoints =
    4096;  // from which on looking at all faces of the grid first costs less than at those round each point
constexpr double kLeastSlope = 1e-3;  // |grad phi| below which there is no way to the surface

template <typename Body>
void forEachPoint(Eigen::Index points, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, points, kBatch), [&](const auto& range) {
    for (Eigen::Index i = range.begin(); i < range.end(); ++i) body(i);
  });
}

}  // namespace

/// The windows that are sampled, borrowed or kept, and the answers for one point.
struct VdbLiquidSampler::Source {
  fluid::GridSpec grid;
  const fluid::DenseField<float>* phi = nullptr;
  const fluid::MacVelocity* velocity = nullptr;
  const fluid::DenseField<float>* psi = nullptr;
  const fluid::SolidBoundary* solids = nullptr;              ///< null for a cached frame
  const fluid::MacField<float>* pressureGradient = nullptr;  ///< null for a cached frame
  Eigen::Vector3d hydrostatic{0, 0, 0};                      ///< used instead of it [Pa/m]
  SolidVelocity solidVelocity;
  LiquidFrame frame;  ///< kept if cached
  mutable std::once_flag facesLookedAt;
  mutable fluid::MacField<std::uint8_t> isKnown;  ///< by face: knowsPressure, once it has been asked of many

  Eigen::Vector3d insideGrid(const Eigen::Vector3d& x) const {
    return x.cwiseMax(grid.origin).cwiseMin(grid.upper());
  }

  double phiAt(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d inside = insideGrid(x);
    const TrilinearCell cell = locate(grid.cells, firstCentre(), grid.toCells(inside));
    const TrilinearSamples samples(*phi, cell);
    const double value = samples.interpolate(cell);
    return inside == x ? value : value + samples.gradient(cell).dot(x - inside) / grid.dx;
  }

  Eigen::Vector3d gradPhiAt(const Eigen::Vector3d& x) const {
    const TrilinearCell cell = locate(grid.cells, firstCentre(), grid.toCells(insideGrid(x)));
    return TrilinearSamples(*phi, cell).gradient(cell) / grid.dx;
  }

  Eigen::Vector3d velocityAt(const Eigen::Vector3d& x) const {
    return faceVelocityAt(*velocity, grid.toCells(insideGrid(x)));
  }

  /// In an edge of the domain psi does not rise square to either wall; only the ghosts know where these are.
  double psiAt(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d inside = insideGrid(x);
    const TrilinearCell cell = locate(grid.cells, firstCentre(), grid.toCells(inside), solids != nullptr);
    return TrilinearSamples(*psi, cell).interpolate(cell) - (x - inside).norm();
  }

  Eigen::Vector3d gradPsiAt(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d inside = insideGrid(x), beyond = x - inside;
    const TrilinearCell cell = locate(grid.cells, firstCentre(), grid.toCells(inside), solids != nullptr);
    Eigen::Vector3d gradient = TrilinearSamples(*psi, cell).gradient(cell) / grid.dx;
    for (int axis = 0; axis < 3; ++axis)
      if (beyond[axis] != 0)
        gradient[axis] = 0;  // psi is continued from `inside`, which stays put along the axis
    return beyond.isZero(0) ? gradient : Eigen::Vector3d(gradient - beyond.normalized());
  }

  int solidAt(const Eigen::Vector3d& x) const {
    if (!solids) return -1;
    const Eigen::Vector3i last = grid.cells - Eigen::Vector3i::Ones();
    const Eigen::Vector3i cell = grid.toCells(insideGrid(x)).cast<int>().cwiseMin(last);
    return solids->object(cell);
  }

  /// `x`, or the place just under the surface that is nearest to it: above the surface there is no pressure
  /// to ask for, yet a bubble whose centre is in the air still dips into the liquid there.
  Eigen::Vector3d underSurface(const Eigen::Vector3d& x) const {
    const double tooHigh = phiAt(x) + kDepthOfPressure * grid.dx;
    const Eigen::Vector3d slope = gradPhiAt(x);
    const double steepness = slope.squaredNorm();
    return tooHigh > 0 && steepness > kLeastSlope * kLeastSlope
               ? Eigen::Vector3d(x - tooHigh / steepness * slope)
               : x;
  }

  /// Whether the projection solved for the pressure across face (i, j, k): open, and liquid on one side at
  /// least.
  bool knowsPressure(int axis, const Eigen::Vector3i& face) const {
    const Eigen::Vector3i last = grid.cells - Eigen::Vector3i::Ones();
    const Eigen::Vector3i plus = face.cwiseMin(last);
    const Eigen::Vector3i minus = (face - Eigen::Vector3i::Unit(axis)).cwiseMax(0);
    return solids->open[axis](face) > 0 && std::min((*phi)(plus), (*phi)(minus)) < 0;
  }

  void lookAtFaces() const {
    isKnown = fluid::MacField<std::uint8_t>(grid.cells);
    for (int axis = 0; axis < 3; ++axis)
      fluid::forEachRow(isKnown[axis].size(), [&](int i, int j) { lookAtRow(axis, i, j); });
  }

  /// Sets isKnown for the faces (i, j, k) of a row. Faces at its ends have a cell on one side alone.
  void lookAtRow(int axis, int i, int j) const {
    const int along = axis == 2 ? 1 : 0, count = isKnown[axis].size().z();
    const auto look = [&](int k) { isKnown[axis](i, j, k) = knowsPressure(axis, {i, j, k}); };
    const Eigen::Vector3i plus = Eigen::Vector3i(i, j, 0).cwiseMin(grid.cells - Eigen::Vector3i::Ones());
    const Eigen::Vector3i minus = (Eigen::Vector3i(i, j, 0) - Eigen::Vector3i::Unit(axis)).cwiseMax(0);
    const float *open = &solids->open[axis](i, j, 0), *phiPlus = &(*phi)(plus),
                *phiMinus = &(*phi)(minus)-along;
    std::uint8_t* known = &isKnown[axis](i, j, 0);
    for (int k = along; k < count - along; ++k)
      known[k] = (open[k] > 0) & ((phiPlus[k] < 0) | (phiMinus[k] < 0));
    if (along != 0) look(0), look(count - 1);
  }

  /// `looked`: all faces have been looked at.
  double gradPressureAt(int axis, const Eigen::Vector3d& inCells, bool looked) const {
    const fluid::DenseField<float>& field = (*pressureGradient)[axis];
    const TrilinearCell cell = locate(field.size(), firstFace(axis), inCells);
    const TrilinearSamples samples(field, cell);
    TrilinearCell between = cell;  // weights of known faces must not be negative
    for (double& along : between.along) along = std::clamp(along, 0.0, 1.0);
    double weight[8], sum = 0, known = 0;
    trilinearWeights(between, weight);
    int faces = 0;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3i face(cell.corner[0] + (i >> 2), cell.corner[1] + (i >> 1 & 1),
                                 cell.corner[2] + (i & 1));
      if (!(looked ? isKnown[axis](face) != 0 : knowsPressure(axis, face))) continue;
      const double share = std::max(weight[i], kLeastWeight);
      sum += share * samples.value[i];
      known += share;
      ++faces;
    }
    if (faces == 8) return samples.interpolate(cell);
    return faces ? sum / known : 0.0;
  }

  Eigen::Vector3d gradPressureAt(const Eigen::Vector3d& x, bool looked) const {
    if (!pressureGradient) return hydrostatic;
    const Eigen::Vector3d inCells = grid.toCells(insideGrid(underSurface(x)));
    return {gradPressureAt(0, inCells, looked), gradPressureAt(1, inCells, looked),
            gradPressureAt(2, inCells, looked)};
  }
};

VdbLiquidSampler::VdbLiquidSampler(const fluid::LiquidState& liquid, const fluid::SolidBoundary& solids,
                                   SolidVelocity solidVelocity) {
  auto source = std::make_unique<Source>();
  source->grid = liquid.grid;
  source->phi = &liquid.phi;
  source->velocity = &liquid.velocity;
  source->psi = &solids.psi;
  source->solids = &solids;
  source->pressureGradient = &liquid.pressureGradient;
  source->solidVelocity = std::move(solidVelocity);
  source_ = std::move(source);
}

VdbLiquidSampler::VdbLiquidSampler(LiquidFrame frame, double density, const Eigen::Vector3d& gravity) {
  auto source = std::make_unique<Source>();
  source->frame = std::move(frame);
  source->grid = source->frame.liquid.grid;
  source->phi = &source->frame.liquid.phi;
  source->velocity = &source->frame.liquid.velocity;
  source->psi = &source->frame.psi;
  source->hydrostatic = density * gravity;
  source_ = std::move(source);
}

VdbLiquidSampler::~VdbLiquidSampler() = default;

void VdbLiquidSampler::phi(foam::Points x, foam::Scalars out) const {
  forEachPoint(x.cols(), [&](Eigen::Index i) { out[i] = source_->phiAt(x.col(i)); });
}

void VdbLiquidSampler::gradPhi(foam::Points x, foam::Vectors out) const {
  forEachPoint(x.cols(), [&](Eigen::Index i) { out.col(i) = source_->gradPhiAt(x.col(i)); });
}

void VdbLiquidSampler::velocity(foam::Points x, foam::Vectors out) const {
  forEachPoint(x.cols(), [&](Eigen::Index i) { out.col(i) = source_->velocityAt(x.col(i)); });
}

void VdbLiquidSampler::gradPressure(foam::Points x, foam::Vectors out) const {
  const bool look = source_->pressureGradient && x.cols() >= kManyPoints;
  // Isolated: a thread that waits in here must not be given another question to this sampler meanwhile.
  if (look)
    std::call_once(source_->facesLookedAt,
                   [&] { tbb::this_task_arena::isolate([&] { source_->lookAtFaces(); }); });
  forEachPoint(x.cols(), [&](Eigen::Index i) {
    out.col(i) = source_->gradPressureAt(Eigen::Vector3d(x.col(i)), look);
  });
}

void VdbLiquidSampler::psi(foam::Points x, foam::Scalars out) const {
  forEachPoint(x.cols(), [&](Eigen::Index i) { out[i] = source_->psiAt(x.col(i)); });
}

void VdbLiquidSampler::gradPsi(foam::Points x, foam::Vectors out) const {
  forEachPoint(x.cols(), [&](Eigen::Index i) { out.col(i) = source_->gradPsiAt(x.col(i)); });
}

void VdbLiquidSampler::solidVelocity(foam::Points x, foam::Vectors out) const {
  if (!source_->solidVelocity) {
    out.setZero();
    return;
  }
  forEachPoint(x.cols(), [&](Eigen::Index i) {
    out.col(i) = source_->solidVelocity(source_->solidAt(x.col(i)), x.col(i));
  });
}

void VdbLiquidSampler::solidIndex(foam::Points x, foam::Indices out) const {
  forEachPoint(x.cols(), [&](Eigen::Index i) { out[i] = source_->solidAt(x.col(i)); });
}

}  // namespace spume::coupling
