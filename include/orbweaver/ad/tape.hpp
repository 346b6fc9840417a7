#pragma once

#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "orbweaver/core/error.hpp"

namespace orbweaver::ad {

/// What a node of a tape does with its operands.
enum class Operation {
  input,      ///< number `first` of the inputs
  parameter,  ///< number `first` of the parameters
  constant,   ///< `value`
  add,
  subtract,
  multiply,
  divide,
  negate,
  sqrt,
  exp,
  sine,    ///< the next node is the cosine of the same operand
  cosine,  ///< the node before is the sine
  log,     ///< `second` is the derivative 1/x; as those of the next three theirs
  asin,
  acos,
  atan,
  power,  ///< to the constant exponent `value`
};

/// The operations of a function that is written for any scalar, in the order in which it does them (a code list:
/// Griewank and Walther 2008, Evaluating Derivatives, doi:10.1137/1.9780898717761, section 2.2): run by whoever knows
/// an arithmetic, of many digits or of Taylor series, which the function itself need not be compiled for.
struct Tape {
  struct Node {
    Operation operation = Operation::constant;
    int first = -1;   ///< operand, or number of the input or parameter
    int second = -1;  ///< operand
    double value = 0.0;
  };
  std::vector<Node> nodes;  ///< operands come before what uses them
};

/// The scalar that writes a tape. Constants are doubles and exact: a number that is none (1/3) is written as a quotient
/// of scalars. Equal operations are written once, sums with 0 and products with 0 and 1 not at all.
class Recorded {
 public:
  Recorded() = default;
  Recorded(double constant);

  [[nodiscard]] int node() const { return _node; }

  friend Recorded operator+(Recorded a, Recorded b);
  friend Recorded operator-(Recorded a, Recorded b);
  friend Recorded operator*(Recorded a, Recorded b);
  friend Recorded operator/(Recorded a, Recorded b);
  friend Recorded operator-(Recorded a);
  Recorded& operator+=(Recorded b) { return *this = *this + b; }
  Recorded& operator-=(Recorded b) { return *this = *this - b; }
  Recorded& operator*=(Recorded b) { return *this = *this * b; }
  Recorded& operator/=(Recorded b) { return *this = *this / b; }
  friend Recorded sqrt(Recorded x);
  friend Recorded exp(Recorded x);
  friend Recorded log(Recorded x);
  friend Recorded sin(Recorded x);
  friend Recorded cos(Recorded x);
  friend Recorded tan(Recorded x);
  friend Recorded asin(Recorded x);
  friend Recorded acos(Recorded x);
  friend Recorded atan(Recorded x);
  friend Recorded sinh(Recorded x);
  friend Recorded cosh(Recorded x);
  friend Recorded tanh(Recorded x);
  friend Recorded pow(Recorded x, double exponent);

 private:
  friend class Recording;
  explicit Recorded(Operation operation, int first, int second = -1, double value = 0.0);
  int _node;
};

/// While it lives, what this thread does with Recorded numbers goes onto its tape. One at a time; Recorded numbers are
/// used within their own recording only.
class Recording {
 public:
  Recording();
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  [[nodiscard]] Recorded input(int number);
  [[nodiscard]] Recorded parameter(int number);
  [[nodiscard]] const Tape& tape() const { return _tape; }

 private:
  friend class Recorded;
  [[nodiscard]] int append(const Tape::Node& node);

  Tape _tape;
  std::map<std::tuple<Operation, int, int, double>, int> _known;
};

/// The values of the nodes `outputs` of a tape in the arithmetic of S: only what they need is computed. S has the
/// functions of the standard library, found by its namespace.
template <class S>
[[nodiscard]] std::vector<S> evaluate(const Tape& tape, std::span<const int> outputs, std::span<const S> inputs,
                                      std::span<const S> parameters) {
  using std::acos, std::asin, std::atan, std::cos, std::exp, std::log, std::pow, std::sin, std::sqrt;
  std::vector<bool> needed(tape.nodes.size(), false);
  for (const int output : outputs) needed[static_cast<std::size_t>(output)] = true;
  for (std::size_t n = tape.nodes.size(); n-- > 0;) {
    const Tape::Node& node = tape.nodes[n];
    if (!needed[n] || node.operation == Operation::input || node.operation == Operation::parameter) continue;
    if (node.first >= 0) needed[static_cast<std::size_t>(node.first)] = true;
    if (node.second >= 0) needed[static_cast<std::size_t>(node.second)] = true;
  }
  std::vector<S> values(tape.nodes.size());
  for (std::size_t n = 0; n < tape.nodes.size(); ++n) {
    if (!needed[n]) continue;
    const Tape::Node& node = tape.nodes[n];
    const auto first = static_cast<std::size_t>(node.first);
    const auto operand = [&](int number) -> const S& { return values[static_cast<std::size_t>(number)]; };
    switch (node.operation) {
      case Operation::input: values[n] = inputs[first]; break;
      case Operation::parameter: values[n] = parameters[first]; break;
      case Operation::constant: values[n] = S(node.value); break;
      case Operation::add: values[n] = operand(node.first) + operand(node.second); break;
      case Operation::subtract: values[n] = operand(node.first) - operand(node.second); break;
      case Operation::multiply: values[n] = operand(node.first) * operand(node.second); break;
      case Operation::divide: values[n] = operand(node.first) / operand(node.second); break;
      case Operation::negate: values[n] = -operand(node.first); break;
      case Operation::sqrt: values[n] = sqrt(operand(node.first)); break;
      case Operation::exp: values[n] = exp(operand(node.first)); break;
      case Operation::sine: values[n] = sin(operand(node.first)); break;
      case Operation::cosine: values[n] = cos(operand(node.first)); break;
      case Operation::log: values[n] = log(operand(node.first)); break;
      case Operation::asin: values[n] = asin(operand(node.first)); break;
      case Operation::acos: values[n] = acos(operand(node.first)); break;
      case Operation::atan: values[n] = atan(operand(node.first)); break;
      case Operation::power: values[n] = pow(operand(node.first), S(node.value)); break;
    }
  }
  std::vector<S> results;
  for (const int output : outputs) results.push_back(values[static_cast<std::size_t>(output)]);
  return results;
}

}  // namespace orbweaver::ad
