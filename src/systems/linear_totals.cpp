#include "orbweaver/systems/linear_totals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/numerics/quad.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "trial_states.hpp"

namespace orbweaver::systems {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using numerics::Quad;
using numerics::QuadMatrix;
using numerics::QuadVector;

/// Of equations and weights of the size 1: what is smaller is rounding's, of the computation in double precision; in
/// quadruple precision that of the model's constants, which are doubles (0.02 + 1 - 1.02 is 2e-17).
constexpr double to_double_rounding = 1e-10;
constexpr double to_quad_rounding = 4.0 * std::numeric_limits<double>::epsilon();

/// Of both signs, and positive as concentrations are.
std::vector<std::vector<double>> states_of(const Structure& structure) {
  const std::vector<std::vector<double>> origin{std::vector<double>(static_cast<std::size_t>(structure.dimension))};
  std::vector<std::vector<double>> states;
  for (const double size : trial_sizes)
    for (const std::vector<double>& state : states_around(structure, origin, states_a_size, size)) {
      states.push_back(state);
      states.push_back(state);
      for (double& coordinate : states.back()) coordinate = std::abs(coordinate);
    }
  return states;
}

/// Equations for weights, one a row: f and the columns of its Jacobian at states where they are finite.
MatrixXd equations_in_double(const System& system) {
  const Index d = system.dimension();
  std::vector<MatrixXd> blocks;
  for (const std::vector<double>& state : states_of(system.structure())) {
    VectorXd f(d);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(d, d);
    system.field_jacobian(1, state.data(), f.data(), jacobian.data());
    if (!f.allFinite() || !jacobian.allFinite()) continue;
    MatrixXd& block = blocks.emplace_back(d + 1, d);
    block.row(0) = f;
    block.bottomRows(d) = jacobian.transpose();
  }
  MatrixXd all(static_cast<Index>(blocks.size()) * (d + 1), d);
  for (std::size_t n = 0; n < blocks.size(); ++n) all.middleRows(static_cast<Index>(n) * (d + 1), d + 1) = blocks[n];
  return all;
}

/// The same, without those beyond double.
QuadMatrix equations_in_quad(const System& system, const QuadSystem& quad) {
  const Index d = system.dimension();
  std::vector<QuadMatrix> blocks;
  for (const std::vector<double>& state : states_of(system.structure())) {
    const QuadVector z = Eigen::Map<const VectorXd>(state.data(), d).cast<Quad>();
    QuadVector f(d);
    QuadMatrix jacobian(d, d);
    quad.linearize(z, f, jacobian);
    if (!f.cast<double>().allFinite() || !jacobian.cast<double>().allFinite()) continue;
    QuadMatrix& block = blocks.emplace_back(d + 1, d);
    block.row(0) = f.transpose();
    block.bottomRows(d) = jacobian.transpose();
  }
  QuadMatrix all(static_cast<Index>(blocks.size()) * (d + 1), d);
  for (std::size_t n = 0; n < blocks.size(); ++n) all.middleRows(static_cast<Index>(n) * (d + 1), d + 1) = blocks[n];
  return all;
}

/// A basis of the weights, one a row, told in `units` of its columns, in which the equations are of the size 1.
template <class Matrix>
Matrix weights_of(Matrix all, double rounding, Eigen::Matrix<typename Matrix::Scalar, Eigen::Dynamic, 1>& units) {
  using Scalar = typename Matrix::Scalar;
  const Index d = all.cols();
  units.setOnes(d);
  for (int sweep = 0; sweep < balancing_sweeps; ++sweep) {
    for (Index i = 0; i < all.rows(); ++i)
      if (const Scalar size = all.row(i).cwiseAbs().maxCoeff(); size > 0) all.row(i) /= size;
    for (Index l = 0; l < d; ++l)
      if (const Scalar size = all.col(l).cwiseAbs().maxCoeff(); size > 0) {
        all.col(l) /= size;
        units(l) /= size;
      }
  }
  Eigen::ColPivHouseholderQR<Matrix> qr(all);
  qr.setThreshold(Scalar(rounding));
  const Index rank = qr.rank();
  Matrix kernel = Matrix::Zero(d, d - rank);
  kernel.bottomRows(d - rank).setIdentity();
  if (rank > 0 && rank < d)
    kernel.topRows(rank) = -qr.matrixR()
                                .topLeftCorner(rank, rank)
                                .template triangularView<Eigen::Upper>()
                                .solve(qr.matrixR().topRightCorner(rank, d - rank).eval());
  return (qr.colsPermutation() * kernel).transpose();
}

/// Gauss and Jordan's form: each row's first column is 1 and in no other row. Entries below rounding are 0.
void reduce_rows(QuadMatrix& rows) {
  const auto is_zero = [](const Quad& entry) { return abs(entry) <= Quad(to_quad_rounding); };
  Index done = 0;
  for (Index l = 0; l < rows.cols() && done < rows.rows(); ++l) {
    Index best = done;
    for (Index a = done; a < rows.rows(); ++a)
      if (abs(rows(a, l)) > abs(rows(best, l))) best = a;
    if (is_zero(rows(best, l))) continue;
    rows.row(best).swap(rows.row(done));
    rows.row(done) /= Quad(rows(done, l));
    for (Index a = 0; a < rows.rows(); ++a)
      if (a != done) rows.row(a) -= Quad(rows(a, l)) * rows.row(done).eval();
    ++done;
  }
  for (Index a = 0; a < rows.rows(); ++a)
    for (Index l = 0; l < rows.cols(); ++l)
      if (is_zero(rows(a, l))) rows(a, l) = 0;
}

/// Of the field, one a row, those of angles left out, that stay the same while parameters move.
MatrixXd found_in(const System& system) {
  const Index d = system.dimension();
  const MatrixXd none(0, d);
  const auto* quad = dynamic_cast<const QuadSystem*>(&system);
  if (quad == nullptr || dynamic_cast<const FormulaSystem*>(&system) == nullptr) return none;
  MatrixXd in_double = equations_in_double(system);
  VectorXd units;
  if (in_double.rows() == 0 || in_double.isZero(0.0)) return none;
  if (weights_of(std::move(in_double), to_double_rounding, units).rows() == 0) return none;
  QuadVector quad_units;
  QuadMatrix rows = weights_of(equations_in_quad(system, *quad), to_quad_rounding, quad_units);
  reduce_rows(rows);
  MatrixXd found(rows.rows(), d);
  Index count = 0;
  for (Index a = 0; a < rows.rows(); ++a) {
    QuadVector weights = rows.row(a).transpose().cwiseProduct(quad_units);
    Index first = 0;
    while (weights(first) == 0) ++first;
    weights /= Quad(weights(first));
    const VectorXd told = weights.cast<double>();
    bool holds = true;
    for (const int angle : system.structure().angles) holds = holds && told(angle) == 0.0;
    for (const std::vector<double>& state : states_of(system.structure()))
      for (const std::string& name : system.family_scalars().free) {
        VectorXd slope(d);
        system.parameter_derivatives(name, 1, state.data(), slope.data());
        const VectorXd terms = slope.cwiseProduct(told);
        holds = holds && !(std::abs(terms.sum()) > half_the_digits * terms.cwiseAbs().sum());
      }
    if (holds) found.row(count++) = told;
  }
  return found.topRows(count);
}

/// A gradient that is the same at all states; empty otherwise.
VectorXd constant_gradient(const System& system, int quantity) {
  const Index d = system.dimension();
  VectorXd first;
  for (const std::vector<double>& state : states_of(system.structure())) {
    VectorXd gradient(d);
    system.conserved_gradient(quantity, state, {gradient.data(), state.size()});
    if (!gradient.allFinite()) continue;
    if (first.size() == 0) first = gradient;
    if ((gradient - first).cwiseAbs().maxCoeff() > to_double_rounding * first.cwiseAbs().maxCoeff()) return {};
  }
  return first.isZero(0.0) ? VectorXd() : first;
}

bool is_independent(const std::vector<LinearTotal>& of, const VectorXd& weights) {
  MatrixXd all(weights.size(), static_cast<Index>(of.size()) + 1);
  for (std::size_t n = 0; n < of.size(); ++n) all.col(static_cast<Index>(n)) = of[n].weights.normalized();
  all.rightCols(1) = weights.normalized();
  Eigen::ColPivHouseholderQR<MatrixXd> qr(all);
  qr.setThreshold(to_double_rounding);
  return qr.rank() == all.cols();
}

}  // namespace

std::vector<LinearTotal> linear_totals(const System& system) {
  const Structure& structure = system.structure();
  if (structure.symplectic || !(structure.dissipative || structure.conserved.empty())) return {};
  std::vector<LinearTotal> totals;
  for (std::size_t k = 0; k < structure.conserved.size(); ++k)
    if (const VectorXd weights = constant_gradient(system, static_cast<int>(k));
        weights.size() > 0 && is_independent(totals, weights))
      totals.push_back({structure.conserved[k], weights, static_cast<int>(k)});
  const MatrixXd found = found_in(system);
  for (Index a = 0; a < found.rows(); ++a) {
    const VectorXd weights = found.row(a);
    if (!is_independent(totals, weights)) continue;
    Index first = 0;
    while (weights(first) == 0.0) ++first;
    std::string name = "total_" + system.info().state_names[static_cast<std::size_t>(first)];
    while (system.parameters().contains(name)) name += "_";
    totals.push_back({std::move(name), weights});
  }
  if (structure.dimension < static_cast<int>(totals.size()) + 2) return {};
  return totals;
}

std::string sum_text(const std::vector<std::string>& names, const VectorXd& weights) {
  std::string sum;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double weight = weights(static_cast<Index>(i));
    if (weight == 0.0) continue;
    sum += sum.empty() ? (weight < 0.0 ? "-" : "") : (weight < 0.0 ? " - " : " + ");
    if (std::abs(weight) != 1.0) sum += fmt::format("{:.6g} ", std::abs(weight));
    sum += names[i];
  }
  return sum;
}

}  // namespace orbweaver::systems
