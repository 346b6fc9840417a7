#include "product_eigenvalues.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/numerics/eigenvalues.hpp"

namespace orbweaver::spectrum {

namespace {

using Complex = std::complex<double>;

/// Factors are multiplied while the product's norm stays below this, so that at most two digits of the small values are
/// lost.
constexpr double joined_norm = 100.0;
/// Orthogonal iteration of a product of whole periods: a ratio of 10 takes 14 sweeps.
constexpr int most_sweeps = 40;
/// Entries below the diagonal, relative to the frame, that are rounding: the values have parted.
constexpr double parted = 1e-14;
/// Moduli closer than this are taken as one, so that the order of a complex pair does not hang on rounding.
constexpr double same_modulus = 1e-10;

/// Neighbouring factors multiplied while the norm stays below `joined_norm`, so that no digits are lost.
std::vector<Eigen::MatrixXd> joined(const std::vector<Eigen::MatrixXd>& factors) {
  std::vector<Eigen::MatrixXd> groups{factors.front()};
  Eigen::MatrixXd next;
  for (std::size_t n = 1; n < factors.size(); ++n) {
    next.noalias() = factors[n] * groups.back();
    if (next.norm() <= joined_norm)
      groups.back().swap(next);
    else
      groups.push_back(factors[n]);
  }
  return groups;
}

/// After `sweep`, product * frame = next * (triangles multiplied, first acts first).
struct Iteration {
  Eigen::MatrixXd frame;
  Eigen::MatrixXd next;
  std::vector<Eigen::MatrixXd> triangles;

  void sweep(const std::vector<Eigen::MatrixXd>& groups) {
    triangles.resize(groups.size());
    Eigen::MatrixXd basis = frame;
    for (std::size_t n = 0; n < groups.size(); ++n) {
      const Eigen::HouseholderQR<Eigen::MatrixXd> factor(groups[n] * basis);
      triangles[n] = factor.matrixQR().triangularView<Eigen::Upper>();
      basis = factor.householderQ();
    }
    next = basis;
  }
};

/// How far the frame is from one that parts the values at each place.
std::vector<double> couplings(const Iteration& iteration) {
  const Eigen::MatrixXd turn = iteration.frame.transpose() * iteration.next;
  const Eigen::Index r = turn.rows();
  std::vector<double> out;
  for (Eigen::Index cut = 1; cut < r; ++cut) out.push_back(turn.bottomLeftCorner(r - cut, cut).norm());
  return out;
}

/// Ends of the diagonal blocks into which frame' * next falls.
std::vector<Eigen::Index> block_ends(const Iteration& iteration) {
  const std::vector<double> coupled = couplings(iteration);
  std::vector<Eigen::Index> ends;
  for (std::size_t n = 0; n < coupled.size(); ++n)
    if (coupled[n] < parted) ends.push_back(static_cast<Eigen::Index>(n) + 1);
  ends.push_back(iteration.frame.rows());
  return ends;
}

/// Whether at some place values part within so many sweeps more, if they go on as over the last one.
bool may_part(const std::vector<double>& before, const std::vector<double>& now, int sweeps) {
  for (std::size_t n = 0; n < now.size(); ++n)
    if (!(now[n] < parted) && now[n] * std::pow(now[n] / before[n], sweeps) < parted) return true;
  return false;
}

/// Until the values have parted where they do: those on the unit circle do not.
Iteration iterate(const std::vector<Eigen::MatrixXd>& groups) {
  Iteration iteration;
  iteration.frame = numerics::orthogonal_in_general_position(groups.front().rows());
  iteration.sweep(groups);
  std::vector<double> before = couplings(iteration);
  for (int n = 0; n < most_sweeps; ++n) {
    iteration.frame = iteration.next;
    iteration.sweep(groups);
    std::vector<double> now = couplings(iteration);
    if (n > 0 && !may_part(before, now, most_sweeps - n)) break;
    before = std::move(now);
  }
  return iteration;
}

Eigen::MatrixXd diagonal_block(const Iteration& iteration, Eigen::Index begin, Eigen::Index end) {
  const Eigen::Index size = end - begin;
  Eigen::MatrixXd block = Eigen::MatrixXd::Identity(size, size);
  for (const Eigen::MatrixXd& triangle : iteration.triangles)
    block = triangle.block(begin, begin, size, size).triangularView<Eigen::Upper>() * block;
  return (iteration.frame.transpose() * iteration.next).block(begin, begin, size, size) * block;
}

double modulus(const Complex& value) {  // infinite also where it is not a number: both are beyond range
  const double size = std::abs(value);
  return std::isnan(size) ? std::numeric_limits<double>::infinity() : size;
}

bool before(const Complex& a, const Complex& b) {
  if (std::isinf(modulus(a)) || std::isinf(modulus(b))) return modulus(a) > modulus(b);
  const double difference = std::abs(a) - std::abs(b);
  if (std::abs(difference) > same_modulus * (std::abs(a) + std::abs(b))) return difference > 0.0;
  if (a.imag() != b.imag()) return a.imag() > b.imag();
  return a.real() > b.real();
}

std::vector<Complex> eigenvalues_of(const Eigen::MatrixXd& block) {
  std::vector<Complex> result(static_cast<std::size_t>(block.rows()), std::numeric_limits<double>::quiet_NaN());
  const std::optional<numerics::Eigensystem> system = numerics::eigensystem(block, false);
  if (!system) return result;
  std::copy_n(system->values.data(), result.size(), result.begin());
  std::sort(result.begin(), result.end(), before);
  return result;
}

/// k of a block whose multipliers come in pairs mu, 1/mu: B + B^-1 has each k twice, so that their means keep the
/// digits that the eigenvalues of B lose where two of them meet.
std::vector<Complex> paired_indices(const Eigen::MatrixXd& block) {
  std::vector<Complex> doubles = eigenvalues_of(block + block.inverse());
  std::vector<Complex> indices;
  while (doubles.size() > 1) {
    std::size_t nearest = 1;
    for (std::size_t n = 2; n < doubles.size(); ++n)
      if (std::abs(doubles[n] - doubles[0]) < std::abs(doubles[nearest] - doubles[0])) nearest = n;
    indices.push_back(0.5 * (doubles[0] + doubles[nearest]));
    doubles.erase(doubles.begin() + static_cast<std::ptrdiff_t>(nearest));
    doubles.erase(doubles.begin());
  }
  return indices;
}

}  // namespace

std::vector<Complex> product_eigenvalues(const std::vector<Eigen::MatrixXd>& factors, bool symplectic) {
  if (factors.empty() || factors.front().rows() == 0) return {};
  const Iteration iteration = iterate(joined(factors));
  const Eigen::Index r = iteration.frame.rows();
  const std::vector<Eigen::Index> ends = block_ends(iteration);
  std::vector<Complex> result;
  // A symplectic product has a block over the middle that is closed under mu -> 1/mu; those above it hold the larger
  // of each pair.
  Eigen::Index middle = r;
  if (symplectic) {
    middle = r / 2;
    for (Eigen::Index begin = 0; const Eigen::Index end : ends) {
      if (begin < r / 2 && end > r / 2) middle = std::min(begin, r - end);
      begin = end;
    }
    while (middle > 0 && std::find(ends.begin(), ends.end(), middle) == ends.end()) --middle;
  }
  for (Eigen::Index begin = 0; const Eigen::Index end : ends) {
    if (end > middle) break;
    for (const Complex& mu : eigenvalues_of(diagonal_block(iteration, begin, end)))
      result.push_back(symplectic ? mu + 1.0 / mu : mu);
    begin = end;
  }
  if (symplectic && 2 * middle < r) {
    const std::vector<Complex> inner = paired_indices(diagonal_block(iteration, middle, r - middle));
    result.insert(result.end(), inner.begin(), inner.end());
  }
  std::sort(result.begin(), result.end(), before);
  return result;
}

}  // namespace orbweaver::spectrum
