#include "hermite_chain.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "hermite_rule.hpp"
#include "lane_matrices.hpp"
#include "matrix_table.hpp"
#include "orbweaver/ad/lanes.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::spectrum {

namespace {

using ad::Lanes;
using numerics::two_pi;

constexpr std::size_t wide = Lanes::width;
constexpr std::size_t terms = HermiteRule::terms;
constexpr std::size_t reach = HermiteRule::reach;
constexpr std::size_t parts = HermiteRule::parts;
constexpr std::size_t levels = HermiteRule::levels;
constexpr std::size_t inner = parts - 1;
constexpr std::size_t guards = (reach + parts - 1) / parts;
constexpr double part = 1.0 / static_cast<double>(parts);

/// Segments a harmonic: leaves less than 1e-11 in the index of the double pendulum's orbits.
constexpr double long_segments_a_harmonic = 0.9;
/// Largest sum over segments of (h |A|)^8, as for shorter ones: none has h |A| above 1.6.
constexpr double largest_long_sum = 43.0;
constexpr double power_of_long_segments = 7.0;
/// Largest h |A| between points at which turns are counted, as in short segments.
constexpr double most_turned_between = 0.4;
/// Below the squares of all differences.
constexpr double below_squares = 1e-300;

Lanes magnitude(Lanes x) { return Lanes(x.packed < 0.0 ? -x.packed : x.packed); }

std::unique_ptr<double[]> numbers(std::size_t count) { return std::make_unique_for_overwrite<double[]>(count); }

/// Columns first, first + 1, ... of a row.
Lanes lanes_of(const Eigen::MatrixXd& table, Eigen::Index row, std::size_t first) {
  Lanes out;
  for (std::size_t l = 0; l < wide; ++l)
    out.packed[l] = table(row, std::min(static_cast<Eigen::Index>(first + l), table.cols() - 1));
  return out;
}

/// 2 pi phi'(s) at equidistant nodes. Those of a pulse repeat after half a turn and are even.
std::vector<double> densities_of(const loop::TimeMap& map, int nodes) {
  if (!map.coefficients.empty() || map.is_identity() || nodes % 4 != 0) return loop::densities(map, nodes);
  std::vector<double> out(static_cast<std::size_t>(nodes));
  const int half = nodes / 2;
  for (int j = 0; j <= nodes / 4; ++j) {
    const double density = map.density(two_pi * j / nodes);
    for (const int at : {j, half - j, half + j, (nodes - j) % nodes}) out[static_cast<std::size_t>(at)] = density;
  }
  return out;
}

}  // namespace

HermiteChain::HermiteChain(const systems::System& system, const loop::Loop& loop, const FundamentalGroup& group,
                           int at_least)
    : _dimension(static_cast<std::size_t>(loop.dimension)) {
  const double resolution = std::max<double>(at_least, long_segments_a_harmonic * loop.cutoff);
  const int multiple = std::lcm(4, group.order);
  const int around = allowed_segments(resolution, multiple);
  sample(system, loop, group.order, around);
  const int finer = allowed_segments(_wanted, multiple);
  if (finer > around) sample(system, loop, group.order, finer);
  if (_dimension == 4)
    solve<4>();
  else
    solve<0>();
  if (_dimension == 4 && system.structure().conservative()) take_inner(system);
}

void HermiteChain::sample(const systems::System& system, const loop::Loop& loop, int order, int around) {
  const std::size_t d = _dimension;
  const int grid = around * static_cast<int>(parts);
  const int skipped = 2 * loop.cutoff / grid + 1;
  const int fine = grid * skipped;
  const auto fine_size = static_cast<std::size_t>(fine);
  const Numbers nodal = numbers(d * fine_size);
  const Numbers slopes = numbers(d * fine_size);
  const loop::FourierGrid& fourier = loop::FourierGrid::of_size(fine);
  fourier.synthesize(loop.cutoff, loop.dimension, loop.modes.data(), nodal.get());
  fourier.synthesize_derivative(loop.cutoff, loop.dimension, loop.modes.data(), slopes.get());
  const std::vector<double> densities = densities_of(loop.time_map, grid);

  _segments = static_cast<std::size_t>(around / order);
  const std::size_t columns = _segments + 1 + 2 * guards;
  _stride = (columns + wide - 1) / wide * wide + wide;
  _points = parts * _stride;
  _states = numbers(d * _points);
  _fields = numbers(d * _points);
  _jacobians = numbers(d * d * _points);
  _rates = numbers(_points);
  _residuals = numbers(d * _points);
  const double step = two_pi / around;
  const double rate = loop.period / around;
  std::vector<std::size_t> nodes(_stride);
  for (std::size_t c = 0; c < parts; ++c) {
    for (std::size_t m = 0; m < _stride; ++m) {
      const int j = static_cast<int>(std::min(m, columns - 1) * parts + c) - static_cast<int>(guards * parts);
      nodes[m] = static_cast<std::size_t>(((j % grid) + grid) % grid);
      _rates[c * _stride + m] = rate * densities[nodes[m]];
    }
    for (std::size_t i = 0; i < d; ++i) {
      const double turning = loop.winding[i];
      const double* z = &nodal[i * fine_size];
      const double* slope = &slopes[i * fine_size];
      double* state = &_states[i * _points + c * _stride];
      double* residual = &_residuals[i * _points + c * _stride];
      for (std::size_t m = 0; m < _stride; ++m) {
        state[m] = z[nodes[m] * static_cast<std::size_t>(skipped)];
        residual[m] = step * (slope[nodes[m] * static_cast<std::size_t>(skipped)] + turning);
      }
      if (turning == 0.0) continue;
      const double first = static_cast<double>(c) * part - static_cast<double>(guards);
      for (std::size_t m = 0; m < _stride; ++m)
        state[m] += turning * step * (first + static_cast<double>(std::min(m, columns - 1)));
    }
  }
  system.field_jacobian(_points, _states.get(), _fields.get(), _jacobians.get());
  _chain = {};
  _chain.steps = steps_of(loop, static_cast<int>(_segments), around);
  _chain.truncation_share = 1.0;
  take_nodes(system, _states.get(), _fields.get(), _jacobians.get(), _chain);
  Lanes sum = 0.0;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t n = 0; n < _points; n += wide) {
      const Lanes residual =
          Lanes::load(&_residuals[i * _points + n]) - Lanes::load(&_rates[n]) * Lanes::load(&_fields[i * _points + n]);
      residual.store(&_residuals[i * _points + n]);
      sum += residual;
    }
  for (std::size_t l = 0; l < wide; ++l) require_finite_field(sum.packed[l]);
  for (std::size_t entry = 0; entry < d * d; ++entry)
    for (std::size_t n = 0; n < _points; n += wide)
      (Lanes::load(&_rates[n]) * Lanes::load(&_jacobians[entry * _points + n]))
          .store(&_jacobians[entry * _points + n]);
  _vanishes.assign(d * d, 1);
  for (std::size_t entry = 0; entry < d * d; ++entry) {
    const double* all = &_jacobians[entry * _points];
    _vanishes[entry] = std::all_of(all, all + _points, [](double value) { return value == 0.0; });
  }
  if (_dimension == 4)
    take_rates<4>(order, around);
  else
    take_rates<0>(order, around);
}

/// What turns are counted at: as many points within segments as their rates ask for.
void HermiteChain::take_inner(const systems::System& system) {
  if (_largest_rate <= most_turned_between) return;
  const std::size_t stride = _largest_rate <= 2.0 * most_turned_between ? 2 : 1;
  const std::size_t count = parts / stride - 1;
  const std::size_t nodes = count * _segments;
  const Numbers states = numbers(4 * nodes);
  const Numbers gradients = numbers(4 * nodes);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t n = 0; n < count; ++n)
      std::copy_n(&_states[i * _points + (n + 1) * stride * _stride + guards], _segments,
                  &states[i * nodes + n * _segments]);
  system.conserved_gradients(0, nodes, states.get(), gradients.get());
  const auto columns = static_cast<Eigen::Index>(nodes);
  _chain.inner_fields.resize(4, columns);
  _chain.inner_gradients.resize(4, columns);
  _chain.inner_transitions.resize(16, columns);
  for (std::size_t m = 0; m < _segments; ++m)
    for (std::size_t n = 0; n < count; ++n) {
      const auto column = static_cast<Eigen::Index>(m * count + n);
      const std::size_t c = (n + 1) * stride;
      for (std::size_t i = 0; i < 4; ++i) {
        _chain.inner_fields.col(column).data()[i] = _fields[i * _points + c * _stride + guards + m];
        _chain.inner_gradients.col(column).data()[i] = gradients[i * nodes + n * _segments + m];
        for (std::size_t l = 0; l < 4; ++l)
          _chain.inner_transitions.col(column).data()[l * 4 + i] =
              _flows[((m / wide * inner + c - 1) * 16 + i * 4 + l) * wide + m % wide];
      }
    }
}

void HermiteChain::take_nodes(const systems::System& system, const double* states, const double* fields,
                              const double* jacobians, Chain& chain) const {
  const auto d = static_cast<Eigen::Index>(_dimension);
  const auto nodes = static_cast<Eigen::Index>(_segments) + 1;
  const auto points = static_cast<Eigen::Index>(_points);
  using Rows = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
                          Eigen::OuterStride<>>;
  chain.states = Rows(states + guards, d, nodes, Eigen::OuterStride<>(points));
  chain.fields = Rows(fields + guards, d, nodes, Eigen::OuterStride<>(points));
  chain.jacobians.resize(d * d, nodes);
  const Rows all(jacobians + guards, d * d, nodes, Eigen::OuterStride<>(points));
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index l = 0; l < d; ++l) chain.jacobians.row(l * d + i) = all.row(i * d + l);
  evaluate_gradients(system, chain);
}

template <std::size_t D>
void HermiteChain::take_rates(int order, int around) {
  const LaneMatrices<D> of(_dimension);
  const std::size_t dd = of.size();
  std::vector<Lanes> storage(3 * dd);
  Lanes* a = storage.data();
  double sum = 0.0;
  double largest = 0.0;
  for (std::size_t first = 0; first < _segments; first += wide) {
    for (std::size_t n = 0; n < dd; ++n) a[n] = Lanes::load(&_jacobians[n * _points + guards + first]);
    of.multiply(a, a, a + dd);
    of.multiply(a + dd, a + dd, a + 2 * dd);
    Lanes square = 0.0;
    for (std::size_t n = 2 * dd; n < 3 * dd; ++n) square += a[n] * a[n];
    for (std::size_t l = 0; l < wide && first + l < _segments; ++l) {
      sum += square.packed[l];
      largest = std::max(largest, square.packed[l]);
    }
  }
  _wanted = around * std::pow(order * sum / largest_long_sum, 1.0 / power_of_long_segments);
  require_finite_rates(_wanted);
  _largest_rate = std::pow(largest, 1.0 / 8.0);
}

/// The loop is off the orbit by e, de/ds = t' A e - r. Trapezoidal sums of r miss much of the fastest waves, those of
/// the harmonics that the loop lacks, which differences between neighbours tell: e is these and the solution for what
/// they leave of r.
template <std::size_t D>
void HermiteChain::split_residuals() {
  const HermiteRule& rule = hermite_rule();
  const LaneMatrices<D> of(_dimension);
  const std::size_t d = of.dimension();
  const std::size_t dd = of.size();
  _fast = numbers(d * _points);
  std::vector<Lanes> storage(dd + 2 * d);
  Lanes* a = storage.data();
  Lanes* fast = a + dd;
  Lanes* driven = fast + d;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t c = 0; c < parts; ++c)
      for (std::size_t first = guards; first <= guards + _segments; first += wide) {
        const double* residuals = &_residuals[i * _points];
        Lanes sum = 0.0;
        for (std::size_t k = 1; k <= HermiteRule::fast_reach; ++k) {
          const std::size_t back = (k + parts - 1 - c) / parts;
          const Lanes plus = Lanes::load(residuals + (c + k) % parts * _stride + first + (c + k) / parts);
          const Lanes minus = Lanes::load(residuals + (c + back * parts - k) * _stride + first - back);
          sum += rule.fast[k - 1] * (plus - minus);
        }
        (-part * sum).store(&_fast[i * _points + c * _stride + first]);
      }
  for (std::size_t c = 0; c < parts; ++c)
    for (std::size_t first = guards; first <= guards + _segments; first += wide) {
      const std::size_t at = c * _stride + first;
      for (std::size_t n = 0; n < dd; ++n) a[n] = Lanes::load(&_jacobians[n * _points + at]);
      for (std::size_t i = 0; i < d; ++i) fast[i] = Lanes::load(&_fast[i * _points + at]);
      of.apply(a, fast, driven);
      for (std::size_t i = 0; i < d; ++i)
        (Lanes::load(&_residuals[i * _points + at]) - driven[i]).store(&_residuals[i * _points + at]);
    }
}

/// The sides of the equation for the steps that end and begin at nodes first, first + 1, ..., and the flow within the
/// segments behind them.
template <std::size_t D>
void HermiteChain::take_node(std::size_t first, double* ends) {
  const HermiteRule& rule = hermite_rule();
  const LaneMatrices<D> of(_dimension);
  const std::size_t d = of.dimension();
  const std::size_t dd = of.size();
  thread_local std::vector<Lanes> storage;
  storage.resize((2 * terms + 4) * dd);
  Lanes* a = storage.data();      // Taylor coefficients of t' A
  Lanes* y = a + terms * dd;      // and of Y
  Lanes* flow = y + (terms + 1) * dd;
  double* change = ends + 2 * levels * dd * wide;
  for (std::size_t n = 0; n < dd; ++n) {
    if (_vanishes[n]) {
      for (std::size_t j = 0; j < terms; ++j) a[j * dd + n] = 0.0;
      Lanes(0.0).store(change + n * wide);
      continue;
    }
    const double* entry = &_jacobians[n * _points + guards + first];
    const Lanes centre = Lanes::load(entry);
    Lanes coefficients[terms];
    for (std::size_t j = 0; j < terms; ++j) coefficients[j] = j % 2 == 0 ? centre * rule.stencil[j][0] : Lanes(0.0);
    Lanes even_change = centre * rule.even_change[0];
    Lanes odd_change = 0.0;
#pragma GCC unroll 16
    for (std::size_t k = 1; k <= reach; ++k) {
      const std::size_t back = (k + parts - 1) / parts;
      const Lanes plus = Lanes::load(entry + (k % parts) * _stride + k / parts);
      const Lanes minus = Lanes::load(entry + (back * parts - k) * _stride - back);
      const Lanes even = plus + minus;
      const Lanes odd = plus - minus;
      even_change += even * rule.even_change[k];
      odd_change += odd * rule.odd_change[k];
      for (std::size_t j = 0; j < terms; ++j) coefficients[j] += (j % 2 == 0 ? even : odd) * rule.stencil[j][k];
    }
    for (std::size_t j = 0; j < terms; ++j) a[j * dd + n] = coefficients[j];
    (magnitude(even_change) + magnitude(odd_change)).store(change + n * wide);
  }
  of.set_identity(y);
  constexpr std::size_t together = D == 0 ? 1 : D;  // entries of a row
  for (std::size_t k = 0; k < terms; ++k) {
    const double share = 1.0 / static_cast<double>(k + 1);
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t l = 0; l < d; l += together) {
        Lanes sums[together];
        for (std::size_t n = 0; n < together; ++n) sums[n] = a[k * dd + i * d + l + n];
        for (std::size_t m = 0; m < d; ++m) {
          if (_vanishes[i * d + m]) continue;
          for (std::size_t j = 0; j < k; ++j) {
            const Lanes factor = a[j * dd + i * d + m];
            const Lanes* from = y + (k - j) * dd + m * d + l;
            for (std::size_t n = 0; n < together; ++n) sums[n] += factor * from[n];
          }
        }
        for (std::size_t n = 0; n < together; ++n) y[(k + 1) * dd + i * d + l + n] = share * sums[n];
      }
  }
  for (std::size_t level = 0; level < levels; ++level)
    for (std::size_t n = 0; n < dd; ++n) {
      Lanes even = y[n];
      Lanes odd = y[dd + n] * rule.ends[level][1];
      for (std::size_t k = 2; k <= terms - level; ++k)
        (k % 2 == 0 ? even : odd) += y[k * dd + n] * rule.ends[level][k];
      (even + odd).store(ends + (2 * level * dd + n) * wide);
      (even - odd).store(ends + ((2 * level + 1) * dd + n) * wide);
    }
  if (first >= _segments) return;
  for (std::size_t c = 0; c < inner; ++c) {
    const double time = part * static_cast<double>(c + 1);
    for (std::size_t n = 0; n < dd; ++n) {
      Lanes sum = y[terms * dd + n];
      for (std::size_t k = terms; k-- > 0;) sum = sum * time + y[k * dd + n];
      flow[n] = sum;
      sum.store(&_flows[((first / wide * inner + c) * dd + n) * wide]);
    }
    of.invert(flow);
    for (std::size_t n = 0; n < dd; ++n) flow[n].store(&_inverses[((first / wide * inner + c) * dd + n) * wide]);
  }
}

/// Transition matrices of segments first, first + 1, ... and the errors of their entries.
template <std::size_t D>
void HermiteChain::take_segments(std::size_t first, const double* ends) {
  const LaneMatrices<D> of(_dimension);
  const std::size_t d = of.dimension();
  const std::size_t dd = of.size();
  const std::size_t size = (2 * levels + 1) * dd * wide;  // of four nodes
  const double* here = ends + first / wide * size;
  const auto next = [&](std::size_t n) {  // of the nodes one further
    Lanes out;
    for (std::size_t l = 0; l + 1 < wide; ++l) out.packed[l] = here[n * wide + l + 1];
    out.packed[wide - 1] = here[size + n * wide];
    return out;
  };
  thread_local std::vector<Lanes> storage;
  storage.resize((levels + 4) * dd);
  Lanes* result = storage.data();
  Lanes* begin = result + levels * dd;
  Lanes* end = begin + dd;
  Lanes* change = end + dd;
  for (std::size_t level = 0; level < levels; ++level) {
    for (std::size_t n = 0; n < dd; ++n) {
      begin[n] = Lanes::load(here + (2 * level * dd + n) * wide);
      end[n] = next((2 * level + 1) * dd + n);
    }
    of.invert(end);
    of.multiply(end, begin, result + level * dd);
  }
  Lanes* last = result + dd;  // difference to the next order, and of that to the one before
  Lanes* before = last + dd;
  for (std::size_t n = 0; n < dd; ++n) {
    before[n] = last[n] - before[n];
    last[n] = result[n] - last[n];
    begin[n] = magnitude(result[n]);
    change[n] = Lanes::load(here + (2 * levels * dd + n) * wide) + next(2 * levels * dd + n);
  }
  of.multiply(change, begin, end);
  // Sizes that do not depend on the units of the coordinates.
  Lanes last_square = below_squares;
  Lanes before_square = below_squares;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t l = 0; l < d; ++l) {
      last_square += magnitude(last[i * d + l] * last[l * d + i]);
      before_square += magnitude(before[i * d + l] * before[l * d + i]);
    }
  Lanes ratio = sqrt(last_square / before_square);
  ratio.packed = ratio.packed < 1.0 ? ratio.packed : Lanes(1.0).packed;
  for (std::size_t l = 0; l < wide && first + l < _segments; ++l) {
    const auto column = static_cast<Eigen::Index>(first + l);
    double* transition = _chain.transitions.col(column).data();
    double* truncation = _chain.truncations.col(column).data();
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t n = 0; n < d; ++n) {
        transition[n * d + i] = result[i * d + n].packed[l];
        truncation[n * d + i] =
            ratio.packed[l] * std::abs(last[i * d + n].packed[l]) + end[i * d + n].packed[l];
      }
  }
}

/// What the loop's residuals add up to along segments first, first + 1, ..., by the trapezoidal rule, which for the
/// whole of a periodic loop is exact.
template <std::size_t D>
void HermiteChain::take_drifts(std::size_t first) {
  const LaneMatrices<D> of(_dimension);
  const std::size_t d = of.dimension();
  const std::size_t dd = of.size();
  thread_local std::vector<Lanes> storage;
  storage.resize(dd + 4 * d);
  Lanes* matrix = storage.data();
  Lanes* residual = matrix + dd;
  Lanes* sum = residual + d;
  Lanes* before = sum + d;
  Lanes* carried = before + d;
  for (std::size_t i = 0; i < d; ++i) {
    sum[i] = 0.0;
    before[i] = Lanes::load(&_residuals[i * _points + guards + first]);
  }
  for (std::size_t c = 0; c < inner; ++c) {
    const double* inverse = &_inverses[(first / wide * inner + c) * dd * wide];
    for (std::size_t n = 0; n < dd; ++n) matrix[n] = Lanes::load(inverse + n * wide);
    for (std::size_t i = 0; i < d; ++i)
      residual[i] = Lanes::load(&_residuals[i * _points + (c + 1) * _stride + guards + first]);
    of.apply(matrix, residual, carried);
    for (std::size_t i = 0; i < d; ++i) {
      sum[i] += (0.5 * part) * (before[i] + carried[i]);
      before[i] = carried[i];
      sum[i].store(&_drifts[((first / wide * inner + c) * d + i) * wide]);
    }
  }
  for (std::size_t n = 0; n < dd; ++n)
    matrix[n] = lanes_of(_chain.transitions, static_cast<Eigen::Index>(n % d * d + n / d), first);
  for (std::size_t i = 0; i < d; ++i) sum[i] += (0.5 * part) * before[i];
  of.apply(matrix, sum, carried);
  for (std::size_t i = 0; i < d; ++i) {
    const Lanes end = Lanes::load(&_residuals[i * _points + guards + first + 1]);
    const Lanes gap = -(carried[i] + (0.5 * part) * end);
    for (std::size_t l = 0; l < wide && first + l < _segments; ++l)
      _chain.defects(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(first + l)) = gap.packed[l];
  }
}

template <std::size_t D>
void HermiteChain::solve() {
  const LaneMatrices<D> of(_dimension);
  const std::size_t d = of.dimension();
  const std::size_t dd = of.size();
  const auto segments = static_cast<Eigen::Index>(_segments);
  const std::size_t groups = (_segments + wide - 1) / wide;
  _flows = numbers(groups * inner * dd * wide);
  _inverses = numbers(groups * inner * dd * wide);
  _drifts = numbers(groups * inner * d * wide);
  _chain.transitions.resize(static_cast<Eigen::Index>(dd), segments);
  _chain.truncations.resize(static_cast<Eigen::Index>(dd), segments);
  _chain.defects.resize(static_cast<Eigen::Index>(d), segments);
  const std::size_t size = (2 * levels + 1) * dd * wide;
  const Numbers ends = numbers((groups + 1) * size);
  split_residuals<D>();
  std::fill_n(&ends[groups * size], size, 0.0);
  for (std::size_t g = 0; g <= _segments / wide; ++g) {
    core::interruption_point();
    take_node<D>(g * wide, &ends[g * size]);
  }
  for (std::size_t first = 0; first < _segments; first += wide) {
    take_segments<D>(first, ends.get());
    take_drifts<D>(first);
  }
}

template <std::size_t D>
void HermiteChain::move_points(const OrbitCorrection& correction, double factor, double* states) const {
  const LaneMatrices<D> of(_dimension);
  const std::size_t d = of.dimension();
  const std::size_t dd = of.size();
  std::vector<Lanes> storage(dd + 3 * d);
  Lanes* flow = storage.data();
  Lanes* begin = flow + dd;
  Lanes* drifted = begin + d;
  Lanes* there = drifted + d;
  std::copy_n(_states.get(), d * _points, states);
  for (std::size_t first = 0; first < _segments + 1; first += wide) {
    for (std::size_t i = 0; i < d; ++i) {
      begin[i] = lanes_of(correction.states, static_cast<Eigen::Index>(i), first);
      double* at = states + i * _points + guards + first;
      (Lanes::load(at) + factor * (begin[i] + Lanes::load(&_fast[i * _points + guards + first]))).store(at);
    }
    if (first >= _segments) break;
    Lanes time = 0.0;
    for (std::size_t c = 0; c < inner; ++c) {
      const std::size_t within = first / wide * inner + c;
      for (std::size_t n = 0; n < dd; ++n) flow[n] = Lanes::load(&_flows[(within * dd + n) * wide]);
      for (std::size_t i = 0; i < d; ++i) drifted[i] = begin[i] - Lanes::load(&_drifts[(within * d + i) * wide]);
      of.apply(flow, drifted, there);
      const std::size_t point = c * _stride + guards + first;
      time += (0.5 * part) * (Lanes::load(&_rates[point]) + Lanes::load(&_rates[point + _stride]));
      for (std::size_t i = 0; i < d; ++i) {
        const std::size_t at = i * _points + point + _stride;
        const Lanes moved =
            there[i] + Lanes::load(&_fast[at]) + correction.stretch * time * Lanes::load(&_fields[at]);
        (Lanes::load(states + at) + factor * moved).store(states + at);
      }
    }
  }
}

template <std::size_t D>
void HermiteChain::change_transitions(double stretched, const double* jacobians, Chain& changed) const {
  const LaneMatrices<D> of(_dimension);
  const std::size_t d = of.dimension();
  const std::size_t dd = of.size();
  std::vector<Lanes> storage(6 * dd);
  Lanes* flow = storage.data();
  Lanes* inverse = flow + dd;
  Lanes* change = inverse + dd;
  Lanes* product = change + dd;
  Lanes* sum = product + dd;
  Lanes* transition = sum + dd;
  const auto take_change = [&](std::size_t at, double weight) {
    const Lanes rate = weight * stretched * Lanes::load(&_rates[at]);
    for (std::size_t n = 0; n < dd; ++n)
      change[n] =
          rate * Lanes::load(jacobians + n * _points + at) - weight * Lanes::load(&_jacobians[n * _points + at]);
  };
  for (std::size_t first = 0; first < _segments; first += wide) {
    const std::size_t node = guards + first;
    take_change(node, 0.5 * part);
    std::copy_n(change, dd, sum);
    for (std::size_t c = 0; c < inner; ++c) {
      const std::size_t within = first / wide * inner + c;
      for (std::size_t n = 0; n < dd; ++n) {
        flow[n] = Lanes::load(&_flows[(within * dd + n) * wide]);
        inverse[n] = Lanes::load(&_inverses[(within * dd + n) * wide]);
      }
      take_change((c + 1) * _stride + node, part);
      of.multiply(change, flow, product);
      of.add_product(inverse, product, sum);
    }
    for (std::size_t n = 0; n < dd; ++n)
      transition[n] = lanes_of(_chain.transitions, static_cast<Eigen::Index>(n % d * d + n / d), first);
    of.multiply(transition, sum, product);
    take_change(node + 1, 0.5 * part);
    of.add_product(change, transition, product);
    for (std::size_t l = 0; l < wide && first + l < _segments; ++l) {
      double* to = changed.transitions.col(static_cast<Eigen::Index>(first + l)).data();
      for (std::size_t i = 0; i < d; ++i)
        for (std::size_t n = 0; n < d; ++n)
          to[n * d + i] = transition[i * d + n].packed[l] + product[i * d + n].packed[l];
    }
  }
}

Chain HermiteChain::corrected(const systems::System& system, const OrbitCorrection& correction, double factor) const {
  const Numbers states = numbers(_dimension * _points);
  const Numbers fields = numbers(_dimension * _points);
  const Numbers jacobians = numbers(_dimension * _dimension * _points);
  const double stretched = 1.0 + factor * correction.stretch;
  Chain changed;
  changed.steps = _chain.steps * stretched;
  changed.transitions.resize(_chain.transitions.rows(), _chain.transitions.cols());
  const auto change = [&]<std::size_t D>() {
    move_points<D>(correction, factor, states.get());
    system.field_jacobian(_points, states.get(), fields.get(), jacobians.get());
    change_transitions<D>(stretched, jacobians.get(), changed);
  };
  if (_dimension == 4)
    change.template operator()<4>();
  else
    change.template operator()<0>();
  take_nodes(system, states.get(), fields.get(), jacobians.get(), changed);
  return changed;
}

}  // namespace orbweaver::spectrum
