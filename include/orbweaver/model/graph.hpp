#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <tuple>
#include <vector>

namespace orbweaver::model {

/// What a node of a graph does with its operands.
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
  tanh,    ///< the next node is the slope 1 - tanh^2 of the same operand
  slope,   ///< the node before is the tanh
  log,     ///< `second` is the derivative 1/x; as those of the next four theirs
  asin,
  acos,
  atan,
  erf,
};

[[nodiscard]] constexpr bool is_leaf(Operation operation) { return operation <= Operation::constant; }

struct Node {
  Operation operation = Operation::constant;
  int first = -1;   ///< operand, or number of the input or parameter
  int second = -1;  ///< operand
  double value = 0.0;
};

/// The operations of a model, each once, operands before what uses them (a code list: Griewank and Walther 2008,
/// Evaluating Derivatives, doi:10.1137/1.9780898717761, section 2.2): run by whoever knows an arithmetic. Functions
/// give numbers of nodes.
///
/// Constants are doubles and exact: what is none (1/3, 0.1, pi) is an operation on constants. Sums with 0, products
/// with 0 and 1, and operations on constants whose result a double has are done at once; the order of sums and products
/// stays as it is written.
class Graph {
 public:
  [[nodiscard]] const std::vector<Node>& nodes() const { return _nodes; }
  [[nodiscard]] const Node& node(int n) const { return _nodes[static_cast<std::size_t>(n)]; }
  [[nodiscard]] int size() const { return static_cast<int>(_nodes.size()); }
  [[nodiscard]] bool is_constant(int n) const { return node(n).operation == Operation::constant; }
  [[nodiscard]] bool is_constant(int n, double value) const { return is_constant(n) && node(n).value == value; }

  int input(int number);
  int parameter(int number);
  int constant(double value);
  /// significand * 10^exponent, exact in every arithmetic that holds its quotient.
  int decimal(double significand, int exponent);
  int pi();

  int add(int a, int b);
  int subtract(int a, int b);
  int multiply(int a, int b);
  int divide(int a, int b);
  int negate(int a);
  int sqrt(int a);
  int exp(int a);
  int log(int a);
  int sin(int a);
  int cos(int a);
  int tan(int a);
  int asin(int a);
  int acos(int a);
  int atan(int a);
  int sinh(int a);
  int cosh(int a);
  int tanh(int a);
  int erf(int a);
  /// The angle of (x, y); its cut is the negative axis of x.
  int atan2(int y, int x);
  /// By products and roots where the exponent is a multiple of 1/2, else by the logarithm of a positive base.
  int power(int base, int exponent);
  /// What a node that is no leaf does, with other operands; `b` is of use where it has two.
  int again(const Node& node, int a, int b);

 private:
  int place(const Node& node);
  int product(int base, int exponent);
  /// The constant `value` if `exact`, else the node.
  int folded(bool exact, double value, const Node& node);

  std::vector<Node> _nodes;
  std::map<std::tuple<Operation, int, int, double>, int> _known;
};

/// Which nodes the outputs need, themselves among them.
[[nodiscard]] std::vector<bool> needed_for(const Graph& graph, std::span<const int> outputs);

}  // namespace orbweaver::model
