#include "floquet_chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/fourier.hpp"
#include "variational_step.hpp"

namespace orbweaver::spectrum {

namespace {

constexpr int order = 8;
/// Largest h times the growth or turning rate of the linearised flow.
constexpr double largest_turn = 0.3;

/// Few numbers of segments are used, so that few Fourier plans are made: 12 (4, 5, 6) 2^n, made a multiple of `factor`.
int allowed_segments(double at_least, int factor) {
  const int multiple = std::lcm(12, factor);
  for (int scale = 1;; scale *= 2)
    for (const int base : {4, 5, 6})
      if (multiple * base * scale >= at_least) return multiple * base * scale;
}

void take_nodes(const systems::System& system, const loop::Loop& loop, int around, Chain& chain) {
  const auto n = static_cast<std::size_t>(around);
  const auto d = static_cast<std::size_t>(loop.dimension);
  const auto count = static_cast<std::size_t>(chain.states.cols());
  std::vector<double> nodal(d * n);
  loop::FourierGrid::of_size(around).synthesize(loop.cutoff, loop.dimension, loop.modes.data(), nodal.data());
  std::vector<double> z(d * count);
  std::vector<double> f(d * count);
  std::vector<double> a(d * d * count);
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t j = 0; j < count; ++j)
      z[i * count + j] = nodal[i * n + j % n] + loop.winding[i] * 2 * std::numbers::pi * static_cast<double>(j) /
                                                    static_cast<double>(n);
  system.field_jacobian(count, z.data(), f.data(), a.data());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto rows = static_cast<Eigen::Index>(d);
  const auto columns = static_cast<Eigen::Index>(count);
  chain.states = Eigen::Map<const RowMajor>(z.data(), rows, columns);
  chain.fields = Eigen::Map<const RowMajor>(f.data(), rows, columns);
  chain.jacobians.resize(count);
  for (std::size_t j = 0; j < count; ++j) {
    chain.jacobians[j].resize(rows, rows);
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t l = 0; l < d; ++l)
        chain.jacobians[j](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(l)) = a[(i * d + l) * count + j];
  }
}

/// An estimate of the largest modulus of the Jacobians' eigenvalues, insensitive to the units of the coordinates.
double largest_rate(const Chain& chain) {
  double largest = 0.0;
  Eigen::MatrixXd square;
  Eigen::MatrixXd fourth;
  for (std::size_t j = 0; j < chain.jacobians.size(); j += 2) {
    square.noalias() = chain.jacobians[j].lazyProduct(chain.jacobians[j]);
    fourth.noalias() = square.lazyProduct(square);
    largest = std::max(largest, fourth.squaredNorm());
  }
  return std::pow(largest, 0.125);
}

/// Integrates from the states at the given nodes and hands each result to `take(node, state, transition)`.
template <class Take>
void integrate(VariationalStep& stepper, const Chain& chain, const std::vector<int>& nodes, double h, const Take& take) {
  constexpr std::size_t lanes = VariationalStep::lanes;
  const Eigen::Index d = chain.states.rows();
  std::vector<double> starts(static_cast<std::size_t>(d) * lanes);
  Eigen::VectorXd state(d);
  Eigen::MatrixXd transition(d, d);
  for (std::size_t first = 0; first < nodes.size(); first += lanes) {
    const std::size_t used = std::min(lanes, nodes.size() - first);
    for (std::size_t lane = 0; lane < lanes; ++lane)
      for (Eigen::Index i = 0; i < d; ++i)
        starts[static_cast<std::size_t>(i) * lanes + lane] = chain.states(i, nodes[first + std::min(lane, used - 1)]);
    stepper.run(starts.data(), h);
    for (std::size_t lane = 0; lane < used; ++lane) {
      for (Eigen::Index i = 0; i < d; ++i) {
        state[i] = stepper.states()[static_cast<std::size_t>(i) * lanes + lane];
        for (Eigen::Index l = 0; l < d; ++l)
          transition(i, l) = stepper.transitions()[static_cast<std::size_t>(i * d + l) * lanes + lane];
      }
      take(nodes[first + lane], state, transition);
    }
  }
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() == 4) return Eigen::Matrix4d(matrix).inverse();
  return matrix.inverse();
}

/// Where the reversor maps segment m: into segment `segment` of the chain, after `turns` applications of g.
struct Mirror {
  int segment;
  int turns;
};

Mirror mirror_of(int m, const loop::SymmetryElement& reversor, int segments, int around) {
  const int shift = around / reversor.shift_denominator * reversor.shift_numerator;
  const int image = (((shift - m - 1) % around) + around) % around;
  return {image % segments, image / segments};
}

/// Transition matrices of all segments; those that a reversor gives are not integrated.
void take_transitions(VariationalStep& stepper, const FundamentalGroup& group, Chain& chain) {
  const int segments = chain.segments();
  std::vector<int> own;
  std::vector<Mirror> mirrored(static_cast<std::size_t>(segments), Mirror{-1, 0});
  for (int m = 0; m < segments; ++m) {
    const Mirror mirror = group.reversor ? mirror_of(m, *group.reversor, segments, segments * group.order) : Mirror{m, 0};
    if (mirror.segment >= m) own.push_back(m);
    if (mirror.segment > m) mirrored[static_cast<std::size_t>(m)] = mirror;
  }
  std::vector<Eigen::MatrixXd> forward(static_cast<std::size_t>(group.order));
  std::vector<Eigen::MatrixXd> backward(forward.size());
  if (group.reversor) {
    forward[0] = group.reversor->matrix;
    backward[0] = group.reversor->matrix.inverse();
    for (std::size_t n = 1; n < forward.size(); ++n) {
      forward[n] = group.inverse * forward[n - 1];
      backward[n] = backward[n - 1] * group.generator;
    }
  }
  integrate(stepper, chain, own, chain.step, [&](int m, const Eigen::VectorXd& state, const Eigen::MatrixXd& transition) {
    chain.transitions[static_cast<std::size_t>(m)] = transition;
    chain.defects.col(m) = state - chain.states.col(m + 1);
    const Mirror mirror = mirrored[static_cast<std::size_t>(m)];
    if (mirror.segment < 0) return;
    const auto turns = static_cast<std::size_t>(mirror.turns);
    const Eigen::MatrixXd back = forward[turns] * inverse_of(transition);
    chain.transitions[static_cast<std::size_t>(mirror.segment)].noalias() = back.lazyProduct(backward[turns]);
    chain.defects.col(mirror.segment).noalias() = -back.lazyProduct(chain.defects.col(m));
  });
}

/// One double step against two single ones, at some of the segments: their difference is 2^(order + 1) - 2 times the
/// error of a single one.
void estimate_truncation(VariationalStep& stepper, Chain& chain) {
  constexpr double share = 1.0 / ((2 << order) - 2);
  const int segments = chain.segments();
  const int samples = std::min(static_cast<int>(VariationalStep::lanes), segments / 2);
  std::vector<int> nodes;
  for (int n = 0; n < samples; ++n) nodes.push_back(n * (segments - 1) / samples);
  std::vector<double> errors;
  integrate(stepper, chain, nodes, 2 * chain.step, [&](int m, const Eigen::VectorXd&, const Eigen::MatrixXd& transition) {
    const auto first = static_cast<std::size_t>(m);
    const Eigen::MatrixXd both = chain.transitions[first + 1].lazyProduct(chain.transitions[first]);
    errors.push_back(share * (transition - both).norm() / both.norm());
  });
  chain.truncation.assign(static_cast<std::size_t>(segments), 0.0);
  for (std::size_t n = 0; n < errors.size(); ++n) {
    const double next = errors[(n + 1) % errors.size()];
    const int end = n + 1 < errors.size() ? nodes[n + 1] : segments;
    for (int m = nodes[n]; m < end; ++m) chain.truncation[static_cast<std::size_t>(m)] = std::max(errors[n], next);
  }
}

Chain chain_of(const systems::System& system, const loop::Loop& loop, int around, const FundamentalGroup& group) {
  const int segments = around / group.order;
  Chain chain;
  chain.step = loop.period / around;
  chain.states.resize(loop.dimension, segments + 1);
  take_nodes(system, loop, around, chain);
  chain.transitions.resize(static_cast<std::size_t>(segments));
  chain.defects.resize(loop.dimension, segments);
  return chain;
}

}  // namespace

Chain make_chain(const systems::System& system, const loop::Loop& loop, const FundamentalGroup& group,
                 const FloquetOptions& options) {
  double wanted = std::max(options.least_segments, 2 * loop.cutoff + 2);
  int around = allowed_segments(wanted, group.grid_factor);
  Chain chain = chain_of(system, loop, around, group);
  wanted = loop.period * largest_rate(chain) / largest_turn;
  if (!std::isfinite(wanted))
    throw core::NotFiniteError("Floquet multipliers: the field's Jacobian is not finite on the orbit; expected finite "
                               "derivatives at every state of an accepted orbit");
  if (wanted > around) {
    around = allowed_segments(wanted, group.grid_factor);
    chain = chain_of(system, loop, around, group);
  }
  VariationalStep stepper(system);
  for (int refinement = 0;; ++refinement) {
    take_transitions(stepper, group, chain);
    estimate_truncation(stepper, chain);
    const double total = group.order * std::accumulate(chain.truncation.begin(), chain.truncation.end(), 0.0);
    if (total <= options.tolerance || refinement >= options.refinements) return chain;
    around *= 2;
    chain = chain_of(system, loop, around, group);
  }
}

}  // namespace orbweaver::spectrum
