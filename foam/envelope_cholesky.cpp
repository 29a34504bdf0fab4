#include "foam/envelope_cholesky.h"

#include <algorithm>
#include <cstring>

#include "foam/factor_inverse.h"
#include "foam/quad_lanes.h"

namespace spume::foam {
namespace {

constexpr std::size_t kLanes = 4;  ///< numbers of a DoubleQuad

/// By reference: without AVX functions do not return vectors of this size.
inline void load(const double* from, DoubleQuad& to) { std::memcpy(&to, from, sizeof to); }

inline double sumOf(const DoubleQuad& x) { return (x[0] + x[1]) + (x[2] + x[3]); }

/// P Q^T of three lines each of `count` numbers, `strideP` and `strideQ` apart.
Eigen::Matrix3d products(const double* p, std::size_t strideP, const double* q, std::size_t strideQ,
                         std::size_t count) {
  DoubleQuad sum[3][3] = {};
  std::size_t k = 0;
  for (; k + kLanes <= count; k += kLanes) {
    DoubleQuad of[3];
    for (int c = 0; c < 3; ++c) load(q + c * strideQ + k, of[c]);
    for (int r = 0; r < 3; ++r) {
      DoubleQuad line;
      load(p + r * strideP + k, line);
      for (int c = 0; c < 3; ++c) sum[r][c] += line * of[c];
    }
  }
  Eigen::Matrix3d product;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      double rest = 0;
      for (std::size_t l = k; l < count; ++l) rest += p[r * strideP + l] * q[c * strideQ + l];
      product(r, c) = sumOf(sum[r][c]) + rest;
    }
  return product;
}

/// P v of three lines of `count` numbers.
Eigen::Vector3d product(const double* p, std::size_t count, const double* v) {
  DoubleQuad sum[3] = {};
  std::size_t k = 0;
  for (; k + kLanes <= count; k += kLanes) {
    DoubleQuad of, line;
    load(v + k, of);
    for (int r = 0; r < 3; ++r) {
      load(p + r * count + k, line);
      sum[r] += line * of;
    }
  }
  Eigen::Vector3d result;
  for (int r = 0; r < 3; ++r) {
    double rest = 0;
    for (std::size_t l = k; l < count; ++l) rest += p[r * count + l] * v[l];
    result[r] = sumOf(sum[r]) + rest;
  }
  return result;
}

}  // namespace

void SparseBlocks::times(const Eigen::VectorXd& v, Eigen::VectorXd& product) const {
  product.resize(3 * size());
  for (std::size_t i = 0; i < size(); ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::int32_t e = start[i]; e < start[i + 1]; ++e) sum += block[e] * v.segment<3>(3 * other[e]);
    product.segment<3>(3 * i) = sum;
  }
}

void EnvelopeCholesky::order(const SparseBlocks& a) { number(a), layOut(a); }

/// From an end of each connected part: the row found last from any of its rows, of those with the fewest
/// couplings.
void EnvelopeCholesky::number(const SparseBlocks& a) {
  const auto n = static_cast<std::int32_t>(a.size());
  const auto degree = [&](std::int32_t i) { return a.start[i + 1] - a.start[i]; };
  place_.assign(n, -1), source_.clear();
  const auto spread = [&](std::int32_t from) {
    std::size_t next = source_.size();
    source_.push_back(from), place_[from] = 0;
    for (; next < source_.size(); ++next) {
      const std::int32_t i = source_[next];
      const auto found = static_cast<std::ptrdiff_t>(source_.size());
      for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e)
        if (std::int32_t& place = place_[a.other[e]]; place < 0) place = 0, source_.push_back(a.other[e]);
      std::stable_sort(source_.begin() + found, source_.end(),
                       [&](std::int32_t p, std::int32_t q) { return degree(p) < degree(q); });
    }
  };
  for (std::int32_t i = 0; i < n; ++i) {
    if (place_[i] >= 0) continue;
    const std::size_t known = source_.size();
    for (int turn = 0; turn < 2; ++turn) {
      std::int32_t end = i;
      if (turn > 0) end = source_.back();
      for (std::size_t k = known; k < source_.size(); ++k) place_[source_[k]] = -1;
      source_.resize(known);
      spread(end);
    }
  }
  std::reverse(source_.begin(), source_.end());
  for (std::int32_t k = 0; k < n; ++k) place_[source_[k]] = k;
}

void EnvelopeCholesky::layOut(const SparseBlocks& a) {
  const std::size_t n = a.size();
  first_.resize(n), begin_.resize(n), inverse_.resize(n);
  std::size_t all = 0;
  for (std::size_t k = 0; k < n; ++k) {
    first_[k] = k;
    const std::int32_t i = source_[k];
    for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e)
      first_[k] = std::min(first_[k], static_cast<std::size_t>(place_[a.other[e]]));
    begin_[k] = all, all += 3 * width(k);
  }
  value_.resize(all);
}

bool EnvelopeCholesky::factor(const SparseBlocks& a) {
  isUsable_ = true;
  for (std::size_t k = 0; k < a.size() && isUsable_; ++k) copyRow(a, k), isUsable_ = factorRow(k);
  return isUsable_;
}

void EnvelopeCholesky::copyRow(const SparseBlocks& a, std::size_t row) {
  const std::size_t count = width(row);
  double* const line = lines(row);
  std::fill(line, line + 3 * count, 0.0);
  const std::int32_t i = source_[row];
  for (std::int32_t e = a.start[i]; e < a.start[i + 1]; ++e) {
    const auto column = static_cast<std::size_t>(place_[a.other[e]]);
    if (column == row) inverse_[row] = a.block[e];
    if (column >= row) continue;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) line[r * count + 3 * (column - first_[row]) + c] = a.block[e](r, c);
  }
}

bool EnvelopeCholesky::factorRow(std::size_t row) {
  const std::size_t count = width(row);
  double* const line = lines(row);
  for (std::size_t column = first_[row]; column < row; ++column) {
    const std::size_t first = std::max(first_[row], first_[column]);
    const std::size_t from = 3 * (first - first_[row]), ofColumn = 3 * (first - first_[column]);
    double* const block = line + 3 * (column - first_[row]);
    Eigen::Matrix3d rest =
        -products(line + from, count, lines(column) + ofColumn, width(column), 3 * (column - first));
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) rest(r, c) += block[r * count + c];
    const Eigen::Matrix3d done = rest * inverse_[column].transpose();
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) block[r * count + c] = done(r, c);
  }
  const Eigen::Matrix3d rest = inverse_[row] - products(line, count, line, count, count);
  return invertFactor(rest, inverse_[row]);
}

/// Calls for what lies kAhead numbers behind a row: between two answers much else has gone through the
/// caches. `fetched` is how many have been called for.
void EnvelopeCholesky::fetch(std::size_t& fetched, std::size_t row) const {
  constexpr std::size_t kAhead = 4096, kCacheLine = 64 / sizeof(double);
  for (const std::size_t end = std::min(value_.size(), begin_[row] + kAhead); fetched < end;
       fetched += kCacheLine)
    __builtin_prefetch(&value_[fetched]);
}

void EnvelopeCholesky::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  x.setZero(b.size());
  if (!isUsable_) return;
  const std::size_t n = source_.size();
  work_.resize(b.size());
  std::size_t fetched = 0;
  for (std::size_t k = 0; k < n; ++k) {
    fetch(fetched, k);
    const Eigen::Vector3d known = product(lines(k), width(k), work_.data() + 3 * first_[k]);
    work_.segment<3>(3 * k) = inverse_[k] * (b.segment<3>(3 * source_[k]) - known);
  }
  for (std::size_t k = n; k-- > 0;) {
    const Eigen::Vector3d found = inverse_[k].transpose() * work_.segment<3>(3 * k);
    x.segment<3>(3 * source_[k]) = found;
    const std::size_t count = width(k);
    const double* const line = lines(k);
    double* const rest = work_.data() + 3 * first_[k];
    for (std::size_t l = 0; l < count; ++l)
      rest[l] -= line[l] * found[0] + line[count + l] * found[1] + line[2 * count + l] * found[2];
  }
}

}  // namespace spume::foam
