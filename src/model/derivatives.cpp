#include "orbweaver/model/derivatives.hpp"

#include <algorithm>

namespace orbweaver::model {

namespace {

/// Sums and products of nodes of which -1 is zero.
class Sparse {
 public:
  explicit Sparse(Graph& graph) : _graph(graph) {}
  [[nodiscard]] int sum(int a, int b) const { return a < 0 ? b : b < 0 ? a : kept(_graph.add(a, b)); }
  [[nodiscard]] int difference(int a, int b) const {
    return b < 0 ? a : a < 0 ? kept(_graph.negate(b)) : kept(_graph.subtract(a, b));
  }
  [[nodiscard]] int product(int a, int b) const { return a < 0 || b < 0 ? -1 : kept(_graph.multiply(a, b)); }
  [[nodiscard]] int negative(int a) const { return a < 0 ? -1 : kept(_graph.negate(a)); }

 private:
  [[nodiscard]] int kept(int a) const { return _graph.is_constant(a, 0.0) ? -1 : a; }
  Graph& _graph;
};

/// The derivative of a node by its first operand, and by its second where it has two.
struct Partial {
  int first = -1;
  int second = -1;
};

Partial partial(Graph& graph, int n) {
  const Node node = graph.node(n);
  const int one = graph.constant(1.0);
  switch (node.operation) {
    case Operation::input:
    case Operation::parameter:
    case Operation::constant: return {};
    case Operation::add: return {one, one};
    case Operation::subtract: return {one, graph.constant(-1.0)};
    case Operation::multiply: return {node.second, node.first};
    case Operation::divide: {
      const int share = graph.divide(one, node.second);
      return {share, graph.negate(graph.multiply(n, share))};
    }
    case Operation::negate: return {graph.constant(-1.0), -1};
    case Operation::sqrt: return {graph.divide(graph.constant(0.5), n), -1};
    case Operation::exp: return {n, -1};
    case Operation::sine: return {n + 1, -1};
    case Operation::cosine: return {graph.negate(n - 1), -1};
    case Operation::tanh: return {n + 1, -1};
    case Operation::slope: return {graph.multiply(graph.constant(-2.0), graph.multiply(n - 1, n)), -1};
    case Operation::log:
    case Operation::asin:
    case Operation::acos:
    case Operation::atan:
    case Operation::erf: return {node.second, -1};
  }
  return {};
}

}  // namespace

std::vector<int> derivatives_along(Graph& graph, std::span<const int> outputs, const Direction& direction) {
  const Sparse sparse(graph);
  const std::vector<bool> needed = needed_for(graph, outputs);
  std::vector<int> moved(needed.size(), -1);
  const auto of = [](const std::vector<int>& list, int number) {
    return static_cast<std::size_t>(number) < list.size() ? list[static_cast<std::size_t>(number)] : -1;
  };
  const auto at = [&](int n) { return n < 0 ? -1 : moved[static_cast<std::size_t>(n)]; };
  for (std::size_t n = 0; n < needed.size(); ++n) {
    if (!needed[n]) continue;
    const Node node = graph.nodes()[n];
    if (node.operation == Operation::input) {
      moved[n] = of(direction.inputs, node.first);
    } else if (node.operation == Operation::parameter) {
      moved[n] = of(direction.parameters, node.first);
    } else if (node.operation == Operation::divide) {
      if (at(node.first) < 0 && at(node.second) < 0) continue;
      const int share = graph.divide(graph.constant(1.0), node.second);
      moved[n] = sparse.product(sparse.difference(at(node.first), sparse.product(static_cast<int>(n), at(node.second))),
                                share);
    } else if (!is_leaf(node.operation)) {
      const bool binary = node.operation <= Operation::multiply;
      if (at(node.first) < 0 && (!binary || at(node.second) < 0)) continue;
      const Partial slopes = partial(graph, static_cast<int>(n));
      moved[n] = sparse.product(at(node.first), slopes.first);
      if (binary) moved[n] = sparse.sum(moved[n], sparse.product(at(node.second), slopes.second));
    }
  }
  std::vector<int> results;
  for (const int output : outputs) results.push_back(at(output));
  return results;
}

std::vector<int> gradient(Graph& graph, int output, std::span<const int> inputs) {
  const Sparse sparse(graph);
  const std::vector<int> outputs{output};
  const std::vector<bool> needed = needed_for(graph, outputs);
  std::vector<int> adjoint(needed.size(), -1);
  adjoint[static_cast<std::size_t>(output)] = graph.constant(1.0);
  const auto give = [&](int n, int share) {
    int& own = adjoint[static_cast<std::size_t>(n)];
    own = sparse.sum(own, share);
  };
  for (std::size_t n = needed.size(); n-- > 0;) {
    const Node node = graph.nodes()[n];
    if (adjoint[n] < 0 || is_leaf(node.operation)) continue;
    const Partial slopes = partial(graph, static_cast<int>(n));
    give(node.first, sparse.product(adjoint[n], slopes.first));
    if (node.operation <= Operation::divide) give(node.second, sparse.product(adjoint[n], slopes.second));
  }
  std::vector<int> results;
  for (const int number : inputs) {
    int found = -1;
    for (std::size_t n = 0; n < needed.size() && found < 0; ++n)
      if (needed[n] && graph.nodes()[n].operation == Operation::input && graph.nodes()[n].first == number)
        found = adjoint[n];
    results.push_back(found);
  }
  return results;
}

std::vector<int> jacobian(Graph& graph, std::span<const int> outputs, int inputs) {
  const auto columns = static_cast<std::size_t>(inputs);
  std::vector<int> entries(outputs.size() * columns);
  const int zero = graph.constant(0.0);
  for (std::size_t l = 0; l < columns; ++l) {
    Direction direction;
    direction.inputs.assign(columns, -1);
    direction.inputs[l] = graph.constant(1.0);
    const std::vector<int> column = derivatives_along(graph, outputs, direction);
    for (std::size_t i = 0; i < outputs.size(); ++i) entries[i * columns + l] = column[i] < 0 ? zero : column[i];
  }
  return entries;
}

std::vector<int> substituted(Graph& graph, std::span<const int> outputs, const Direction& others) {
  const std::vector<bool> needed = needed_for(graph, outputs);
  std::vector<int> place(needed.size(), -1);
  const auto other = [](const std::vector<int>& list, int number, int own) {
    return static_cast<std::size_t>(number) < list.size() ? list[static_cast<std::size_t>(number)] : own;
  };
  for (std::size_t n = 0; n < needed.size(); ++n) {
    if (!needed[n]) continue;
    const Node node = graph.nodes()[n];
    const auto own = static_cast<int>(n);
    const int a = is_leaf(node.operation) ? -1 : place[static_cast<std::size_t>(node.first)];
    const int b = is_leaf(node.operation) || node.second < 0 ? -1 : place[static_cast<std::size_t>(node.second)];
    if (node.operation == Operation::input)
      place[n] = other(others.inputs, node.first, own);
    else if (node.operation == Operation::parameter)
      place[n] = other(others.parameters, node.first, own);
    else
      place[n] = node.operation == Operation::constant ? own : graph.again(node, a, b);
  }
  std::vector<int> results;
  for (const int output : outputs) results.push_back(place[static_cast<std::size_t>(output)]);
  return results;
}

}  // namespace orbweaver::model
