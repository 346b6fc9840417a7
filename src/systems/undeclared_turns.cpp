#include "orbweaver/systems/undeclared_turns.hpp"

#include <cstddef>

#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/undeclared_symmetries.hpp"

namespace orbweaver::systems {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Of the largest: what is smaller is rounding's.
constexpr double vanishes = 1e-9;
/// So many equations for each unknown, at each size.
constexpr int equations_each = 2;
/// Of the states around a point. Far from it one stiff term may be all of the field that double holds.
constexpr double sizes[] = {1.0, 1e-2, 1e-4};
/// Of the point's coordinates: nearer to it differences are rounding's.
constexpr double least_size = 1e-6;

/// Linear conditions for A, its columns one below the other: A f(z) = Df(z) A (z - p) at states around p, which holds
/// where the field stays the same under z -> p + exp(s A) (z - p). No rows where the field is linear about p: all that
/// commutes with it turns orbits then.
MatrixXd conditions_about(const System& system, const VectorXd& p) {
  const Index d = p.size();
  const std::vector<double> centre(p.data(), p.data() + d);
  MatrixXd rows(0, d * d);
  MatrixXd first;
  bool is_linear = true;
  for (const double size : sizes) {
    if (size < least_size * p.lpNorm<Eigen::Infinity>()) continue;
    for (const std::vector<double>& state :
         states_around(system.structure(), {centre}, equations_each * static_cast<int>(d), size)) {
      VectorXd f(d);
      RowMajor jacobian(d, d);
      system.field_jacobian(1, state.data(), f.data(), jacobian.data());
      if (!f.allFinite() || !jacobian.allFinite()) continue;
      if (first.size() == 0) first = jacobian;
      is_linear = is_linear && (jacobian - first).norm() <= vanishes * first.norm();
      const VectorXd z = Eigen::Map<const VectorXd>(state.data(), d) - p;
      rows.conservativeResize(rows.rows() + d, Eigen::NoChange);
      for (Index l = 0; l < d; ++l)
        rows.block(rows.rows() - d, l * d, d, d) = f(l) * MatrixXd::Identity(d, d) - z(l) * jacobian;
      for (Index i = rows.rows() - d; i < rows.rows(); ++i)
        if (const double norm = rows.row(i).norm(); norm > 0.0) rows.row(i) /= norm;
    }
  }
  return is_linear ? MatrixXd(0, d * d) : rows;
}

}  // namespace

std::vector<std::string> undeclared_turns(const System& system, const std::vector<std::vector<double>>& points) {
  const Structure& structure = system.structure();
  const Index d = structure.dimension;
  if (!structure.symplectic || structure.driven || structure.conserved.size() != 1 || d > most_sign_changes ||
      !system.family_scalars().free.empty())
    return {};
  for (const std::vector<double>& point : points) {
    const MatrixXd conditions = conditions_about(system, Eigen::Map<const VectorXd>(point.data(), d));
    if (conditions.rows() < d * d) continue;
    const Eigen::JacobiSVD<MatrixXd> svd(conditions, Eigen::ComputeThinU | Eigen::ComputeThinV);
    VectorXd turned = VectorXd::Zero(d);  // by row of A
    for (Index n = 0; n < d * d; ++n)
      if (svd.singularValues()(n) <= vanishes * svd.singularValues()(0))
        turned = turned.cwiseMax(
            Eigen::Map<const MatrixXd>(svd.matrixV().col(n).data(), d, d).rowwise().lpNorm<Eigen::Infinity>());
    std::vector<std::string> names;
    for (Index i = 0; i < d; ++i)
      if (turned(i) > vanishes) names.push_back(system.info().state_names[static_cast<std::size_t>(i)]);
    if (!names.empty()) return names;
  }
  return {};
}

}  // namespace orbweaver::systems
