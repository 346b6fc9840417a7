#include "floquet_chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include "matrix_table.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::spectrum {

namespace {

/// Segments a harmonic: leaves a relative error of 1e-12 to 1e-11 in the index of the double pendulum's orbits.
constexpr double segments_a_harmonic = 1.6;
/// Largest sum over segments of (h |A|)^8, |A| being the growth or turning rate of the linearised flow: leaves 1e-11 on
/// a linear oscillator that turns nine times.
constexpr double largest_sum = 5e-4;
/// The sum falls with this power of the number of segments: n terms of n^-8.
constexpr double power_of_segments = 7.0;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// States, field and Jacobian at the nodes of T/p, `around` being their number on the whole loop.
Chain nodes_of(const systems::System& system, const loop::Loop& loop, const FundamentalGroup& group, int around) {
  const Eigen::Index d = loop.dimension;
  const int stride = 2 * loop.cutoff / around + 1;
  const int grid = around * stride;
  RowMajor nodal(d, grid);
  loop::FourierGrid::of_size(grid).synthesize(loop.cutoff, loop.dimension, loop.modes.data(), nodal.data());
  Chain chain;
  const int segments = around / group.order;
  chain.steps = steps_of(loop, segments, around);
  chain.states.resize(d, segments + 1);
  for (Eigen::Index j = 0; j < chain.states.cols(); ++j)
    for (Eigen::Index i = 0; i < d; ++i)
      chain.states(i, j) = nodal(i, j * stride % grid) + loop.winding[static_cast<std::size_t>(i)] * 2 *
                                                             std::numbers::pi * static_cast<double>(j) / around;
  evaluate_field(system, chain);
  return chain;
}

/// Sum over segments of (h |A|)^8, |A| = |A^4|^(1/4) for the Jacobian A, which is insensitive to the units of the
/// coordinates.
template <int D>
double sum_of_rates(const Chain& chain) {
  double sum = 0.0;
  Eigen::Matrix<double, D, D> power;
  for (Eigen::Index j = 0; j < chain.segments(); ++j) {
    const auto a = matrix_in<D>(chain.jacobians, j, chain.dimension());
    power.noalias() = a.lazyProduct(a);
    power = power.lazyProduct(power).eval();
    const double step = chain.steps[j] * chain.steps[j] * chain.steps[j] * chain.steps[j];
    sum += step * step * power.squaredNorm();
  }
  return sum;
}

/// Integrates from the states at the given nodes and hands each result to `take(node, lane)`.
template <class Take>
void integrate(VariationalStep& stepper, const Chain& chain, std::span<const Eigen::Index> nodes, const Take& take) {
  constexpr std::size_t lanes = VariationalStep::lanes;
  const Eigen::Index d = chain.dimension();
  std::vector<double> starts(static_cast<std::size_t>(d) * lanes);
  double lengths[lanes];
  for (std::size_t first = 0; first < nodes.size(); first += lanes) {
    core::interruption_point();
    const std::size_t used = std::min(lanes, nodes.size() - first);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Eigen::Index node = nodes[first + std::min(lane, used - 1)];
      lengths[lane] = chain.steps[node];
      for (Eigen::Index i = 0; i < d; ++i) starts[static_cast<std::size_t>(i) * lanes + lane] = chain.states(i, node);
    }
    stepper.run(starts.data(), lengths, used);
    for (std::size_t lane = 0; lane < used; ++lane) take(nodes[first + lane], static_cast<Eigen::Index>(lane));
  }
}

/// Where the reversor maps segment m: into segment `segment` of the chain, after `turns` applications of g.
struct Mirror {
  Eigen::Index segment;
  Eigen::Index turns;
};

Mirror mirror_of(Eigen::Index m, const loop::SymmetryElement& reversor, Eigen::Index segments, Eigen::Index around) {
  const Eigen::Index shift = around / reversor.shift_denominator * reversor.shift_numerator;
  const Eigen::Index image = (((shift - m - 1) % around) + around) % around;
  return {image % segments, image / segments};
}

/// g^-n R and its inverse: what carries segment m, run backwards, to its mirror.
struct Carriers {
  std::vector<Eigen::MatrixXd> forward;
  std::vector<Eigen::MatrixXd> backward;

  explicit Carriers(const FundamentalGroup& group) {
    if (!group.reversor) return;
    forward.push_back(group.reversor->map.matrix);
    backward.push_back(group.reversor->map.matrix.inverse());
    for (int n = 1; n < group.order; ++n) {
      forward.push_back(group.inverse * forward.back());
      backward.push_back(backward.back() * group.generator);
    }
  }
};

/// Integrates the segments `own` and fills in them and their mirrors.
template <int D>
void fill_segments(VariationalStep& stepper, std::span<const Eigen::Index> own, const std::vector<Mirror>& mirrors,
                   const Carriers& carriers, Chain& chain) {
  const Eigen::Index d = chain.dimension();
  constexpr auto lanes = static_cast<Eigen::Index>(VariationalStep::lanes);
  integrate(stepper, chain, own, [&](Eigen::Index m, Eigen::Index lane) {
    auto transition = matrix_in<D>(chain.transitions, m, d);
    auto truncation = matrix_in<D>(chain.truncations, m, d);
    for (Eigen::Index i = 0; i < d; ++i) {
      chain.defects(i, m) = stepper.states()[i * lanes + lane] - chain.states(i, m + 1);
      for (Eigen::Index l = 0; l < d; ++l) {
        transition(i, l) = stepper.transitions()[(i * d + l) * lanes + lane];
        truncation(i, l) = stepper.truncations()[(i * d + l) * lanes + lane];
      }
    }
    chain.offsets.col(m) = chain.defects.col(m);
    const Mirror mirror = mirrors[static_cast<std::size_t>(m)];
    if (mirror.segment == m) return;
    const auto turns = static_cast<std::size_t>(mirror.turns);
    const Eigen::Matrix<double, D, D> back = carriers.forward[turns] * transition.inverse();
    matrix_in<D>(chain.transitions, mirror.segment, d) = back * carriers.backward[turns];
    const Eigen::Matrix<double, D, D> changed = back * truncation * carriers.backward[turns];
    matrix_in<D>(chain.truncations, mirror.segment, d) = -changed * matrix_in<D>(chain.transitions, mirror.segment, d);
    chain.defects.col(mirror.segment).noalias() = -back * chain.defects.col(m);
    chain.offsets.col(mirror.segment).noalias() = carriers.forward[turns] * chain.defects.col(m);
  });
}

/// All that `fill_segments` writes of segment m, as one column for the other members of a team, or from them.
template <class Copy>
void copy_segment(Chain& chain, Eigen::Index m, Eigen::Ref<Eigen::VectorXd> column, const Copy& copy) {
  const Eigen::Index d = chain.dimension();
  copy(chain.transitions.col(m), column.head(d * d));
  copy(chain.truncations.col(m), column.segment(d * d, d * d));
  copy(chain.defects.col(m), column.segment(2 * d * d, d));
  copy(chain.offsets.col(m), column.tail(d));
}

/// The same divided among a team: the bits of a segment depend neither on the others nor on who does it.
template <int D>
void fill_divided(core::Team& team, VariationalStep& stepper, const std::vector<Eigen::Index>& own,
                  const std::vector<Mirror>& mirrors, const Carriers& carriers, Chain& chain) {
  const Eigen::Index d = chain.dimension();
  const auto count = static_cast<int>(own.size());
  const Eigen::Index size = 2 * d * d + 2 * d;
  const bool with_mirrors = !carriers.forward.empty();
  Eigen::MatrixXd table((with_mirrors ? 2 : 1) * size, count);
  const auto copy_all = [&](int begin, int end, const auto& copy) {
    for (int n = begin; n < end; ++n) {
      const Eigen::Index m = own[static_cast<std::size_t>(n)];
      copy_segment(chain, m, table.col(n).head(size), copy);
      if (with_mirrors)
        copy_segment(chain, mirrors[static_cast<std::size_t>(m)].segment, table.col(n).tail(size), copy);
    }
  };
  team.divide(
      "Floquet chain: transitions", count, static_cast<int>(table.rows()), table.data(), [&](int begin, int end) {
        const auto first = own.begin() + begin;
        fill_segments<D>(stepper, std::span(first, static_cast<std::size_t>(end - begin)), mirrors, carriers, chain);
        copy_all(begin, end, [](const auto& from, auto to) { to = from; });
      });
  copy_all(0, count, [](auto to, const auto& from) { to = from; });
}

template <int D>
void take_transitions(VariationalStep& stepper, const FundamentalGroup& group, core::Team* team, Chain& chain) {
  const Eigen::Index d = chain.dimension();
  const Eigen::Index segments = chain.segments();
  chain.transitions.resize(d * d, segments);
  chain.truncations.resize(d * d, segments);
  chain.defects.resize(d, segments);
  chain.offsets.resize(d, segments);
  chain.mirrored.assign(static_cast<std::size_t>(segments), false);
  std::vector<Eigen::Index> own;
  std::vector<Mirror> mirrors;
  for (Eigen::Index m = 0; m < segments; ++m) {
    mirrors.push_back(group.reversor ? mirror_of(m, *group.reversor, segments, segments * group.order) : Mirror{m, 0});
    if (mirrors.back().segment < m) continue;
    own.push_back(m);
    if (mirrors.back().segment > m) chain.mirrored[static_cast<std::size_t>(mirrors.back().segment)] = true;
  }
  const Carriers carriers(group);
  if (team != nullptr)
    fill_divided<D>(*team, stepper, own, mirrors, carriers, chain);
  else
    fill_segments<D>(stepper, own, mirrors, carriers, chain);
}

void take_transitions(VariationalStep& stepper, const FundamentalGroup& group, core::Team* team, Chain& chain) {
  if (chain.dimension() == 4)
    take_transitions<4>(stepper, group, team, chain);
  else
    take_transitions<Eigen::Dynamic>(stepper, group, team, chain);
}

/// Fills in the Jacobians at the chain's states; returns f there.
RowMajor jacobians_and_field(const systems::System& system, Chain& chain) {
  const Eigen::Index d = chain.dimension();
  const Eigen::Index count = chain.states.cols();
  const RowMajor z = chain.states;
  RowMajor f(d, count);
  RowMajor a(d * d, count);
  system.field_jacobian(static_cast<std::size_t>(count), z.data(), f.data(), a.data());
  chain.jacobians.resize(d * d, count);
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index l = 0; l < d; ++l) chain.jacobians.row(l * d + i) = a.row(i * d + l);
  return f;
}

}  // namespace

int allowed_segments(double at_least, int multiple) {
  for (int n = 2;; ++n) {
    int leading = n;
    while (leading > 15 && leading % 2 == 0) leading /= 2;
    if (leading <= 15 && leading != 11 && leading != 13 && multiple * n >= at_least) return multiple * n;
  }
}

// A pulse repeats after half a turn and is even there: a quarter of them is enough, since
// sines and arctangents cost as much as what is integrated with them.
Eigen::VectorXd steps_of(const loop::Loop& loop, int segments, int around) {
  if (loop.time_map.is_identity()) return Eigen::VectorXd::Constant(segments, loop.period / around);
  const bool by_quarters = loop.time_map.coefficients.empty() && around % 4 == 0;
  const int half = around / 2;
  const int own = by_quarters ? std::min(segments, around / 4) : segments;
  std::vector<double> s;
  for (int m = 0; m <= own; ++m) s.push_back(2 * std::numbers::pi * static_cast<double>(m) / around);
  const std::vector<double> phases = loop.time_map.phases(s);
  const double rate = loop.period / (2 * std::numbers::pi);
  Eigen::VectorXd steps(segments);
  for (int m = 0; m < own; ++m)
    steps[m] = rate * (phases[static_cast<std::size_t>(m) + 1] - phases[static_cast<std::size_t>(m)]);
  for (int m = own; m < segments; ++m) steps[m] = m < half ? steps[half - 1 - m] : steps[m - half];
  return steps;
}

void require_finite_rates(double value) {
  if (!std::isfinite(value))
    throw core::NotFiniteError(
        "Floquet multipliers: the field's Jacobian is not finite on the orbit; expected finite "
        "derivatives at every state of an accepted orbit");
}

void require_finite_field(double value) {
  if (!std::isfinite(value))
    throw core::NotFiniteError(
        "Floquet multipliers: the field is not finite on the orbit; expected finite values at every state of an "
        "accepted orbit");
}

void evaluate_jacobians(const systems::System& system, Chain& chain) {
  static_cast<void>(jacobians_and_field(system, chain));
}

void evaluate_field(const systems::System& system, Chain& chain) {
  chain.fields = jacobians_and_field(system, chain);
  evaluate_gradients(system, chain);
}

void evaluate_gradients(const systems::System& system, Chain& chain) {
  if (!system.structure().conservative()) return;
  const RowMajor z = chain.states;
  RowMajor gradients(z.rows(), z.cols());
  system.conserved_gradients(0, static_cast<std::size_t>(z.cols()), z.data(), gradients.data());
  chain.gradients = gradients;
}

Chain make_chain(const systems::System& system, VariationalStep& stepper, const loop::Loop& loop,
                 const FundamentalGroup& group, int at_least, core::Team* team) {
  const double resolution = std::max<double>(at_least, segments_a_harmonic * loop.cutoff);
  const int multiple = 2 * std::lcm(12, group.grid_factor);
  const int around = allowed_segments(resolution, multiple);
  Chain chain = nodes_of(system, loop, group, around);
  const double sum = group.order * (loop.dimension == 4 ? sum_of_rates<4>(chain) : sum_of_rates<Eigen::Dynamic>(chain));
  const double wanted = around * std::pow(sum / largest_sum, 1.0 / power_of_segments);
  require_finite_rates(wanted);
  const int finer = allowed_segments(wanted, multiple);
  if (finer > around) chain = nodes_of(system, loop, group, finer);
  take_transitions(stepper, group, team, chain);
  return chain;
}

}  // namespace orbweaver::spectrum
