#include "orbweaver/model/graph.hpp"

#include <cmath>
#include <utility>

#include "orbweaver/core/error.hpp"

namespace orbweaver::model {

namespace {

/// Whole numbers up to it, and sums and products of them, are exact.
constexpr double most_whole = 9007199254740992.0;  // 2^53

bool is_whole(double x) { return x == std::floor(x) && std::abs(x) <= most_whole; }

}  // namespace

int Graph::place(const Node& node) {
  const auto [known, is_new] = _known.try_emplace({node.operation, node.first, node.second, node.value}, size());
  if (is_new) _nodes.push_back(node);
  return known->second;
}

int Graph::input(int number) { return place({Operation::input, number, -1, 0.0}); }
int Graph::parameter(int number) { return place({Operation::parameter, number, -1, 0.0}); }
int Graph::constant(double value) { return place({Operation::constant, -1, -1, value == 0.0 ? 0.0 : value}); }

int Graph::decimal(double significand, int exponent) {
  constexpr int most = 22;  // 10^22 is the last power of ten that a double has
  int value = constant(significand);
  while (exponent != 0) {
    const int part = std::min(std::abs(exponent), most);
    double power = 1.0;
    for (int n = 0; n < part; ++n) power *= 10.0;
    value = exponent < 0 ? divide(value, constant(power)) : multiply(value, constant(power));
    exponent += exponent < 0 ? part : -part;
  }
  return value;
}

int Graph::pi() { return multiply(constant(4.0), atan(constant(1.0))); }

int Graph::folded(bool exact, double value, const Node& node) { return exact ? constant(value) : place(node); }

int Graph::add(int a, int b) {
  if (is_constant(a, 0.0)) return b;
  if (is_constant(b, 0.0)) return a;
  if (a > b) std::swap(a, b);
  const double x = node(a).value, y = node(b).value;
  const bool exact = is_constant(a) && is_constant(b) && (x + y) - x == y && (x + y) - y == x;
  return folded(exact, x + y, {Operation::add, a, b, 0.0});
}

int Graph::subtract(int a, int b) {
  if (is_constant(b, 0.0)) return a;
  if (is_constant(a, 0.0)) return negate(b);
  if (a == b) return constant(0.0);
  const double x = node(a).value, y = node(b).value;
  const bool exact = is_constant(a) && is_constant(b) && (x - y) + y == x && x - (x - y) == y;
  return folded(exact, x - y, {Operation::subtract, a, b, 0.0});
}

int Graph::multiply(int a, int b) {
  if (is_constant(a, 0.0) || is_constant(b, 0.0)) return constant(0.0);
  if (is_constant(a, 1.0)) return b;
  if (is_constant(b, 1.0)) return a;
  if (is_constant(a, -1.0)) return negate(b);
  if (is_constant(b, -1.0)) return negate(a);
  if (a > b) std::swap(a, b);
  const double x = node(a).value, y = node(b).value;
  const bool exact = is_constant(a) && is_constant(b) && std::isfinite(x * y) && std::fma(x, y, -(x * y)) == 0.0;
  return folded(exact, x * y, {Operation::multiply, a, b, 0.0});
}

int Graph::divide(int a, int b) {
  if (is_constant(a, 0.0)) return constant(0.0);
  if (is_constant(b, 1.0)) return a;
  if (is_constant(b, -1.0)) return negate(a);
  const double x = node(a).value, y = node(b).value;
  const bool exact = is_constant(a) && is_constant(b) && std::isfinite(x / y) && std::fma(x / y, y, -x) == 0.0;
  return folded(exact, x / y, {Operation::divide, a, b, 0.0});
}

int Graph::negate(int a) {
  if (is_constant(a)) return constant(-node(a).value);
  if (node(a).operation == Operation::negate) return node(a).first;
  return place({Operation::negate, a, -1, 0.0});
}

int Graph::sqrt(int a) {
  const double root = std::sqrt(node(a).value);
  return folded(is_constant(a) && is_whole(root) && root * root == node(a).value, root, {Operation::sqrt, a, -1, 0.0});
}

int Graph::exp(int a) { return is_constant(a, 0.0) ? constant(1.0) : place({Operation::exp, a, -1, 0.0}); }

int Graph::log(int a) {
  return is_constant(a, 1.0) ? constant(0.0) : place({Operation::log, a, divide(constant(1.0), a), 0.0});
}

int Graph::sin(int a) {
  if (is_constant(a, 0.0)) return constant(0.0);
  const int sine = place({Operation::sine, a, -1, 0.0});
  place({Operation::cosine, a, -1, 0.0});
  return sine;
}

int Graph::cos(int a) {
  if (is_constant(a, 0.0)) return constant(1.0);
  return sin(a) + 1;
}

int Graph::tan(int a) { return divide(sin(a), cos(a)); }

int Graph::asin(int a) {
  const int one = constant(1.0);
  return place({Operation::asin, a, divide(one, sqrt(subtract(one, multiply(a, a)))), 0.0});
}

int Graph::acos(int a) {
  const int one = constant(1.0);
  return place({Operation::acos, a, divide(constant(-1.0), sqrt(subtract(one, multiply(a, a)))), 0.0});
}

int Graph::atan(int a) {
  if (is_constant(a, 0.0)) return a;
  const int one = constant(1.0);
  return place({Operation::atan, a, divide(one, add(one, multiply(a, a))), 0.0});
}

int Graph::sinh(int a) { return multiply(subtract(exp(a), exp(negate(a))), constant(0.5)); }

int Graph::cosh(int a) { return multiply(add(exp(a), exp(negate(a))), constant(0.5)); }

int Graph::tanh(int a) {
  if (is_constant(a, 0.0)) return a;
  const int result = place({Operation::tanh, a, -1, 0.0});
  place({Operation::slope, a, -1, 0.0});
  return result;
}

int Graph::erf(int a) {
  const int bell = exp(negate(multiply(a, a)));
  return place({Operation::erf, a, divide(multiply(constant(2.0), bell), sqrt(pi())), 0.0});
}

int Graph::atan2(int y, int x) {
  const int distance = sqrt(add(multiply(x, x), multiply(y, y)));
  return multiply(constant(2.0), atan(divide(y, add(distance, x))));
}

int Graph::product(int base, int exponent) {
  if (exponent == 1) return base;
  const int half = product(base, exponent / 2);
  const int square = multiply(half, half);
  return exponent % 2 == 0 ? square : multiply(square, base);
}

int Graph::power(int base, int exponent) {
  constexpr double most = 64.0;  // beyond, products lose as many digits as the logarithm
  const double twice = 2.0 * node(exponent).value;
  if (!is_constant(exponent) || !is_whole(twice) || std::abs(twice) > 2.0 * most) {
    if (is_constant(base, 1.0)) return base;
    return exp(multiply(exponent, log(base)));
  }
  if (twice == 0.0) return constant(1.0);
  const int halves = static_cast<int>(std::abs(twice));
  int value = halves == 1 ? -1 : product(base, halves / 2);
  if (halves % 2 == 1) value = value < 0 ? sqrt(base) : multiply(value, sqrt(base));
  return twice < 0.0 ? divide(constant(1.0), value) : value;
}

int Graph::again(const Node& node, int a, int b) {
  switch (node.operation) {
    case Operation::add: return add(a, b);
    case Operation::subtract: return subtract(a, b);
    case Operation::multiply: return multiply(a, b);
    case Operation::divide: return divide(a, b);
    case Operation::negate: return negate(a);
    case Operation::sqrt: return sqrt(a);
    case Operation::exp: return exp(a);
    case Operation::sine: return sin(a);
    case Operation::cosine: return cos(a);
    case Operation::tanh: return tanh(a);
    case Operation::slope: {
      const int tangent = tanh(a);
      return is_constant(tangent) ? constant(1.0) : tangent + 1;
    }
    case Operation::log: return log(a);
    case Operation::asin: return asin(a);
    case Operation::acos: return acos(a);
    case Operation::atan: return atan(a);
    case Operation::erf: return erf(a);
    default: break;
  }
  core::require(false, "a leaf does nothing with operands");
  return -1;
}

std::vector<bool> needed_for(const Graph& graph, std::span<const int> outputs) {
  std::vector<bool> needed(graph.nodes().size(), false);
  for (const int output : outputs) needed[static_cast<std::size_t>(output)] = true;
  for (std::size_t n = graph.nodes().size(); n-- > 0;) {
    const Node& node = graph.nodes()[n];
    if (!needed[n] || is_leaf(node.operation)) continue;
    needed[static_cast<std::size_t>(node.first)] = true;
    const bool has_derivative = node.operation >= Operation::log;
    if (node.second >= 0 && !has_derivative) needed[static_cast<std::size_t>(node.second)] = true;
  }
  return needed;
}

}  // namespace orbweaver::model
