#include "orbit_correction.hpp"

#include <vector>

#include "product_eigenvalues.hpp"

namespace orbweaver::spectrum {

namespace {

constexpr double joined_norm = 30.0;
constexpr double period_weight = 1e-3;

/// x_(m+1) = A x_m + forcing (1, change of h), over one or more segments.
struct Link {
  Eigen::MatrixXd transition;
  Eigen::MatrixXd forcing;  ///< dimension x 2
};

Link link_of(const Chain& chain, int m) {
  Link link{chain.transitions[static_cast<std::size_t>(m)], Eigen::MatrixXd(chain.states.rows(), 2)};
  link.forcing.col(0) = chain.defects.col(m);
  link.forcing.col(1) = chain.fields.col(m + 1);
  return link;
}

/// One eliminated state: triangle x_n = known - around x_0 - next x_(n+1), known in terms of (1, change of h).
struct Eliminated {
  Eigen::MatrixXd triangle;
  Eigen::MatrixXd around;
  Eigen::MatrixXd next;
  Eigen::MatrixXd known;
};

/// The least solution of matrix x = right, rank given.
Eigen::VectorXd least_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right, Eigen::Index rank) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(matrix.cols());
  for (Eigen::Index n = 0; n < rank; ++n) {
    const double sigma = svd.singularValues()[n];
    if (sigma > 0.0) solution += svd.matrixV().col(n) * (svd.matrixU().col(n).dot(right) / sigma);
  }
  return solution;
}

}  // namespace

OrbitCorrection orbit_correction(const Chain& chain, const FundamentalGroup& group, bool conservative) {
  const Eigen::Index d = chain.states.rows();
  const int segments = chain.segments();
  const std::vector<int> first = joined_groups(chain.transitions, joined_norm);
  Eigen::MatrixXd around;                                 // rows left over: around x_0 + last x_n = known
  Eigen::MatrixXd last = Eigen::MatrixXd::Identity(d, d);
  Eigen::MatrixXd known;
  std::vector<Eliminated> eliminated;
  for (std::size_t n = 0; n < first.size(); ++n) {
    Link link = link_of(chain, first[n]);
    const int end = n + 1 < first.size() ? first[n + 1] : segments;
    for (int m = first[n] + 1; m < end; ++m) {
      const Link next = link_of(chain, m);
      link.forcing = next.transition.lazyProduct(link.forcing).eval() + next.forcing;
      link.transition = next.transition.lazyProduct(link.transition).eval();
    }
    if (n == 0) {
      around = -link.transition;
      known = link.forcing;
      continue;
    }
    Eigen::MatrixXd column(2 * d, d);
    column << last, -link.transition;
    Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(2 * d, 2 * d + 2);
    rest.topLeftCorner(d, d) = around;
    rest.block(d, d, d, d).setIdentity();
    rest.topRightCorner(d, 2) = known;
    rest.bottomRightCorner(d, 2) = link.forcing;
    const Eigen::HouseholderQR<Eigen::MatrixXd> factor(column);
    rest.applyOnTheLeft(factor.householderQ().adjoint());
    eliminated.push_back({factor.matrixQR().topRows(d), rest.topLeftCorner(d, d), rest.block(0, d, d, d),
                          rest.topRightCorner(d, 2)});
    around = rest.bottomLeftCorner(d, d);
    last = rest.block(d, d, d, d);
    known = rest.bottomRightCorner(d, 2);
  }
  const double steps = static_cast<double>(segments) * group.order;
  const double weight = conservative ? period_weight : 1.0;
  Eigen::MatrixXd closing(d, d + 1);
  closing << around + last * group.generator, -known.col(1) * (weight / steps);
  const Eigen::VectorXd solution = least_solution(closing, known.col(0), conservative ? d - 1 : d);

  OrbitCorrection correction;
  correction.step = solution[d] * weight / steps;
  correction.states.resize(d, segments + 1);
  correction.states.col(0) = solution.head(d);
  correction.states.col(segments) = group.generator * solution.head(d);
  const Eigen::Vector2d forced(1.0, correction.step);
  for (std::size_t n = first.size(); n-- > 1;) {
    const int end = n + 1 < first.size() ? first[n + 1] : segments;
    const Eliminated& rows = eliminated[n - 1];
    const Eigen::VectorXd right =
        rows.known * forced - rows.around * correction.states.col(0) - rows.next * correction.states.col(end);
    correction.states.col(first[n]) = rows.triangle.triangularView<Eigen::Upper>().solve(right);
  }
  for (std::size_t n = 0; n < first.size(); ++n) {
    const int end = n + 1 < first.size() ? first[n + 1] : segments;
    for (int m = first[n]; m + 1 < end; ++m)
      correction.states.col(m + 1) = chain.transitions[static_cast<std::size_t>(m)] * correction.states.col(m) +
                                     chain.defects.col(m) + chain.fields.col(m + 1) * correction.step;
  }
  return correction;
}

}  // namespace orbweaver::spectrum
