#include "orbweaver/loop/symmetry/fundamental_domain.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::loop {

namespace {

using Eigen::MatrixXd;

/// Entries of declared matrices are exact; those of products, singular values and shifts are good to some roundings.
/// What is not zero, or not the same, is of order 1: three orders more or less make no difference.
constexpr double zero_entry = 1e-12;
constexpr double same = 1e-9;

/// Rows that vanish exactly on the fixed space of `matrix`: sparse where the matrix is diagonal, orthonormal otherwise.
MatrixXd conditions_of_fixed_space(const MatrixXd& matrix) {
  const Eigen::Index d = matrix.rows();
  const MatrixXd moved = matrix - MatrixXd::Identity(d, d);
  MatrixXd rows(0, d);
  const auto add = [&rows](const Eigen::RowVectorXd& row) {
    rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
    rows.row(rows.rows() - 1) = row;
  };
  if (moved.isDiagonal(zero_entry)) {
    for (Eigen::Index i = 0; i < d; ++i)
      if (std::abs(moved(i, i)) > zero_entry) add(Eigen::RowVectorXd::Unit(d, i));
    return rows;
  }
  const Eigen::JacobiSVD<MatrixXd> svd(moved, Eigen::ComputeFullV);
  for (Eigen::Index n = 0; n < d; ++n)
    if (svd.singularValues()(n) > same) add(svd.matrixV().col(n).transpose());
  return rows;
}

}  // namespace

FundamentalDomain::Ends FundamentalDomain::ends() const {
  const Eigen::Index d = generator.rows();
  if (!reversor) return {generator, -MatrixXd::Identity(d, d)};
  const MatrixXd at_start = conditions_of_fixed_space(*reversor);
  const MatrixXd at_end = conditions_of_fixed_space(generator * *reversor);
  const Eigen::Index count = at_start.rows() + at_end.rows();
  Ends out{MatrixXd::Zero(count, d), MatrixXd::Zero(count, d)};
  out.left.topRows(at_start.rows()) = at_start;
  out.right.bottomRows(at_end.rows()) = at_end;
  return out;
}

bool FundamentalDomain::expresses(const Isotropy& isotropy) const {
  const Eigen::Index d = generator.rows();
  const MatrixXd kept = projection ? *projection : MatrixXd::Identity(d, d);
  return std::all_of(isotropy.begin(), isotropy.end(), [&](const SymmetryElement& element) {
    if (element.reversing && !reversor) return false;
    MatrixXd power = element.reversing ? *reversor : MatrixXd::Identity(generator.rows(), generator.cols());
    for (int n = 0; n < order; ++n) {
      const double turns = element.shift() - static_cast<double>(n) / order;
      if (std::abs(turns - std::round(turns)) < same && ((power - element.map.matrix) * kept).norm() < same)
        return true;
      power = generator * power;
    }
    return false;
  });
}

std::vector<bool> FundamentalDomain::coordinates_with_mean() const {
  const Eigen::Index d = generator.rows();
  MatrixXd mean = MatrixXd::Zero(d, d);
  MatrixXd power = MatrixXd::Identity(d, d);
  for (int n = 0; n < order; ++n) {
    mean += power / order;
    power = generator * power;
  }
  if (reversor) mean = 0.5 * (mean + *reversor * mean);
  std::vector<bool> out;
  for (Eigen::Index i = 0; i < d; ++i) out.push_back(mean.row(i).norm() > same);
  return out;
}

bool FundamentalDomain::is_square() const { return ends().left.rows() == generator.rows(); }

FundamentalDomain fundamental_domain(const systems::Structure& structure, const Isotropy& isotropy) {
  const SymmetryGroup group(structure, isotropy);
  FundamentalDomain domain;
  domain.order = group.order();
  domain.generator = group.generator().matrix;
  if (const SymmetryElement* reversor = group.reversor_at_start()) domain.reversor = reversor->map.matrix;
  MatrixXd sum = MatrixXd::Zero(domain.dimension(), domain.dimension());
  int count = 0;
  for (const SymmetryElement& element : group.elements())
    if (!element.reversing && element.shift_numerator == 0) {
      sum += element.map.matrix;
      ++count;
    }
  if (count > 1) domain.projection = sum / count;
  return domain;
}

}  // namespace orbweaver::loop
