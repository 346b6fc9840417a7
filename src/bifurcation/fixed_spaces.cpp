#include "fixed_spaces.hpp"

#include <algorithm>

#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::bifurcation {

namespace {

Eigen::MatrixXd null_space(const Eigen::MatrixXd& conditions) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(conditions, Eigen::ComputeFullV);
  const Eigen::Index rank = (svd.singularValues().array() > same_element).count();
  return svd.matrixV().rightCols(conditions.cols() - rank);
}

Eigen::MatrixXd projector(const Eigen::MatrixXd& basis) { return basis * basis.transpose(); }

}  // namespace

std::vector<Eigen::MatrixXd> fixed_spaces(const std::vector<Eigen::MatrixXd>& matrices, int dimension) {
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(dimension, dimension);
  std::vector<Eigen::MatrixXd> spaces{identity};
  const auto add = [&](const Eigen::MatrixXd& basis) {
    if (basis.cols() == 0) return;
    const auto same = [&](const Eigen::MatrixXd& known) {
      return known.cols() == basis.cols() && (projector(known) - projector(basis)).norm() < same_element;
    };
    if (std::none_of(spaces.begin(), spaces.end(), same)) spaces.push_back(basis);
  };
  for (const Eigen::MatrixXd& g : matrices) add(null_space(g - identity));
  for (std::size_t a = 1; a < spaces.size(); ++a)
    for (std::size_t b = 1; b < a; ++b) {
      if (spaces[a].cols() < 2 || spaces[b].cols() < 2) continue;
      Eigen::MatrixXd outside(2 * dimension, dimension);
      outside << identity - projector(spaces[a]), identity - projector(spaces[b]);
      add(null_space(outside));
    }
  return spaces;
}

}  // namespace orbweaver::bifurcation
