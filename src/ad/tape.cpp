#include "orbweaver/ad/tape.hpp"

#include <utility>

namespace orbweaver::ad {

namespace {

thread_local Recording* current = nullptr;

const Tape::Node& at(Recorded x) { return current->tape().nodes[static_cast<std::size_t>(x.node())]; }

bool is_constant(Recorded x, double value) { return at(x).operation == Operation::constant && at(x).value == value; }

}  // namespace

Recording::Recording() {
  core::require(current == nullptr, "one recording at a time");
  current = this;
}

Recording::~Recording() { current = nullptr; }

int Recording::append(const Tape::Node& node) {
  const auto [known, is_new] =
      _known.try_emplace({node.operation, node.first, node.second, node.value}, static_cast<int>(_tape.nodes.size()));
  if (is_new) _tape.nodes.push_back(node);
  return known->second;
}

Recorded Recording::input(int number) { return Recorded(Operation::input, number); }

Recorded Recording::parameter(int number) { return Recorded(Operation::parameter, number); }

Recorded::Recorded(Operation operation, int first, int second, double value) {
  core::require(current != nullptr, "a recorded number is made within a recording");
  _node = current->append({operation, first, second, value});
}

Recorded::Recorded(double constant) : Recorded(Operation::constant, -1, -1, constant) {}

Recorded operator+(Recorded a, Recorded b) {
  if (is_constant(a, 0.0)) return b;
  if (is_constant(b, 0.0)) return a;
  if (a.node() > b.node()) std::swap(a, b);
  return Recorded(Operation::add, a.node(), b.node());
}

Recorded operator-(Recorded a, Recorded b) {
  if (is_constant(b, 0.0)) return a;
  if (is_constant(a, 0.0)) return -b;
  return Recorded(Operation::subtract, a.node(), b.node());
}

Recorded operator*(Recorded a, Recorded b) {
  if (is_constant(a, 0.0) || is_constant(b, 0.0)) return 0.0;
  if (is_constant(a, 1.0)) return b;
  if (is_constant(b, 1.0)) return a;
  if (a.node() > b.node()) std::swap(a, b);
  return Recorded(Operation::multiply, a.node(), b.node());
}

Recorded operator/(Recorded a, Recorded b) {
  if (is_constant(a, 0.0)) return 0.0;
  if (is_constant(b, 1.0)) return a;
  return Recorded(Operation::divide, a.node(), b.node());
}

Recorded operator-(Recorded a) {
  if (at(a).operation == Operation::constant) return at(a).value == 0.0 ? Recorded(0.0) : Recorded(-at(a).value);
  return Recorded(Operation::negate, a.node());
}

Recorded sqrt(Recorded x) { return Recorded(Operation::sqrt, x.node()); }

Recorded exp(Recorded x) { return Recorded(Operation::exp, x.node()); }

Recorded sin(Recorded x) {
  const Recorded sine(Operation::sine, x.node());
  static_cast<void>(Recorded(Operation::cosine, x.node()));
  return sine;
}

Recorded cos(Recorded x) {
  static_cast<void>(Recorded(Operation::sine, x.node()));
  return Recorded(Operation::cosine, x.node());
}

Recorded tan(Recorded x) { return sin(x) / cos(x); }

Recorded log(Recorded x) { return Recorded(Operation::log, x.node(), (1.0 / x).node()); }

Recorded asin(Recorded x) { return Recorded(Operation::asin, x.node(), (1.0 / sqrt(1.0 - x * x)).node()); }

Recorded acos(Recorded x) { return Recorded(Operation::acos, x.node(), (-1.0 / sqrt(1.0 - x * x)).node()); }

Recorded atan(Recorded x) { return Recorded(Operation::atan, x.node(), (1.0 / (1.0 + x * x)).node()); }

Recorded sinh(Recorded x) { return (exp(x) - exp(-x)) * 0.5; }

Recorded cosh(Recorded x) { return (exp(x) + exp(-x)) * 0.5; }

Recorded tanh(Recorded x) { return sinh(x) / cosh(x); }

Recorded pow(Recorded x, double exponent) {
  if (exponent == 0.0) return 1.0;
  if (exponent == 1.0) return x;
  return Recorded(Operation::power, x.node(), -1, exponent);
}

}  // namespace orbweaver::ad
