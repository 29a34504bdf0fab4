#include "apps/reproduce/shear_modulus.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <limits>

namespace spume::apps {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// How a contact's force changes with the separation of its balls.
Matrix3d stiffnessOf(const SoftPacking::Contact& c) {
  const Matrix3d along = c.normal * c.normal.transpose();
  return SoftPacking::kStiffness * along - c.push / c.distance * (Matrix3d::Identity() - along);
}

/// The coordinates of the balls that touch others; one ball stays where it is.
class Unknowns {
 public:
  Unknowns(const std::vector<SoftPacking::Contact>& contacts, std::size_t balls, int dimensions)
      : dimensions_(dimensions), first_(balls, -1) {
    if (contacts.empty()) return;
    const std::int32_t fixed = contacts.front().i;
    for (const auto& c : contacts)
      for (const std::int32_t ball : {c.i, c.j})
        if (ball != fixed && first_[ball] < 0) first_[ball] = dimensions_ * count_++;
  }
  int size() const { return dimensions_ * count_; }

  void add(std::vector<Eigen::Triplet<double>>& entries, std::int32_t a, std::int32_t b,
           const Matrix3d& block) const {
    if (first_[a] < 0 || first_[b] < 0) return;
    for (int row = 0; row < dimensions_; ++row)
      for (int column = 0; column < dimensions_; ++column)
        entries.emplace_back(first_[a] + row, first_[b] + column, block(row, column));
  }
  void add(Eigen::VectorXd& sum, std::int32_t ball, const Vector3d& value) const {
    if (first_[ball] < 0) return;
    for (int axis = 0; axis < dimensions_; ++axis) sum[first_[ball] + axis] += value[axis];
  }

 private:
  int dimensions_, count_ = 0;
  std::vector<int> first_;  ///< coordinate of each ball; -1: none
};

}  // namespace

double shearModulus(const std::vector<SoftPacking::Contact>& contacts, std::size_t balls, int dimensions,
                    double volume) {
  if (contacts.empty()) return 0;
  const Unknowns unknowns(contacts, balls, dimensions);
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& c : contacts) {
    const Matrix3d m = stiffnessOf(c);
    unknowns.add(entries, c.i, c.i, m), unknowns.add(entries, c.j, c.j, m);
    unknowns.add(entries, c.i, c.j, -m), unknowns.add(entries, c.j, c.i, -m);
  }
  Eigen::SparseMatrix<double> all(unknowns.size(), unknowns.size());
  all.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(all);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  const int planes = dimensions == 3 ? 3 : 1;
  for (int plane = 0; plane < planes; ++plane) {
    Eigen::VectorXd forces = Eigen::VectorXd::Zero(unknowns.size());
    for (const auto& c : contacts) {
      const Vector3d change = c.distance * c.normal[(plane + 1) % 3] * Vector3d::Unit(plane);
      const Vector3d force = stiffnessOf(c) * change;
      sum += change.dot(force);
      unknowns.add(forces, c.j, force), unknowns.add(forces, c.i, -force);
    }
    const Eigen::VectorXd moves = factor.solve(forces);
    for (Eigen::Index k = 0; k < forces.size(); ++k) sum -= forces[k] * moves[k];
  }
  return sum / planes / volume;
}

}  // namespace spume::apps
