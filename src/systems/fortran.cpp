#include "orbweaver/systems/fortran.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "orbweaver/model/evaluate.hpp"

namespace orbweaver::systems {

namespace {

thread_local std::vector<std::string>* written = nullptr;

/// While it lives, what this thread does with terms goes into these lines.
class Writing {
 public:
  explicit Writing(std::vector<std::string>& lines) { written = &lines; }
  ~Writing() { written = nullptr; }
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;
};

/// A scalar that writes what is done with it.
struct Term {
  Term() = default;
  explicit Term(double value) : text(fortran_literal(value)) {}
  explicit Term(std::string given) : text(std::move(given)) {}

  std::string text;
};

Term assigned(const std::string& expression) {
  std::string name = fmt::format("v({})", written->size() + 1);
  written->push_back(fmt::format("{}={}", name, expression));
  return Term(std::move(name));
}

Term operator+(const Term& a, const Term& b) { return assigned(a.text + "+" + b.text); }
Term operator-(const Term& a, const Term& b) { return assigned(a.text + "-" + b.text); }
Term operator*(const Term& a, const Term& b) { return assigned(a.text + "*" + b.text); }
Term operator/(const Term& a, const Term& b) { return assigned(a.text + "/" + b.text); }
Term operator-(const Term& a) { return assigned("-" + a.text); }
Term sqrt(const Term& a) { return assigned("SQRT(" + a.text + ")"); }
Term exp(const Term& a) { return assigned("EXP(" + a.text + ")"); }
Term log(const Term& a) { return assigned("LOG(" + a.text + ")"); }
Term sin(const Term& a) { return assigned("SIN(" + a.text + ")"); }
Term cos(const Term& a) { return assigned("COS(" + a.text + ")"); }
Term asin(const Term& a) { return assigned("ASIN(" + a.text + ")"); }
Term acos(const Term& a) { return assigned("ACOS(" + a.text + ")"); }
Term atan(const Term& a) { return assigned("ATAN(" + a.text + ")"); }
Term tanh(const Term& a) { return assigned("TANH(" + a.text + ")"); }
Term erf(const Term& a) { return assigned("ERF(" + a.text + ")"); }

/// The largest number among inputs, or parameters, in a graph, plus one.
std::size_t count_of(const model::Graph& graph, model::Operation operation) {
  int most = -1;
  for (const model::Node& node : graph.nodes())
    if (node.operation == operation) most = std::max(most, node.first);
  return static_cast<std::size_t>(most + 1);
}

std::vector<Term> named(std::size_t count, const std::function<std::string(int)>& name) {
  std::vector<Term> terms;
  for (std::size_t n = 0; n < count; ++n) terms.emplace_back(name(static_cast<int>(n)));
  return terms;
}

}  // namespace

std::string fortran_literal(double value) {
  std::string text = fmt::format("({:.17e})", value);
  std::replace(text.begin(), text.end(), 'e', 'd');
  return text;
}

FortranCode fortran_code(const model::Graph& graph, std::span<const int> outputs,
                         const std::function<std::string(int)>& input,
                         const std::function<std::string(int)>& parameter) {
  FortranCode code;
  const Writing writing(code.lines);
  const std::vector<Term> inputs = named(count_of(graph, model::Operation::input), input);
  const std::vector<Term> parameters = named(count_of(graph, model::Operation::parameter), parameter);
  const std::vector<Term> results = model::evaluate<Term>(graph, outputs, inputs, parameters);
  for (const Term& result : results) code.results.push_back(result.text);
  return code;
}

}  // namespace orbweaver::systems
