#include "orbweaver/model/recorded.hpp"

#include <utility>

#include "orbweaver/core/error.hpp"

namespace orbweaver::model {

namespace {

thread_local Recording* current = nullptr;

Graph& graph() {
  core::require(current != nullptr, "a recorded number is made within a recording");
  return current->graph();
}

}  // namespace

Recording::Recording() : Recording(Graph()) {}

Recording::Recording(Graph graph) : _graph(std::move(graph)) {
  core::require(current == nullptr, "one recording at a time");
  current = this;
}

Recording::~Recording() { current = nullptr; }

Recorded Recording::input(int number) { return Recorded(Recorded::Place{_graph.input(number)}); }

Recorded Recording::parameter(int number) { return Recorded(Recorded::Place{_graph.parameter(number)}); }

Recorded::Recorded(double constant) : _node(graph().constant(constant)) {}

Recorded operator+(Recorded a, Recorded b) { return Recorded(Recorded::Place{graph().add(a._node, b._node)}); }
Recorded operator-(Recorded a, Recorded b) { return Recorded(Recorded::Place{graph().subtract(a._node, b._node)}); }
Recorded operator*(Recorded a, Recorded b) { return Recorded(Recorded::Place{graph().multiply(a._node, b._node)}); }
Recorded operator/(Recorded a, Recorded b) { return Recorded(Recorded::Place{graph().divide(a._node, b._node)}); }
Recorded operator-(Recorded a) { return Recorded(Recorded::Place{graph().negate(a._node)}); }
Recorded sqrt(Recorded x) { return Recorded(Recorded::Place{graph().sqrt(x._node)}); }
Recorded exp(Recorded x) { return Recorded(Recorded::Place{graph().exp(x._node)}); }
Recorded log(Recorded x) { return Recorded(Recorded::Place{graph().log(x._node)}); }
Recorded sin(Recorded x) { return Recorded(Recorded::Place{graph().sin(x._node)}); }
Recorded cos(Recorded x) { return Recorded(Recorded::Place{graph().cos(x._node)}); }
Recorded tan(Recorded x) { return Recorded(Recorded::Place{graph().tan(x._node)}); }
Recorded asin(Recorded x) { return Recorded(Recorded::Place{graph().asin(x._node)}); }
Recorded acos(Recorded x) { return Recorded(Recorded::Place{graph().acos(x._node)}); }
Recorded atan(Recorded x) { return Recorded(Recorded::Place{graph().atan(x._node)}); }
Recorded sinh(Recorded x) { return Recorded(Recorded::Place{graph().sinh(x._node)}); }
Recorded cosh(Recorded x) { return Recorded(Recorded::Place{graph().cosh(x._node)}); }
Recorded tanh(Recorded x) { return Recorded(Recorded::Place{graph().tanh(x._node)}); }
Recorded erf(Recorded x) { return Recorded(Recorded::Place{graph().erf(x._node)}); }
Recorded pow(Recorded x, Recorded exponent) {
  return Recorded(Recorded::Place{graph().power(x._node, exponent._node)});
}

}  // namespace orbweaver::model
