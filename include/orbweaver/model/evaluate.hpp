#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "orbweaver/core/error.hpp"
#include "orbweaver/model/graph.hpp"

namespace orbweaver::model {

/// The values of the nodes `outputs` of a graph in the arithmetic of S: only what they need is computed. S has the
/// functions of the standard library, found by its namespace.
template <class S>
[[nodiscard]] std::vector<S> evaluate(const Graph& graph, std::span<const int> outputs, std::span<const S> inputs,
                                      std::span<const S> parameters) {
  using std::acos, std::asin, std::atan, std::cos, std::erf, std::exp, std::log, std::sin, std::sqrt, std::tanh;
  const std::vector<bool> needed = needed_for(graph, outputs);
  std::vector<S> values(graph.nodes().size());
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (!needed[n]) continue;
    const Node& node = graph.nodes()[n];
    const auto number = static_cast<std::size_t>(node.first);
    const auto a = [&]() -> const S& { return values[number]; };
    const auto b = [&]() -> const S& { return values[static_cast<std::size_t>(node.second)]; };
    switch (node.operation) {
      case Operation::input: values[n] = inputs[number]; break;
      case Operation::parameter: values[n] = parameters[number]; break;
      case Operation::constant: values[n] = S(node.value); break;
      case Operation::add: values[n] = a() + b(); break;
      case Operation::subtract: values[n] = a() - b(); break;
      case Operation::multiply: values[n] = a() * b(); break;
      case Operation::divide: values[n] = a() / b(); break;
      case Operation::negate: values[n] = -a(); break;
      case Operation::sqrt: values[n] = sqrt(a()); break;
      case Operation::exp: values[n] = exp(a()); break;
      case Operation::sine: values[n] = sin(a()); break;
      case Operation::cosine: values[n] = cos(a()); break;
      case Operation::tanh: values[n] = tanh(a()); break;
      case Operation::slope: {
        const S tangent = tanh(a());
        values[n] = S(1.0) - tangent * tangent;
        break;
      }
      case Operation::log: values[n] = log(a()); break;
      case Operation::asin: values[n] = asin(a()); break;
      case Operation::acos: values[n] = acos(a()); break;
      case Operation::atan: values[n] = atan(a()); break;
      case Operation::erf:
        if constexpr (requires(const S& x) { erf(x); })
          values[n] = erf(a());
        else
          core::require(false, "an arithmetic without the error function");
        break;
    }
  }
  std::vector<S> results;
  for (const int output : outputs) results.push_back(values[static_cast<std::size_t>(output)]);
  return results;
}

}  // namespace orbweaver::model
