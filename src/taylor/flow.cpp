#include "orbweaver/taylor/flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "arithmetic.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::taylor {

namespace {

using ad::Operation;
using ad::Tape;

/// The quickest order for a tolerance eps is -ln(eps)/2: a step is then 1/e^2 of the radius of convergence (Jorba and
/// Zou 2005, section 3.2).
int quickest_order(double digits) {
  return std::max(4, static_cast<int>(std::ceil(0.5 * std::numbers::ln10 * digits)));
}

/// The component's, or the entry's of a transition, in log10.
double log_scale(const std::vector<double>& log_scales, std::size_t i) {
  const std::size_t d = log_scales.size();
  return i < d ? log_scales[i] : log_scales[(i - d) / d] - log_scales[(i - d) % d];
}

}  // namespace

/// The Taylor coefficients of all operations behind some outputs, along the solution that the outputs are the time
/// derivative of.
template <class Real>
class Series {
  using A = Arithmetic<Real>;

 public:
  Series(const Tape& tape, const std::vector<int>& outputs, const std::vector<Real>& parameters, int order)
      : _order(order), _size(outputs.size()) {
    select(tape, outputs);
    _coefficients.resize(_nodes.size() * width());
    _derived.resize(_nodes.size());
    _input.assign(_size, -1);
    for (std::size_t n = 0; n < _nodes.size(); ++n) {
      Tape::Node& node = _nodes[n];
      if (node.operation == Operation::input) _input[static_cast<std::size_t>(node.first)] = static_cast<int>(n);
      if (node.operation == Operation::parameter) {
        A::set(at(n, 0), parameters[static_cast<std::size_t>(node.first)]);
      } else if (node.operation == Operation::constant) {
        A::set(at(n, 0), node.value);
      }
      mark(n);
    }
    for (std::vector<Real>& values : _derived)
      if (values.size() == 1) values.resize(width());
    _own.resize(_size * width());
    for (std::size_t n = 0; n < _nodes.size(); ++n)
      if (_is_constant[n]) compute_first(n);
  }

  [[nodiscard]] int order() const { return _order; }

  /// All coefficients of the solution through `state`.
  void expand(const std::vector<Real>& first, const std::vector<Real>& rest) {
    for (std::size_t i = 0; i < _size; ++i) {
      A::set(own(i, 0), i < first.size() ? first[i] : rest[i - first.size()]);
      if (_input[i] >= 0) A::set(at(static_cast<std::size_t>(_input[i]), 0), own(i, 0));
    }
    for (int k = 0; k < _order; ++k) {
      for (std::size_t n = 0; n < _nodes.size(); ++n)
        if (!_is_constant[n]) k == 0 ? compute_first(n) : compute(n, k);
      for (std::size_t i = 0; i < _size; ++i) {
        const auto output = static_cast<std::size_t>(_outputs[i]);
        if (k > 0 && _is_constant[output])
          A::set(own(i, k + 1), 0.0);
        else
          A::divide(own(i, k + 1), at(output, k), static_cast<long>(k + 1));
        if (_input[i] >= 0) A::set(at(static_cast<std::size_t>(_input[i]), k + 1), own(i, k + 1));
      }
    }
  }

  /// The coefficient of t^k of component i.
  Real& own(std::size_t i, int k) { return _own[i * width() + static_cast<std::size_t>(k)]; }

  /// Component i at the time t after the expansion's.
  void sum(std::size_t i, const Real& t, Real& out) {
    A::set(_work, own(i, _order));
    for (int k = _order; k-- > 0;) {
      A::multiply(_work, _work, t);
      A::add(_work, _work, own(i, k));
    }
    A::set(out, _work);
  }

 private:
  [[nodiscard]] std::size_t width() const { return static_cast<std::size_t>(_order) + 1; }
  Real& at(std::size_t n, int k) { return _coefficients[n * width() + static_cast<std::size_t>(k)]; }
  Real& at(int n, int k) { return at(static_cast<std::size_t>(n), k); }
  [[nodiscard]] bool constant(int n) const { return _is_constant[static_cast<std::size_t>(n)]; }

  /// Keeps what the outputs need, renumbered.
  void select(const Tape& tape, const std::vector<int>& outputs) {
    std::vector<bool> needed(tape.nodes.size(), false);
    for (const int output : outputs) needed[static_cast<std::size_t>(output)] = true;
    for (std::size_t n = tape.nodes.size(); n-- > 0;) {
      if (!needed[n]) continue;
      const Tape::Node& node = tape.nodes[n];
      if (node.operation == Operation::sine) needed[n + 1] = true;
      if (node.operation == Operation::cosine) needed[n - 1] = true;
      if (node.operation == Operation::input || node.operation == Operation::parameter) continue;
      if (node.first >= 0) needed[static_cast<std::size_t>(node.first)] = true;
      if (node.second >= 0) needed[static_cast<std::size_t>(node.second)] = true;
    }
    std::vector<int> place(tape.nodes.size(), -1);
    for (std::size_t n = 0; n < tape.nodes.size(); ++n) {
      if (!needed[n]) continue;
      Tape::Node node = tape.nodes[n];
      const bool is_leaf = node.operation == Operation::input || node.operation == Operation::parameter;
      if (!is_leaf && node.first >= 0) node.first = place[static_cast<std::size_t>(node.first)];
      if (!is_leaf && node.second >= 0) node.second = place[static_cast<std::size_t>(node.second)];
      place[n] = static_cast<int>(_nodes.size());
      _nodes.push_back(node);
    }
    for (const int output : outputs) _outputs.push_back(place[static_cast<std::size_t>(output)]);
  }

  /// Says whether node n is constant in time, and which operands need k a_k kept.
  void mark(std::size_t n) {
    const Tape::Node& node = _nodes[n];
    bool is_constant = node.operation != Operation::input;
    if (is_constant && node.operation != Operation::parameter && node.operation != Operation::constant) {
      if (node.first >= 0) is_constant = is_constant && constant(node.first);
      if (node.second >= 0) is_constant = is_constant && constant(node.second);
    }
    _is_constant.push_back(is_constant);
    const bool integrates = node.operation == Operation::exp || node.operation == Operation::sine ||
                            node.operation == Operation::log || node.operation == Operation::asin ||
                            node.operation == Operation::acos || node.operation == Operation::atan;
    if (integrates && !is_constant) _derived[static_cast<std::size_t>(node.first)].resize(1);
  }

  /// k a_k of node a.
  Real& derived(int a, int k) { return _derived[static_cast<std::size_t>(a)][static_cast<std::size_t>(k)]; }

  void compute_first(std::size_t n) {
    using std::acos, std::asin, std::atan, std::cos, std::exp, std::log, std::sin, std::sqrt;
    const Tape::Node& node = _nodes[n];
    Real& out = at(n, 0);
    switch (node.operation) {
      case Operation::input:
      case Operation::parameter:
      case Operation::constant: break;
      case Operation::add: A::add(out, at(node.first, 0), at(node.second, 0)); break;
      case Operation::subtract: A::subtract(out, at(node.first, 0), at(node.second, 0)); break;
      case Operation::multiply: A::multiply(out, at(node.first, 0), at(node.second, 0)); break;
      case Operation::divide: A::divide(out, at(node.first, 0), at(node.second, 0)); break;
      case Operation::negate: A::negate(out, at(node.first, 0)); break;
      case Operation::sqrt: A::set(out, sqrt(at(node.first, 0))); break;
      case Operation::exp: A::set(out, exp(at(node.first, 0))); break;
      case Operation::sine: A::set(out, sin(at(node.first, 0))); break;
      case Operation::cosine: A::set(out, cos(at(node.first, 0))); break;
      case Operation::log: A::set(out, log(at(node.first, 0))); break;
      case Operation::asin: A::set(out, asin(at(node.first, 0))); break;
      case Operation::acos: A::set(out, acos(at(node.first, 0))); break;
      case Operation::atan: A::set(out, atan(at(node.first, 0))); break;
      case Operation::power: A::set(out, A::power(at(node.first, 0), node.value)); break;
    }
  }

  // Knuth, The Art of Computer Programming 2, 4.7; Moore 1966, Interval Analysis, 11.
  void compute(std::size_t n, int k) {
    const Tape::Node& node = _nodes[n];
    Real& out = at(n, k);
    switch (node.operation) {
      case Operation::input:
      case Operation::parameter:
      case Operation::constant: break;
      case Operation::add:
        if (constant(node.first))
          A::set(out, at(node.second, k));
        else if (constant(node.second))
          A::set(out, at(node.first, k));
        else
          A::add(out, at(node.first, k), at(node.second, k));
        break;
      case Operation::subtract:
        if (constant(node.first))
          A::negate(out, at(node.second, k));
        else if (constant(node.second))
          A::set(out, at(node.first, k));
        else
          A::subtract(out, at(node.first, k), at(node.second, k));
        break;
      case Operation::multiply:
        if (constant(node.first))
          A::multiply(out, at(node.first, 0), at(node.second, k));
        else if (constant(node.second))
          A::multiply(out, at(node.first, k), at(node.second, 0));
        else if (node.first == node.second)
          square(node.first, k, 0, out);
        else
          convolve(&at(node.first, 0), &at(node.second, 0), 0, k, k, out);
        break;
      case Operation::divide: divide(n, k); break;
      case Operation::negate: A::negate(out, at(node.first, k)); break;
      case Operation::sqrt:  // c_k = (a_k - sum_{0<j<k} c_j c_{k-j}) / (2 c_0)
        square(static_cast<int>(n), k, 1, out);
        A::subtract(out, at(node.first, k), out);
        A::divide(out, out, at(n, 0));
        A::divide(out, out, 2L);
        break;
      case Operation::exp:
        derive(node.first, k);
        convolve(_derived[static_cast<std::size_t>(node.first)].data(), &at(n, 0), 1, k, k, out);
        A::divide(out, out, static_cast<long>(k));
        break;
      case Operation::sine: {
        derive(node.first, k);
        const Real* slopes = _derived[static_cast<std::size_t>(node.first)].data();
        Real& cosine = at(n + 1, k);
        convolve(slopes, &at(n + 1, 0), 1, k, k, out);
        A::divide(out, out, static_cast<long>(k));
        convolve(slopes, &at(n, 0), 1, k, k, cosine);
        A::divide(cosine, cosine, -static_cast<long>(k));
        break;
      }
      case Operation::cosine: break;  // with the sine
      case Operation::log:
      case Operation::asin:
      case Operation::acos:
      case Operation::atan:
        derive(node.first, k);
        convolve(_derived[static_cast<std::size_t>(node.first)].data(), &at(node.second, 0), 1, k, k, out);
        A::divide(out, out, static_cast<long>(k));
        break;
      case Operation::power: power(n, k); break;
    }
  }

  /// k a_k, for a's that are integrated against.
  void derive(int a, int k) { A::multiply(derived(a, k), at(a, k), static_cast<long>(k)); }

  /// sum_{j = from}^{to} a_j b_{k - j}.
  void convolve(const Real* a, const Real* b, int from, int to, int k, Real& out) {
    _sum.clear();
    for (int j = from; j <= to; ++j) _sum.add_product(a[j], b[k - j]);
    A::set(out, _sum.value());
  }

  /// sum_{j = from}^{k - from} a_j a_{k - j}.
  void square(int a, int k, int from, Real& out) {
    _sum.clear();
    for (int j = from; 2 * j < k; ++j) _sum.add_product(at(a, j), at(a, k - j));
    _sum.twice();
    if (k % 2 == 0 && k / 2 >= from) _sum.add_product(at(a, k / 2), at(a, k / 2));
    A::set(out, _sum.value());
  }

  /// c_k = (a_k - sum_{j = 1}^k b_j c_{k-j}) / b_0.
  void divide(std::size_t n, int k) {
    const Tape::Node& node = _nodes[n];
    Real& out = at(n, k);
    if (constant(node.second)) {
      A::divide(out, at(node.first, k), at(node.second, 0));
      return;
    }
    _sum.clear();
    if (!constant(node.first)) _sum.add(at(node.first, k));
    for (int j = 1; j <= k; ++j) _sum.subtract_product(at(node.second, j), at(n, k - j));
    A::divide(out, _sum.value(), at(node.second, 0));
  }

  /// c_k = sum_{j = 1}^k (j e - (k - j)) a_j c_{k-j} / (k a_0).
  void power(std::size_t n, int k) {
    const Tape::Node& node = _nodes[n];
    _sum.clear();
    for (int j = 1; j <= k; ++j) {
      A::set(_work, node.value * j - static_cast<double>(k - j));
      A::multiply(_work, _work, at(node.first, j));
      _sum.add_product(_work, at(n, k - j));
    }
    A::divide(_work, _sum.value(), static_cast<long>(k));
    A::divide(at(n, k), _work, at(node.first, 0));
  }

  int _order;
  std::size_t _size;
  std::vector<Tape::Node> _nodes;
  std::vector<bool> _is_constant;
  std::vector<int> _outputs;  // nodes
  std::vector<int> _input;    // of each component, the node that is it; -1: none depends on it
  std::vector<Real> _coefficients;
  std::vector<std::vector<Real>> _derived;
  std::vector<Real> _own;
  typename A::Sum _sum;
  Real _work = Real();
};

template <class Real>
Flow<Real>::Flow(const systems::Formulas& formulas, const std::vector<Real>& parameters, const FlowOptions& options)
    : _formulas(formulas), _parameters(parameters), _options(options) {
  core::require(parameters.size() == formulas.parameters.size(), "one value a parameter");
  const auto d = static_cast<std::size_t>(formulas.dimension);
  core::require(options.scales.empty() || options.scales.size() == d, "one scale a coordinate");
  for (std::size_t i = 0; i < d; ++i)
    _log_scales.push_back(options.scales.empty() ? 0.0 : std::log10(options.scales[i]));
}

template <class Real>
Flow<Real>::~Flow() = default;

template <class Real>
Flow<Real>::Flow(Flow&&) noexcept = default;

template <class Real>
int Flow<Real>::order() const {
  return quickest_order(_options.digits) + _options.extra_order;
}

template <class Real>
void Flow<Real>::advance(std::vector<Real>& state, const Real& time) {
  if (!_state) _state = std::make_unique<Series<Real>>(_formulas.tape, _formulas.field, _parameters, order());
  std::vector<Real> none;
  run(*_state, state, none, time);
}

template <class Real>
void Flow<Real>::advance(std::vector<Real>& state, std::vector<Real>& transitions, const Real& time) {
  core::require(transitions.size() == state.size() * state.size(), "a square matrix of transitions");
  if (!_variational) {
    std::vector<int> outputs = _formulas.field;
    outputs.insert(outputs.end(), _formulas.variations.begin(), _formulas.variations.end());
    _variational = std::make_unique<Series<Real>>(_formulas.tape, outputs, _parameters, order());
  }
  run(*_variational, state, transitions, time);
}

template <class Real>
double Flow<Real>::log_norm(Series<Real>& series, int k, std::size_t from, std::size_t to) const {
  double norm = -std::numeric_limits<double>::infinity();
  for (std::size_t i = from; i < to; ++i)
    norm = std::max(norm, numerics::log10_abs(series.own(i, k)) - log_scale(_log_scales, i));
  return norm;
}

template <class Real>
double Flow<Real>::step_size(Series<Real>& series, std::size_t size) const {
  const std::size_t d = _log_scales.size();
  double log_step = std::numeric_limits<double>::infinity();
  const double grown = size > d ? log_norm(series, 0, d, size) : 0.0;
  for (const int k : {series.order() - 1, series.order()}) {  // one of them may vanish by a symmetry
    log_step = std::min(log_step, (-_options.digits - log_norm(series, k, 0, d)) / k);
    if (size > d) log_step = std::min(log_step, (-_options.digits + grown - log_norm(series, k, d, size)) / k);
  }
  return std::pow(10.0, log_step);
}

template <class Real>
void Flow<Real>::run(Series<Real>& series, std::vector<Real>& state, std::vector<Real>& transitions, const Real& time) {
  using A = Arithmetic<Real>;
  core::require(state.size() == _log_scales.size(), "a state of another dimension");
  const std::size_t size = state.size() + transitions.size();
  Real remaining = Real();
  A::set(remaining, time);
  Real step = Real();
  for (long count = 0; !A::is_zero(remaining); ++count) {
    if (count >= _options.most_steps)
      throw core::NumericalError("a Taylor integration was given up: its steps become ever shorter");
    series.expand(state, transitions);
    for (std::size_t i = 0; i < size; ++i)
      if (!A::is_finite(series.own(i, series.order())))
        throw core::NotFiniteError("the Taylor series of the solution is not finite: a singularity of the field");
    const double rest = A::to_double(remaining);
    const double length = step_size(series, size);
    if (length >= std::abs(rest))
      A::set(step, remaining);
    else
      A::set(step, std::copysign(length, rest));
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t d = state.size();
      series.sum(i, step, i < d ? state[i] : transitions[i - d]);
    }
    A::subtract(remaining, remaining, step);
    ++_steps;
  }
}

namespace {

constexpr std::size_t width = ad::Lanes::width;

std::vector<ad::Lanes> in_all_lanes(const std::vector<double>& values) { return {values.begin(), values.end()}; }

}  // namespace

ManyFlows::ManyFlows(const systems::Formulas& formulas, const FlowOptions& options)
    : _options(options),
      _dimension(static_cast<std::size_t>(formulas.dimension)),
      _series(std::make_unique<Series<ad::Lanes>>(formulas.tape, formulas.field, in_all_lanes(formulas.values),
                                                  quickest_order(options.digits) + options.extra_order)) {
  core::require(options.scales.empty() || options.scales.size() == _dimension, "one scale a coordinate");
  for (std::size_t i = 0; i < _dimension; ++i) _scales.push_back(options.scales.empty() ? 1.0 : options.scales[i]);
}

ManyFlows::~ManyFlows() = default;
ManyFlows::ManyFlows(ManyFlows&&) noexcept = default;

double ManyFlows::step_size(std::size_t lane) const {
  const int order = _series->order();
  double log_step = std::numeric_limits<double>::infinity();
  for (const int k : {order - 1, order}) {  // one of them may vanish by a symmetry
    double norm = 0.0;
    for (std::size_t i = 0; i < _dimension; ++i) {
      const double term = std::abs(_series->own(i, k).packed[lane]) / _scales[i];
      if (!std::isfinite(term))
        throw core::NotFiniteError("the Taylor series of a solution is not finite: a singularity of the field");
      norm = std::max(norm, term);
    }
    log_step = std::min(log_step, (-_options.digits - std::log10(norm)) / k);
  }
  return std::pow(10.0, log_step);
}

void ManyFlows::advance(std::vector<std::vector<double>>& states, double time) {
  for (const std::vector<double>& state : states)
    core::require(state.size() == _dimension, "a state of another dimension");
  if (states.empty() || time == 0.0) return;
  std::size_t next = 0;
  std::size_t running = 0;
  std::array<std::size_t, width> place{};
  std::array<double, width> remaining{};
  std::array<long, width> steps{};
  std::vector<ad::Lanes> at(_dimension, ad::Lanes(0.0));
  const auto load = [&](std::size_t lane) {  // a lane without work repeats the last state, and nobody asks
    const bool works = next < states.size();
    place[lane] = works ? next++ : states.size();
    remaining[lane] = works ? time : 0.0;
    steps[lane] = 0;
    if (works) ++running;
    const std::vector<double>& state = works ? states[place[lane]] : states.back();
    for (std::size_t i = 0; i < _dimension; ++i) at[i].packed[lane] = state[i];
  };
  for (std::size_t lane = 0; lane < width; ++lane) load(lane);
  const std::vector<ad::Lanes> none;
  while (running > 0) {
    _series->expand(at, none);
    ad::Lanes step(0.0);
    for (std::size_t lane = 0; lane < width; ++lane)
      if (place[lane] < states.size()) {
        const double length = step_size(lane);
        step.packed[lane] =
            length >= std::abs(remaining[lane]) ? remaining[lane] : std::copysign(length, remaining[lane]);
      }
    for (std::size_t i = 0; i < _dimension; ++i) _series->sum(i, step, at[i]);
    for (std::size_t lane = 0; lane < width; ++lane) {
      if (place[lane] == states.size()) continue;
      remaining[lane] -= step.packed[lane];
      if (++steps[lane] > _options.most_steps)
        throw core::NumericalError("a Taylor integration was given up: its steps become ever shorter");
      if (remaining[lane] != 0.0) continue;
      for (std::size_t i = 0; i < _dimension; ++i) states[place[lane]][i] = at[i].packed[lane];
      --running;
      load(lane);
    }
  }
}

template class Flow<double>;
template class Flow<numerics::Extended>;

}  // namespace orbweaver::taylor
