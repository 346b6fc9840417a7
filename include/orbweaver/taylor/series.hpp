#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "orbweaver/model/graph.hpp"
#include "orbweaver/taylor/arithmetic.hpp"

namespace orbweaver::taylor {

/// The Taylor coefficients of all operations behind some outputs, along the solution that the outputs are the time
/// derivative of.
template <class Real>
class Series {
  using A = Arithmetic<Real>;
  using Operation = model::Operation;

 public:
  Series(const model::Graph& graph, const std::vector<int>& outputs, const std::vector<Real>& parameters, int order)
      : _order(order), _size(outputs.size()) {
    select(graph, outputs);
    _coefficients.resize(_nodes.size() * width());
    _derived.resize(_nodes.size());
    _input.assign(_size, -1);
    for (std::size_t n = 0; n < _nodes.size(); ++n) {
      model::Node& node = _nodes[n];
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
  void select(const model::Graph& graph, const std::vector<int>& outputs) {
    std::vector<bool> needed(graph.nodes().size(), false);
    for (const int output : outputs) needed[static_cast<std::size_t>(output)] = true;
    for (std::size_t n = graph.nodes().size(); n-- > 0;) {
      if (!needed[n]) continue;
      const model::Node& node = graph.nodes()[n];
      if (node.operation == Operation::sine || node.operation == Operation::tanh) needed[n + 1] = true;
      if (node.operation == Operation::cosine || node.operation == Operation::slope) needed[n - 1] = true;
      if (node.operation == Operation::input || node.operation == Operation::parameter) continue;
      if (node.first >= 0) needed[static_cast<std::size_t>(node.first)] = true;
      if (node.second >= 0) needed[static_cast<std::size_t>(node.second)] = true;
    }
    std::vector<int> place(graph.nodes().size(), -1);
    for (std::size_t n = 0; n < graph.nodes().size(); ++n) {
      if (!needed[n]) continue;
      model::Node node = graph.nodes()[n];
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
    const model::Node& node = _nodes[n];
    bool is_constant = node.operation != Operation::input;
    if (is_constant && node.operation != Operation::parameter && node.operation != Operation::constant) {
      if (node.first >= 0) is_constant = is_constant && constant(node.first);
      if (node.second >= 0) is_constant = is_constant && constant(node.second);
    }
    _is_constant.push_back(is_constant);
    const bool integrates = node.operation == Operation::exp || node.operation == Operation::sine ||
                            node.operation == Operation::tanh || node.operation >= Operation::log;
    if (integrates && !is_constant) _derived[static_cast<std::size_t>(node.first)].resize(1);
  }

  /// k a_k of node a.
  Real& derived(int a, int k) { return _derived[static_cast<std::size_t>(a)][static_cast<std::size_t>(k)]; }

  void compute_first(std::size_t n) {
    using std::acos, std::asin, std::atan, std::cos, std::erf, std::exp, std::log, std::sin, std::sqrt, std::tanh;
    const model::Node& node = _nodes[n];
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
      case Operation::erf: A::set(out, erf(at(node.first, 0))); break;
      case Operation::tanh: A::set(out, tanh(at(node.first, 0))); break;
      case Operation::slope:
        A::multiply(out, at(static_cast<int>(n) - 1, 0), at(static_cast<int>(n) - 1, 0));
        A::set(_work, 1.0);
        A::subtract(out, _work, out);
        break;
    }
  }

  // Knuth, The Art of Computer Programming 2, 4.7; Moore 1966, Interval Analysis, 11.
  void compute(std::size_t n, int k) {
    const model::Node& node = _nodes[n];
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
      case Operation::tanh:
        derive(node.first, k);
        convolve(_derived[static_cast<std::size_t>(node.first)].data(), &at(n + 1, 0), 1, k, k, out);
        A::divide(out, out, static_cast<long>(k));
        break;
      case Operation::slope:  // s = 1 - t^2
        square(static_cast<int>(n) - 1, k, 0, out);
        A::negate(out, out);
        break;
      case Operation::log:
      case Operation::asin:
      case Operation::acos:
      case Operation::atan:
      case Operation::erf:
        derive(node.first, k);
        convolve(_derived[static_cast<std::size_t>(node.first)].data(), &at(node.second, 0), 1, k, k, out);
        A::divide(out, out, static_cast<long>(k));
        break;
    }
  }

  /// k a_k, for a's that are integrated against.
  void derive(int a, int k) { A::multiply(derived(a, k), at(a, k), static_cast<long>(k)); }

  /// sum_{j = from}^{to} a_j b_{k - j}.
  void convolve(const Real* a, const Real* b, int from, int to, int k, Real& out) {
    _sum.clear();
    _sum.add_products(a + from, b + (k - from), to - from + 1);
    A::set(out, _sum.value());
  }

  /// sum_{j = from}^{k - from} a_j a_{k - j}.
  void square(int a, int k, int from, Real& out) {
    _sum.clear();
    _sum.add_products(&at(a, from), &at(a, k - from), (k + 1) / 2 - from);
    _sum.twice();
    if (k % 2 == 0 && k / 2 >= from) _sum.add_products(&at(a, k / 2), &at(a, k / 2), 1);
    A::set(out, _sum.value());
  }

  /// c_k = (a_k - sum_{j = 1}^k b_j c_{k-j}) / b_0.
  void divide(std::size_t n, int k) {
    const model::Node& node = _nodes[n];
    Real& out = at(n, k);
    if (constant(node.second)) {
      A::divide(out, at(node.first, k), at(node.second, 0));
      return;
    }
    _sum.clear();
    if (!constant(node.first)) _sum.add(at(node.first, k));
    _sum.subtract_products(&at(node.second, 1), &at(n, k - 1), k);
    A::divide(out, _sum.value(), at(node.second, 0));
  }

  int _order;
  std::size_t _size;
  std::vector<model::Node> _nodes;
  std::vector<bool> _is_constant;
  std::vector<int> _outputs;  // nodes
  std::vector<int> _input;    // of each component, the node that is it; -1: none depends on it
  std::vector<Real> _coefficients;
  std::vector<std::vector<Real>> _derived;
  std::vector<Real> _own;
  typename A::Sum _sum;
  Real _work = Real();
};

}  // namespace orbweaver::taylor
