#include "orbweaver/spectrum/floquet.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "floquet_chain.hpp"
#include "floquet_group.hpp"
#include "floquet_indices.hpp"
#include "hermite_chain.hpp"
#include "matrix_table.hpp"
#include "orbit_correction.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/numerics/quad.hpp"
#include "orbweaver/numerics/random.hpp"
#include "orbweaver/spectrum/log_volume.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "rotations.hpp"
#include "transverse_flow.hpp"
#include "transverse_turns.hpp"

namespace orbweaver::spectrum {

namespace {

using Complex = std::complex<double>;
using Values = std::vector<Complex>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// The Newton step that stands for the orbit's own error is itself uncertain.
constexpr double orbit_safety = 3.0;
/// Roundings of one step's arithmetic on a factor of size 1. Not measured; added to a bound.
constexpr double step_roundings = 8.0;
/// Segments are refined by the ratio of errors to the power 1/8, the order of the steps, with some room, and at most
/// doubled: an estimate that is dominated by something else would ask for ever more.
constexpr double room = 1.1;
constexpr double most_finer = 2.0;
constexpr double order_of_steps = 8.0;
/// Long segments' estimates are of the error itself, which those of short ones exceed a hundredfold.
constexpr double share_of_tolerance = 0.2;
constexpr double order_of_long_steps = 16.0;
/// A long segment is as exact as two to three short ones.
constexpr int short_segments_a_long_one = 3;
/// Truncation that is estimated as this share of rounding's bound, or less, is fine enough: between large indices one
/// near 0 has errors that no segments make small.
constexpr double share_of_rounding = 0.1;
/// From so many coordinates on products of matrices are most of the cost, of which long segments need more, and a team
/// divides short ones.
constexpr int many_coordinates = 8;
/// Largest tail of a loop (loop::tail), in parts of its amplitude, for long segments. They follow the loop itself, so
/// that the index has an error of first order in what the loop lacks, and their response to it, known to some percent,
/// is no bound where it happens to vanish.
constexpr double largest_tail = 1e-10;

/// Distance from each value to the nearest of `others`, times a factor, added to `errors`.
void add_distances(const Values& values, const Values& others, double factor, std::vector<double>& errors) {
  for (std::size_t n = 0; n < values.size(); ++n) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Complex& other : others) nearest = std::min(nearest, std::abs(values[n] - other));
    errors[n] += factor * nearest;
  }
}

void add_distances(const FloquetIndices& indices, const FloquetIndices& others, double factor, Stability& stability) {
  add_distances(indices.full, others.full, factor, stability.full_error);
  add_distances(indices.fundamental, others.fundamental, factor, stability.fundamental_error);
}

/// Below this size of a state the rounding of f is measured: it may be of the state's size, as f is about an
/// equilibrium at 0, or of that of constants which cancel. Above, what constants leave is at most 1e3 roundings.
constexpr double near_zero = 1e-3;
/// Of the error measured at one state, which may happen to be small: the largest of the others is some three times as
/// large.
constexpr double measured_safety = 4.0;

/// |f - f(z)| at the chain's state m, f(z) being computed in quadruple precision.
double field_error(const systems::QuadSystem& system, const Chain& chain, Eigen::Index m) {
  numerics::QuadVector f(chain.dimension());
  numerics::QuadMatrix jacobian(chain.dimension(), chain.dimension());
  system.linearize(chain.states.col(m).cast<numerics::Quad>(), f, jacobian);
  return (chain.fields.col(m).cast<numerics::Quad>() - f).norm().convert_to<double>();
}

/// Relative rounding error of each factor: the step's arithmetic, and the direction of f where the orbit is slow.
Eigen::VectorXd roundings_of(const systems::System& system, const Chain& chain) {
  const auto* quad = dynamic_cast<const systems::QuadSystem*>(&system);
  Eigen::VectorXd out(chain.segments());
  for (Eigen::Index m = 0; m < chain.segments(); ++m) {
    const double rate = chain.jacobians.col(m).norm();
    const double size = chain.states.col(m).norm();
    double terms = rate * (1.0 + size);
    if (quad != nullptr && size < near_zero)
      terms = std::min(terms, rate * size + measured_safety / epsilon * field_error(*quad, chain, m));
    out(m) = epsilon * (step_roundings + std::min(1.0, chain.steps[m] * rate) * terms / chain.fields.col(m).norm());
  }
  return out;
}

/// Frobenius norm of entries whose squares may be beyond range.
template <class Matrix>
double norm_of(const Matrix& matrix) {
  constexpr double squared_in_range = 1e150;
  const double largest = matrix.cwiseAbs().maxCoeff();
  return largest < squared_in_range ? matrix.norm() : largest * (matrix / largest).norm();
}

struct TraceError {
  double estimate = 0.0;  ///< of truncation, by the estimates of the factors' errors as they are
  double truncation = 0.0;
  double rounding = 0.0;
};

/// What the factors' errors do to the trace of their product, for 2 x 2 matrices: bounds, but for `estimate`. An
/// estimate says how large a factor's entries' errors are, not of which sign: on circles, whose segments are all alike,
/// the trace with the estimates is up to 32 times too small.
TraceError error_of_trace(const Eigen::VectorXd& roundings, const TransverseFlow& flow, double truncation_share) {
  const Eigen::Index n = flow.factors.cols();
  Eigen::MatrixXd after(4, n);  // products of the factors behind each one
  matrix_in<2>(after, n - 1, 2).setIdentity();
  for (Eigen::Index m = n - 1; m-- > 0;)
    matrix_in<2>(after, m, 2).noalias() = matrix_in<2>(after, m + 1, 2) * matrix_in<2>(flow.factors, m + 1, 2);
  Eigen::Matrix2d before = Eigen::Matrix2d::Identity();
  TraceError error;
  for (Eigen::Index m = 0; m < n; ++m) {
    const Eigen::Matrix2d others = before * matrix_in<2>(after, m, 2);
    const auto estimated = matrix_in<2>(flow.errors, m, 2);
    error.estimate += truncation_share * std::abs((others * estimated).trace());
    error.truncation += truncation_share * (others.cwiseAbs() * estimated.cwiseAbs()).trace();
    error.rounding += roundings(m) * flow.factors.col(m).norm() * norm_of(others);
    before = (matrix_in<2>(flow.factors, m, 2) * before).eval();
    error.rounding += epsilon * norm_of(before) * norm_of(after.col(m));
  }
  return error;
}

/// The indices as numbers, and back into indices of the same sizes.
Eigen::VectorXd numbers_of(const FloquetIndices& indices) {
  Eigen::VectorXcd all(static_cast<Eigen::Index>(indices.full.size() + indices.fundamental.size()));
  std::copy(indices.fundamental.begin(), indices.fundamental.end(),
            std::copy(indices.full.begin(), indices.full.end(), all.data()));
  return Eigen::Map<const Eigen::VectorXd>(reinterpret_cast<const double*>(all.data()), 2 * all.size());
}

FloquetIndices indices_of(const Eigen::VectorXd& numbers, FloquetIndices sizes) {
  const auto* at = reinterpret_cast<const Complex*>(numbers.data());
  for (Values* values : {&sizes.full, &sizes.fundamental})
    for (Complex& value : *values) value = *at++;
  return sizes;
}

/// Where there is no trace to read: the responses to six sets of such errors, `change(m, random)` being that of factor
/// m, are added. Two sets have the same random numbers at every factor: equal segments make equal errors, which add up
/// over the loop, where independent ones grow with the root of their number only. They are enlarged sixteenfold and the
/// response divided by four, which covers an eigenvalue about to split, whose response grows with the root only.
template <class Change>
void add_probes(const systems::Structure& system, const TransverseFlow& flow, int order, const FloquetIndices& indices,
                const Change& change, core::Team* team, Stability& stability) {
  constexpr int probes = 6;
  constexpr int repeated = 2;
  constexpr double enlarged = 16.0;
  constexpr double divided = 0.25;
  constexpr std::uint64_t first_seed = 12345;
  Eigen::MatrixXd answers(2 * (indices.full.size() + indices.fundamental.size()), probes);
  const auto ask = [&](int begin, int end) {
    for (int probe = begin; probe < end; ++probe) {
      const auto seed = first_seed + static_cast<std::uint64_t>(probe);
      numerics::Random random(seed);
      TransverseFlow changed = flow;
      for (Eigen::Index m = 0; m < flow.factors.cols(); ++m) {
        if (probe < repeated) random = numerics::Random(seed);
        changed.factors.col(m) += enlarged * change(m, random);
      }
      answers.col(probe) = numbers_of(floquet_indices(system, changed, order));
    }
  };
  if (team != nullptr)
    team->divide("Floquet probes", probes, static_cast<int>(answers.rows()), answers.data(), ask);
  else
    ask(0, probes);
  for (int probe = 0; probe < probes; ++probe)
    add_distances(indices, indices_of(answers.col(probe), indices), divided, stability);
}

/// Bounds what the chain's truncation errors do to the indices; returns the rounding's share if it comes with it.
TraceError add_truncation(const systems::System& of, const Chain& chain, const TransverseFlow& flow, int order,
                          const FloquetIndices& indices, core::Team* team, Stability& stability) {
  const systems::Structure& system = of.structure();
  if (is_single_pair(system, flow)) {
    const TraceError error = error_of_trace(roundings_of(of, chain), flow, chain.truncation_share);
    stability.fundamental_error[0] += error.truncation;
    return error;
  }
  const auto change = [&](Eigen::Index m, auto& random) -> Eigen::VectorXd {
    return std::copysign(chain.truncation_share, random()) * flow.errors.col(m);
  };
  add_probes(system, flow, order, indices, change, team, stability);
  return {};
}

void add_rounding_probes(const systems::System& system, const Chain& chain, const TransverseFlow& flow, int order,
                         const FloquetIndices& indices, core::Team* team, Stability& stability) {
  const Eigen::VectorXd roundings = roundings_of(system, chain);
  const auto change = [&](Eigen::Index m, auto& random) {
    const double scale = roundings(m) * flow.factors.col(m).norm();
    Eigen::VectorXd changes(flow.factors.rows());
    for (double& entry : changes) entry = scale * random();
    return changes;
  };
  add_probes(system.structure(), flow, order, indices, change, team, stability);
}

bool moves(const loop::Loop& loop) {
  const auto nonzero = [](double v) { return v != 0.0; };
  return std::any_of(loop.modes.begin() + loop.dimension, loop.modes.end(), nonzero) ||
         std::any_of(loop.winding.begin(), loop.winding.end(), nonzero);
}

bool is_finite(const Complex& value) { return std::isfinite(value.real()) && std::isfinite(value.imag()); }

void require_one_in_range(const Values& values, const loop::Loop& loop) {
  if (std::none_of(values.begin(), values.end(), is_finite))
    throw core::NotFiniteError(
        fmt::format("Floquet multipliers of a loop of period {} with cutoff {}: expected finite "
                    "values, got {} + {}i; they lie beyond double precision's range",
                    loop.period, loop.cutoff, values.front().real(), values.front().imag()));
}

/// What is beyond double precision's range is not a number, nor is its error.
void mark_beyond_range(Values& values, std::vector<double>& errors) {
  for (std::size_t n = 0; n < values.size(); ++n)
    if (!is_finite(values[n])) values[n] = errors[n] = std::numeric_limits<double>::quiet_NaN();
}

double largest_relative(const Values& values, const std::vector<double>& errors) {
  double largest = 0.0;
  for (std::size_t n = 0; n < values.size(); ++n) largest = std::max(largest, errors[n] / (1.0 + std::abs(values[n])));
  return largest;
}

Stability without_errors(const FloquetIndices& indices, int order) {
  Stability stability;
  stability.full = indices.full;
  stability.fundamental = indices.fundamental;
  stability.fundamental_order = order;
  stability.twist = indices.twist;
  stability.full_error.assign(indices.full.size(), 0.0);
  stability.fundamental_error.assign(indices.fundamental.size(), 0.0);
  return stability;
}

/// The indices with their truncation error as far as known, and what they were computed from.
struct Integrated {
  std::unique_ptr<HermiteChain> segments;  ///< none: short ones
  Chain chain;
  TransverseFlow flow;
  FloquetIndices indices;
  TraceError trace;
  Stability stability;

  /// From the chain on; returns the estimate of the relative truncation error.
  double evaluate(const systems::System& system, const loop::Loop& loop, const FundamentalGroup& group,
                  core::Team* team) {
    const systems::Structure& structure = system.structure();
    flow = transverse_flow(system, chain, group, team);
    indices = floquet_indices(structure, flow, group.order);
    require_one_in_range(indices.fundamental, loop);
    stability = without_errors(indices, group.order);
    trace = add_truncation(system, chain, flow, group.order, indices, team, stability);
    return is_single_pair(structure, flow) ? trace.estimate / (1.0 + std::abs(indices.fundamental[0]))
                                           : largest_relative(stability.fundamental, stability.fundamental_error);
  }

  /// Of a single pair.
  [[nodiscard]] bool is_left_to_rounding() const {
    return trace.rounding > 0.0 && trace.estimate <= share_of_rounding * trace.rounding;
  }
};

/// The values' response to the orbit's own error, on a scale where differences keep their digits.
void add_orbit_error(const systems::System& system, const Integrated& of, const FundamentalGroup& group,
                     core::Team* team, Stability& stability) {
  constexpr double visible = 1e-7;  // of a change of the states: far above rounding, and its square far below
  const OrbitCorrection correction = orbit_correction(of.chain, group, system.structure().conservative());
  const double size = std::max(correction.states.cwiseAbs().maxCoeff(), std::abs(correction.stretch));
  if (size == 0.0) return;
  const double factor = std::max(1.0, visible / size);
  const Chain changed = of.segments ? of.segments->corrected(system, correction, factor)
                                    : corrected(system, of.chain, correction, factor, team);
  const TransverseFlow flow = transverse_flow(system, changed, group, team);
  add_distances(of.indices, floquet_indices(system.structure(), flow, group.order), orbit_safety / factor, stability);
}

/// How many segments a period to take next where `estimated` is too large an error.
int finer_segments(const Chain& chain, int group_order, double estimated, double tolerance, double order_of_error) {
  const double finer = std::min(most_finer, room * std::pow(estimated / tolerance, 1.0 / order_of_error));
  return static_cast<int>(finer * static_cast<double>(chain.segments()) * group_order) + 1;
}

/// By long segments; nothing where they cannot be made fine enough.
std::optional<Integrated> integrated_by_long_segments(const systems::System& system, const loop::Loop& loop,
                                                      const FundamentalGroup& group, const FloquetOptions& options) {
  const double tolerance = share_of_tolerance * options.tolerance;
  Integrated result;
  int least = options.least_segments / short_segments_a_long_one;
  for (int refinement = 0; refinement <= options.refinements; ++refinement) {
    result.segments = std::make_unique<HermiteChain>(system, loop, group, least);
    result.chain = result.segments->chain();
    const double error = result.evaluate(system, loop, group, nullptr);
    if (error <= tolerance || result.is_left_to_rounding()) return result;
    least = finer_segments(result.chain, group.order, error, tolerance, order_of_long_steps);
  }
  return {};
}

Integrated integrated(const systems::System& system, const loop::Loop& loop, const FundamentalGroup& group,
                      const FloquetOptions& options, core::Team* team) {
  if (loop.dimension < many_coordinates && loop::tail(loop) <= largest_tail * loop::rms_amplitude(loop))
    if (std::optional<Integrated> result = integrated_by_long_segments(system, loop, group, options))
      return std::move(*result);
  VariationalStep stepper(system);
  Integrated result;
  int least = options.least_segments;
  for (int refinement = 0;; ++refinement) {
    result.chain = make_chain(system, stepper, loop, group, least, team);
    const double error = result.evaluate(system, loop, group, team);
    if (error <= options.tolerance || result.is_left_to_rounding() || refinement >= options.refinements) return result;
    least = finer_segments(result.chain, group.order, error, options.tolerance, order_of_steps);
  }
}

/// A single multiplier is all that volumes change by. Where the map leaves its bound larger than this, relative to 1 +
/// |mu|, and the logarithm of the volume is below this, which no error of the orbit makes 0, the volume tells it.
constexpr double told_by_map = 1e-6;
constexpr double surely_small = -30.0;

bool is_told_by_volume(const systems::Structure& system, int dimension, const FundamentalGroup& group) {
  return !system.symplectic && !system.conservative() && dimension == 2 && group.order == 1;
}

/// False where the multiplier is not that small.
bool tell_by_volume(const systems::System& system, const loop::Loop& loop, Stability& stability) {
  const double logarithm = log_volume(system, loop);
  if (!(logarithm < surely_small)) return false;
  const double multiplier = std::exp(logarithm);  // 0 where it is below double precision's range
  stability.full = stability.fundamental = {multiplier};
  stability.full_error = stability.fundamental_error = {multiplier};
  return true;
}

Stability by_map(const systems::System& system, const loop::Loop& loop, const FundamentalGroup& group,
                 const FloquetOptions& options) {
  const systems::Structure& structure = system.structure();
  core::Team* const team = core::worth_dividing(options.team, loop.dimension);
  const Integrated result = integrated(system, loop, group, options, team);
  const auto& [segments, chain, flow, indices, trace, known] = result;
  Stability stability = known;
  add_orbit_error(system, result, group, team, stability);
  if (is_single_pair(structure, flow)) {
    stability.fundamental_error[0] += trace.rounding;
    stability.full_error[0] =
        repeated_index_error(stability.fundamental[0].real(), stability.fundamental_error[0], group.order);
  } else {
    add_rounding_probes(system, chain, flow, group.order, indices, team, stability);
  }
  if (is_single_pair(structure, flow) && flow.bases.cols() > 0)
    stability.turns = transverse_turns(chain, flow, group, stability.fundamental[0].real(), stability.twist);
  if (structure.symplectic) stability.map = transverse_map(flow);
  if (structure.symplectic && std::isnan(stability.twist)) stability.rotations = rotations(system, chain, stability);
  mark_beyond_range(stability.full, stability.full_error);
  mark_beyond_range(stability.fundamental, stability.fundamental_error);
  if (structure.conservative() && !structure.symplectic) {
    stability.full.emplace_back(1.0);
    stability.full_error.push_back(0.0);
    stability.fundamental.emplace_back(1.0);
    stability.fundamental_error.push_back(0.0);
  }
  return stability;
}

}  // namespace

Stability floquet(const systems::System& family, const loop::Loop& loop, const loop::Isotropy& isotropy,
                  const FloquetOptions& options) {
  const core::LogStage stage(core::Stage::spectrum);
  const core::LogEvent event(core::Event::multipliers);
  loop::validate(loop);
  const std::shared_ptr<const systems::System> here = loop::system_at(family, loop);
  const systems::System& system = *here;
  core::require(loop.dimension == system.dimension(), "Floquet multipliers: the loop is not of the system's dimension");
  core::require(moves(loop), "Floquet multipliers need an orbit that moves; this loop is constant");
  const systems::Structure& structure = system.structure();
  core::require(structure.conserved.size() <= 1, "Floquet multipliers: those of one conserved quantity are taken out");
  const FundamentalGroup group = fundamental_group(system, loop, isotropy);
  if (loop.dimension == (structure.conservative() ? 2 : 1)) return without_errors({}, group.order);
  if (!is_told_by_volume(structure, loop.dimension, group)) return by_map(system, loop, group, options);
  Stability stability = without_errors({{0.0}, {0.0}}, group.order);
  try {
    stability = by_map(system, loop, group, options);
    const double error = stability.fundamental_error.front();
    if (!(error <= told_by_map * (1.0 + std::abs(stability.fundamental.front()))))
      (void)tell_by_volume(system, loop, stability);
  } catch (const core::NotFiniteError&) {
    if (!tell_by_volume(system, loop, stability)) throw;
  }
  return stability;
}

}  // namespace orbweaver::spectrum
