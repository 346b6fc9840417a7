#include "orbit_correction.hpp"

#include <vector>

#include "matrix_table.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::spectrum {

namespace {

/// Segments are joined while the norm of their product stays below this: the correction then loses less than two
/// digits.
constexpr double joined_segment_norm = 30.0;
/// Weight of the period in the least squares: along a conservative family the orbit of (nearly) the same period is
/// meant.
constexpr double period_weight = 1e-3;

using Forcing = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// Segments begin .. end - 1 in one: x_end = transition x_begin + forcing (1, relative change of all h).
struct Link {
  Eigen::Index begin;
  Eigen::Index end;
  Eigen::MatrixXd transition;
  Forcing forcing;
};

/// Where the orbit is fastest. A shift of phase moves the state there most, and the least solution has none; where the
/// orbit all but rests it would be told by rounding alone.
Eigen::Index fastest_state(const Chain& chain) {
  Eigen::Index fastest = 0;
  chain.fields.leftCols(chain.segments()).colwise().squaredNorm().maxCoeff(&fastest);
  return fastest;
}

/// From state `first` around to it again; no link passes the chain's end.
template <int D>
std::vector<Link> links_of(const Chain& chain, Eigen::Index first) {
  using Square = Eigen::Matrix<double, D, D>;
  using Pair = Eigen::Matrix<double, D, 2>;
  const Eigen::Index d = chain.dimension();
  std::vector<Link> links;
  Square product;
  Square next(d, d);
  Pair forcing;
  Pair own(d, 2);
  Eigen::Index begin = first;
  for (Eigen::Index n = 0; n < chain.segments(); ++n) {
    const Eigen::Index m = (first + n) % chain.segments();
    const auto transition = matrix_in<D>(chain.transitions, m, d);
    own.col(0) = chain.defects.col(m);
    own.col(1) = chain.fields.col(m + 1) * chain.steps[m];
    if (m > begin) next.noalias() = transition * product;
    if (m < begin || (m > begin && next.norm() > joined_segment_norm)) {
      links.push_back({begin, m > begin ? m : chain.segments(), product, forcing});
      begin = m;
    }
    if (m == begin) {
      product = transition;
      forcing = own;
    } else {
      product = next;
      own.noalias() += transition * forcing;
      forcing = own;
    }
  }
  links.push_back({begin, first > 0 ? first : chain.segments(), product, forcing});
  return links;
}

/// One eliminated state: triangle x_n = known (1, relative change of all h) - around x_0 - next x_(n+1).
struct Eliminated {
  Eigen::MatrixXd triangle;
  Eigen::MatrixXd around;
  Eigen::MatrixXd next;
  Forcing known;
};

/// What is left in the end: around x_0 + last x_n = known (1, relative change of all h).
struct Remaining {
  Eigen::MatrixXd around;
  Eigen::MatrixXd last;
  Forcing known;
};

Eliminated eliminate(const Link& link, Remaining& rows) {
  const Eigen::Index d = link.transition.rows();
  Eigen::MatrixXd column(2 * d, d);
  column << rows.last, -link.transition;
  Eigen::MatrixXd others = Eigen::MatrixXd::Zero(2 * d, 2 * d + 2);
  others.topLeftCorner(d, d) = rows.around;
  others.block(d, d, d, d).setIdentity();
  others.topRightCorner(d, 2) = rows.known;
  others.bottomRightCorner(d, 2) = link.forcing;
  const Eigen::HouseholderQR<Eigen::MatrixXd> factor(column);
  others.applyOnTheLeft(factor.householderQ().adjoint());
  rows = {others.bottomLeftCorner(d, d), others.block(d, d, d, d), others.bottomRightCorner(d, 2)};
  return {factor.matrixQR().topRows(d), others.topLeftCorner(d, d), others.block(0, d, d, d),
          others.topRightCorner(d, 2)};
}

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

template <int D>
void fill_between(const Chain& chain, const std::vector<Link>& links, OrbitCorrection& correction) {
  for (const Link& link : links)
    for (Eigen::Index m = link.begin; m + 1 < link.end; ++m)
      correction.states.col(m + 1) =
          matrix_in<D>(chain.transitions, m, chain.dimension()).lazyProduct(correction.states.col(m)) +
          chain.defects.col(m) + chain.fields.col(m + 1) * (chain.steps[m] * correction.stretch);
}

template <int D>
OrbitCorrection correction_of(const Chain& chain, const FundamentalGroup& group, bool conservative) {
  const Eigen::Index d = chain.dimension();
  const Eigen::Index first = fastest_state(chain);
  std::vector<Link> links = links_of<D>(chain, first);
  const Eigen::MatrixXd back = group.generator.inverse();
  const auto is_behind = [&](const Link& link) { return link.begin < first; };  // the chain's end
  for (Link& link : links)
    if (is_behind(link)) {
      link.transition = group.generator * link.transition * back;
      link.forcing = group.generator * link.forcing;
    }
  Remaining rows{-links.front().transition, Eigen::MatrixXd::Identity(d, d), links.front().forcing};
  std::vector<Eliminated> eliminated;
  for (std::size_t n = 1; n < links.size(); ++n) eliminated.push_back(eliminate(links[n], rows));

  // The last unknown is the change of the period, over `weight`: in states as far as the orbit goes in that time.
  const double period = chain.steps.sum() * group.order;
  const double weight = (conservative ? period_weight : 1.0) / (period * chain.fields.col(first).norm());
  Eigen::MatrixXd closing(d, d + 1);
  closing << rows.around + rows.last * group.generator, -rows.known.col(1) * weight;
  const Eigen::VectorXd solution = least_solution(closing, rows.known.col(0), conservative ? d - 1 : d);

  OrbitCorrection correction;
  correction.stretch = solution[d] * weight;
  correction.states.resize(d, chain.states.cols());
  correction.states.col(first) = solution.head(d);
  const Eigen::Vector2d forced(1.0, correction.stretch);
  Eigen::VectorXd after = group.generator * solution.head(d);
  for (std::size_t n = links.size(); n-- > 1;) {
    const Eliminated& known = eliminated[n - 1];
    const Eigen::VectorXd right = known.known * forced - known.around * solution.head(d) - known.next * after;
    after = known.triangle.triangularView<Eigen::Upper>().solve(right);
    if (is_behind(links[n]))
      correction.states.col(links[n].begin) = back * after;
    else
      correction.states.col(links[n].begin) = after;
  }
  correction.states.col(chain.segments()) = group.generator * correction.states.col(0);
  fill_between<D>(chain, links, correction);
  // What is left of a shift of phase, in the mean over the whole loop.
  correction.states -= chain.fields * (chain.fields.cwiseProduct(correction.states).sum() / chain.fields.squaredNorm());
  return correction;
}

/// Of segments `first` to `last` - 1. `off`: where the segments leave the loop, `factor` times their offsets from it.
template <int D>
void change_transitions(const Chain& chain, const OrbitCorrection& correction, double factor, const Chain& off,
                        Eigen::Index first, Eigen::Index last, Chain& changed) {
  const Eigen::Index d = chain.dimension();
  Eigen::Matrix<double, D, D> before(d, d);
  Eigen::Matrix<double, D, D> after(d, d);
  for (Eigen::Index m = first; m < last; ++m) {
    const bool mirrored = chain.mirrored[static_cast<std::size_t>(m)];
    const auto transition = matrix_in<D>(chain.transitions, m, d);
    const auto begin = mirrored ? matrix_in<D>(off.jacobians, m, d) : matrix_in<D>(chain.jacobians, m, d);
    const auto end = mirrored ? matrix_in<D>(chain.jacobians, m + 1, d) : matrix_in<D>(off.jacobians, m, d);
    const double half = 0.5 * chain.steps[m];
    before = half * (matrix_in<D>(changed.jacobians, m, d) - begin);
    after =
        half * (matrix_in<D>(changed.jacobians, m + 1, d) - end) + (factor * correction.stretch * chain.steps[m]) * end;
    auto result = matrix_in<D>(changed.transitions, m, d);
    result = transition;
    result.noalias() += transition * before;
    result.noalias() += after * transition;
  }
}

}  // namespace

OrbitCorrection orbit_correction(const Chain& chain, const FundamentalGroup& group, bool conservative) {
  if (chain.dimension() == 4) return correction_of<4>(chain, group, conservative);
  return correction_of<Eigen::Dynamic>(chain, group, conservative);
}

Chain corrected(const systems::System& system, const Chain& chain, const OrbitCorrection& correction, double factor,
                core::Team* team) {
  Chain changed;
  changed.steps = chain.steps * (1.0 + factor * correction.stretch);
  changed.states = chain.states + factor * correction.states;
  evaluate_field(system, changed);
  Chain off;
  off.states = factor * chain.offsets;
  for (Eigen::Index m = 0; m < chain.segments(); ++m)
    off.states.col(m) += chain.states.col(chain.mirrored[static_cast<std::size_t>(m)] ? m : m + 1);
  evaluate_jacobians(system, off);
  changed.transitions.resize(chain.transitions.rows(), chain.transitions.cols());
  const auto change = [&](Eigen::Index first, Eigen::Index last) {
    if (chain.dimension() == 4)
      change_transitions<4>(chain, correction, factor, off, first, last, changed);
    else
      change_transitions<Eigen::Dynamic>(chain, correction, factor, off, first, last, changed);
  };
  if (team == nullptr)
    change(0, chain.segments());
  else
    team->divide("orbit correction: transitions", static_cast<int>(chain.segments()),
                 static_cast<int>(changed.transitions.rows()), changed.transitions.data(), change);
  return changed;
}

}  // namespace orbweaver::spectrum
