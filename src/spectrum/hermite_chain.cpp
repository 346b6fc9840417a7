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

namespace orbweaver::spectrum {

namespace {

using ad::Lanes;

constexpr std::size_t wide = SampledLoop::wide;
constexpr std::size_t terms = HermiteRule::terms;
constexpr std::size_t reach = HermiteRule::reach;
constexpr std::size_t parts = HermiteRule::parts;
constexpr std::size_t levels = HermiteRule::levels;
constexpr std::size_t inner = parts - 1;
constexpr std::size_t guards = SampledLoop::guards;
constexpr double part = SampledLoop::part;

/// Segments a harmonic: leaves less than 1e-11 in the index of the double pendulum's orbits.
constexpr double long_segments_a_harmonic = 0.9;
/// Largest h |A| between points at which turns are counted, as in short segments.
constexpr double most_turned_between = 0.4;
/// Below the squares of all differences.
constexpr double below_squares = 1e-300;

Lanes magnitude(Lanes x) { return Lanes(x.packed < 0.0 ? -x.packed : x.packed); }

/// Columns first, first + 1, ... of a row.
Lanes lanes_of(const Eigen::MatrixXd& table, Eigen::Index row, std::size_t first) {
  Lanes out;
  for (std::size_t l = 0; l < wide; ++l)
    out.packed[l] = table(row, std::min(static_cast<Eigen::Index>(first + l), table.cols() - 1));
  return out;
}

}  // namespace

HermiteChain::HermiteChain(const systems::System& system, const loop::Loop& loop, const FundamentalGroup& group,
                           int at_least)
    : _dimension(static_cast<std::size_t>(loop.dimension)) {
  const double resolution = std::max<double>(at_least, long_segments_a_harmonic * loop.cutoff);
  const int multiple = std::lcm(4, group.order);
  int around = allowed_segments(resolution, multiple);
  _loop = SampledLoop(system, loop, group.order, around);
  if (const int finer = allowed_segments(_loop.wanted, multiple); finer > around) {
    around = finer;
    _loop = SampledLoop(system, loop, group.order, around);
  }
  _chain.steps = steps_of(loop, static_cast<int>(_loop.segments), around);
  _chain.truncation_share = 1.0;
  take_nodes(system, _loop.states.get(), _loop.fields.get(), _loop.node_jacobians.get(), _loop.stride, _chain);
  if (_dimension == 4)
    solve<4>();
  else
    solve<0>();
  if (_dimension == 4 && system.structure().conservative()) take_inner(system);
}

/// What turns are counted at: as many points within segments as their rates ask for.
void HermiteChain::take_inner(const systems::System& system) {
  if (_loop.largest_rate <= most_turned_between) return;
  const std::size_t stride = _loop.largest_rate <= 2.0 * most_turned_between ? 2 : 1;
  const std::size_t count = parts / stride - 1;
  const std::size_t nodes = count * _loop.segments;
  const Numbers states = numbers(4 * nodes);
  const Numbers gradients = numbers(4 * nodes);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t n = 0; n < count; ++n)
      std::copy_n(&_loop.states[i * _loop.points + (n + 1) * stride * _loop.stride + guards], _loop.segments,
                  &states[i * nodes + n * _loop.segments]);
  system.conserved_gradients(0, nodes, states.get(), gradients.get());
  const auto columns = static_cast<Eigen::Index>(nodes);
  _chain.inner_fields.resize(4, columns);
  _chain.inner_gradients.resize(4, columns);
  _chain.inner_transitions.resize(16, columns);
  for (std::size_t m = 0; m < _loop.segments; ++m)
    for (std::size_t n = 0; n < count; ++n) {
      const auto column = static_cast<Eigen::Index>(m * count + n);
      const std::size_t c = (n + 1) * stride;
      for (std::size_t i = 0; i < 4; ++i) {
        _chain.inner_fields.col(column).data()[i] = _loop.fields[i * _loop.points + c * _loop.stride + guards + m];
        _chain.inner_gradients.col(column).data()[i] = gradients[i * nodes + n * _loop.segments + m];
        for (std::size_t l = 0; l < 4; ++l)
          _chain.inner_transitions.col(column).data()[l * 4 + i] =
              _flows[((m / wide * inner + c - 1) * 16 + i * 4 + l) * wide + m % wide];
      }
    }
}

void HermiteChain::take_nodes(const systems::System& system, const double* states, const double* fields,
                              const double* jacobians, std::size_t row, Chain& chain) const {
  const auto d = static_cast<Eigen::Index>(_dimension);
  const auto nodes = static_cast<Eigen::Index>(_loop.segments) + 1;
  const auto points = static_cast<Eigen::Index>(_loop.points);
  using Rows = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
                          Eigen::OuterStride<>>;
  chain.states = Rows(states + guards, d, nodes, Eigen::OuterStride<>(points));
  chain.fields = Rows(fields + guards, d, nodes, Eigen::OuterStride<>(points));
  chain.jacobians.resize(d * d, nodes);
  const Rows all(jacobians + guards, d * d, nodes, Eigen::OuterStride<>(static_cast<Eigen::Index>(row)));
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index l = 0; l < d; ++l) chain.jacobians.row(l * d + i) = all.row(i * d + l);
  evaluate_gradients(system, chain);
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
    if (_loop.vanishes[n]) {
      for (std::size_t j = 0; j < terms; ++j) a[j * dd + n] = 0.0;
      Lanes(0.0).store(change + n * wide);
      continue;
    }
    const double* entry = &_loop.jacobians[n * _loop.points + guards + first];
    const Lanes centre = Lanes::load(entry);
    Lanes coefficients[terms];
    for (std::size_t j = 0; j < terms; ++j) coefficients[j] = j % 2 == 0 ? centre * rule.stencil[j][0] : Lanes(0.0);
    Lanes even_change = centre * rule.even_change[0];
    Lanes odd_change = 0.0;
#pragma GCC unroll 16
    for (std::size_t k = 1; k <= reach; ++k) {
      const std::size_t back = (k + parts - 1) / parts;
      const Lanes plus = Lanes::load(entry + (k % parts) * _loop.stride + k / parts);
      const Lanes minus = Lanes::load(entry + (back * parts - k) * _loop.stride - back);
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
          if (_loop.vanishes[i * d + m]) continue;
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
  if (first >= _loop.segments) return;
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
  for (std::size_t l = 0; l < wide && first + l < _loop.segments; ++l) {
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
    before[i] = Lanes::load(&_loop.residuals[i * _loop.points + guards + first]);
  }
  for (std::size_t c = 0; c < inner; ++c) {
    const double* inverse = &_inverses[(first / wide * inner + c) * dd * wide];
    for (std::size_t n = 0; n < dd; ++n) matrix[n] = Lanes::load(inverse + n * wide);
    for (std::size_t i = 0; i < d; ++i)
      residual[i] = Lanes::load(&_loop.residuals[i * _loop.points + (c + 1) * _loop.stride + guards + first]);
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
    const Lanes end = Lanes::load(&_loop.residuals[i * _loop.points + guards + first + 1]);
    const Lanes gap = -(carried[i] + (0.5 * part) * end);
    for (std::size_t l = 0; l < wide && first + l < _loop.segments; ++l)
      _chain.defects(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(first + l)) = gap.packed[l];
  }
}

template <std::size_t D>
void HermiteChain::solve() {
  const LaneMatrices<D> of(_dimension);
  const std::size_t d = of.dimension();
  const std::size_t dd = of.size();
  const auto segments = static_cast<Eigen::Index>(_loop.segments);
  const std::size_t groups = (_loop.segments + wide - 1) / wide;
  _flows = numbers(groups * inner * dd * wide);
  _inverses = numbers(groups * inner * dd * wide);
  _drifts = numbers(groups * inner * d * wide);
  _chain.transitions.resize(static_cast<Eigen::Index>(dd), segments);
  _chain.truncations.resize(static_cast<Eigen::Index>(dd), segments);
  _chain.defects.resize(static_cast<Eigen::Index>(d), segments);
  const std::size_t size = (2 * levels + 1) * dd * wide;
  const Numbers ends = numbers((groups + 1) * size);
  _loop.split_residuals();
  std::fill_n(&ends[groups * size], size, 0.0);
  for (std::size_t g = 0; g <= _loop.segments / wide; ++g) {
    core::interruption_point();
    take_node<D>(g * wide, &ends[g * size]);
  }
  for (std::size_t first = 0; first < _loop.segments; first += wide) {
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
  std::copy_n(_loop.states.get(), d * _loop.points, states);
  for (std::size_t first = 0; first < _loop.segments + 1; first += wide) {
    for (std::size_t i = 0; i < d; ++i) {
      begin[i] = lanes_of(correction.states, static_cast<Eigen::Index>(i), first);
      double* at = states + i * _loop.points + guards + first;
      (Lanes::load(at) + factor * (begin[i] + Lanes::load(&_loop.fast[i * _loop.points + guards + first]))).store(at);
    }
    if (first >= _loop.segments) break;
    Lanes time = 0.0;
    for (std::size_t c = 0; c < inner; ++c) {
      const std::size_t within = first / wide * inner + c;
      for (std::size_t n = 0; n < dd; ++n) flow[n] = Lanes::load(&_flows[(within * dd + n) * wide]);
      for (std::size_t i = 0; i < d; ++i) drifted[i] = begin[i] - Lanes::load(&_drifts[(within * d + i) * wide]);
      of.apply(flow, drifted, there);
      const std::size_t point = c * _loop.stride + guards + first;
      time += (0.5 * part) * (Lanes::load(&_loop.rates[point]) + Lanes::load(&_loop.rates[point + _loop.stride]));
      for (std::size_t i = 0; i < d; ++i) {
        const std::size_t at = i * _loop.points + point + _loop.stride;
        const Lanes moved =
            there[i] + Lanes::load(&_loop.fast[at]) + correction.stretch * time * Lanes::load(&_loop.fields[at]);
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
    const Lanes rate = weight * stretched * Lanes::load(&_loop.rates[at]);
    for (std::size_t n = 0; n < dd; ++n)
      change[n] = rate * Lanes::load(jacobians + n * _loop.points + at) -
                  weight * Lanes::load(&_loop.jacobians[n * _loop.points + at]);
  };
  for (std::size_t first = 0; first < _loop.segments; first += wide) {
    const std::size_t node = guards + first;
    take_change(node, 0.5 * part);
    std::copy_n(change, dd, sum);
    for (std::size_t c = 0; c < inner; ++c) {
      const std::size_t within = first / wide * inner + c;
      for (std::size_t n = 0; n < dd; ++n) {
        flow[n] = Lanes::load(&_flows[(within * dd + n) * wide]);
        inverse[n] = Lanes::load(&_inverses[(within * dd + n) * wide]);
      }
      take_change((c + 1) * _loop.stride + node, part);
      of.multiply(change, flow, product);
      of.add_product(inverse, product, sum);
    }
    for (std::size_t n = 0; n < dd; ++n)
      transition[n] = lanes_of(_chain.transitions, static_cast<Eigen::Index>(n % d * d + n / d), first);
    of.multiply(transition, sum, product);
    take_change(node + 1, 0.5 * part);
    of.add_product(change, transition, product);
    for (std::size_t l = 0; l < wide && first + l < _loop.segments; ++l) {
      double* to = changed.transitions.col(static_cast<Eigen::Index>(first + l)).data();
      for (std::size_t i = 0; i < d; ++i)
        for (std::size_t n = 0; n < d; ++n)
          to[n * d + i] = transition[i * d + n].packed[l] + product[i * d + n].packed[l];
    }
  }
}

Chain HermiteChain::corrected(const systems::System& system, const OrbitCorrection& correction, double factor) const {
  const Numbers states = numbers(_dimension * _loop.points);
  const Numbers fields = numbers(_dimension * _loop.points);
  const Numbers jacobians = numbers(_dimension * _dimension * _loop.points);
  const double stretched = 1.0 + factor * correction.stretch;
  Chain changed;
  changed.steps = _chain.steps * stretched;
  changed.transitions.resize(_chain.transitions.rows(), _chain.transitions.cols());
  const auto change = [&]<std::size_t D>() {
    move_points<D>(correction, factor, states.get());
    system.field_jacobian(_loop.points, states.get(), fields.get(), jacobians.get());
    change_transitions<D>(stretched, jacobians.get(), changed);
  };
  if (_dimension == 4)
    change.template operator()<4>();
  else
    change.template operator()<0>();
  take_nodes(system, states.get(), fields.get(), jacobians.get(), _loop.points, changed);
  return changed;
}

}  // namespace orbweaver::spectrum
