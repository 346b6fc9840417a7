#include "orbweaver/model/scope.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/document/suggest.hpp"

namespace orbweaver::model {

namespace {

/// Terms of a sum, and steps of a loop over an index.
constexpr long most_terms = 100000;

/// What has no derivative somewhere, and what to write instead.
const std::map<std::string, std::string>& not_smooth() {
  static const std::string step = "a steep smooth step, 0.5*(1 + tanh(x/e)) with a small e";
  static const std::string larger = "0.5*(a + b + sqrt((a - b)^2 + e^2)) with a small e";
  static const std::string smaller = "0.5*(a + b - sqrt((a - b)^2 + e^2)) with a small e";
  static const std::map<std::string, std::string> names{{"abs", "sqrt(x^2 + e^2) with a small e"},
                                                        {"fabs", "sqrt(x^2 + e^2) with a small e"},
                                                        {"sign", "tanh(x/e) with a small e"},
                                                        {"sgn", "tanh(x/e) with a small e"},
                                                        {"max", larger},
                                                        {"min", smaller},
                                                        {"heav", step},
                                                        {"heaviside", step},
                                                        {"if", step},
                                                        {"floor", "a periodic function, or steep smooth steps"},
                                                        {"flr", "a periodic function, or steep smooth steps"},
                                                        {"ceil", "a periodic function, or steep smooth steps"},
                                                        {"round", "a periodic function, or steep smooth steps"},
                                                        {"mod", "an angle (`angles`) and a periodic function of it"}};
  return names;
}

using Unary = int (Graph::*)(int);
const std::map<std::string, Unary>& unary_functions() {
  static const std::map<std::string, Unary> functions{
      {"sqrt", &Graph::sqrt}, {"exp", &Graph::exp},   {"log", &Graph::log},   {"ln", &Graph::log},
      {"sin", &Graph::sin},   {"cos", &Graph::cos},   {"tan", &Graph::tan},   {"asin", &Graph::asin},
      {"acos", &Graph::acos}, {"atan", &Graph::atan}, {"sinh", &Graph::sinh}, {"cosh", &Graph::cosh},
      {"tanh", &Graph::tanh}, {"erf", &Graph::erf}};
  return functions;
}

bool is_function(const std::string& name) {
  return unary_functions().contains(name) || not_smooth().contains(name) || name == "atan2" || name == "pow" ||
         name == "sum";
}

}  // namespace

void Scope::require_free(const std::string& name, const std::string& place) const {
  const auto refuse = [&](const std::string& taken) {
    throw core::InputError(
        fmt::format("{}: expected a name of its own, got `{}`, {}; take another", place, name, taken));
  };
  if (is_function(name)) refuse("which is a function");
  if (name == "pi" || name == "t") refuse(name == "pi" ? "which is a number" : "which is time");
  if (knows(name)) refuse("which stands for something else");
}

bool Scope::knows(const std::string& name) const {
  return _names.contains(name) || _sizes.contains(name) || _definitions.contains(name);
}

void Scope::name(const std::string& name, int node, const std::string& place) {
  if (name != "t") require_free(name, place);
  _names[name] = node;
}

void Scope::size(const std::string& name, long value, const std::string& place) {
  require_free(name, place);
  _sizes[name] = value;
}

void Scope::define(const std::string& name, std::vector<std::string> arguments, PlacedFormula formula,
                   const Indices& indices, bool adds) {
  if (adds) {
    const auto found = _definitions.find(name);
    if (found == _definitions.end() || found->second.arguments != arguments)
      throw core::InputError(fmt::format("{}: expected a definition `{}` to add to, got none; define it in the model",
                                         formula.place, name));
    found->second.terms.push_back(std::move(formula));
    found->second.indices.push_back(indices);
    return;
  }
  require_free(name, formula.place);
  for (const std::string& argument : arguments)
    if (is_function(argument) || argument == "pi" || argument == "t")
      throw core::InputError(fmt::format("{}: expected arguments with names of their own, got `{}`; take another",
                                         formula.place, argument));
  _definitions[name] = {std::move(arguments), {std::move(formula)}, {indices}, -1};
}

int Scope::evaluate(const PlacedFormula& formula, const Indices& indices) {
  const std::map<std::string, int> none;
  return evaluate(formula.formula, {formula, indices, none});
}

int Scope::number(const Formula& part) {
  // Fifteen digits at a time, so that each part is exact.
  constexpr std::size_t chunk = 15;
  int value = -1;
  for (std::size_t at = 0; at < part.text.size(); at += chunk) {
    const std::string digits = part.text.substr(at, chunk);
    const int next = _graph.constant(std::stod(digits));
    value = value < 0 ? next
                      : _graph.add(_graph.multiply(value, _graph.decimal(1.0, static_cast<int>(digits.size()))), next);
  }
  if (part.exponent == 0) return value;
  if (_graph.is_constant(value)) return _graph.decimal(_graph.node(value).value, part.exponent);
  return _graph.multiply(value, _graph.decimal(1.0, part.exponent));
}

int Scope::evaluate(const Formula& part, const Bindings& bindings) {
  if (_graph.size() > most_nodes)
    bindings.formula.fail(
        part.column, fmt::format("expected a model of at most {} operations, got more; make it smaller", most_nodes));
  const auto operand = [&](std::size_t n) { return evaluate(part.parts[n], bindings); };
  switch (part.kind) {
    case Formula::Kind::number: return number(part);
    case Formula::Kind::name: return of_name(part, bindings);
    case Formula::Kind::call: return of_call(part, bindings);
    case Formula::Kind::sum: return of_sum(part, bindings);
    case Formula::Kind::negate: return _graph.negate(operand(0));
    default: break;
  }
  const int a = operand(0);
  const int b = operand(1);
  switch (part.kind) {
    case Formula::Kind::add: return _graph.add(a, b);
    case Formula::Kind::subtract: return _graph.subtract(a, b);
    case Formula::Kind::multiply: return _graph.multiply(a, b);
    case Formula::Kind::divide:
      if (_graph.is_constant(b, 0.0)) bindings.formula.fail(part.column, "expected a divisor that is not 0, got 0");
      return _graph.divide(a, b);
    default: return _graph.power(a, b);
  }
}

std::string Scope::flat(const std::string& name, const std::vector<Formula>& index, const PlacedFormula& formula,
                        const Indices& indices) const {
  std::string result = name.substr(0, name.find('\''));
  for (std::size_t n = 0; n < index.size(); ++n)
    result += fmt::format("{}{}", n == 0 ? "" : "_", whole(formula, index[n], indices));
  return result + name.substr(std::min(name.find('\''), name.size()));
}

int Scope::of_name(const Formula& part, const Bindings& bindings) {
  if (part.index.empty()) {
    if (const auto found = bindings.arguments.find(part.text); found != bindings.arguments.end()) return found->second;
    if (const auto found = bindings.indices.find(part.text); found != bindings.indices.end())
      return _graph.constant(static_cast<double>(found->second));
    if (const auto found = _sizes.find(part.text); found != _sizes.end())
      return _graph.constant(static_cast<double>(found->second));
    if (part.text == "pi") return _graph.pi();
  }
  std::string name = part.text;
  if (!part.index.empty()) {
    const std::size_t prime = std::min(part.text.find('\''), part.text.size());
    const std::string base = part.text.substr(0, prime);
    std::vector<Formula> index = part.index;
    if (const auto found = _ends.find(base); found != _ends.end() && index.size() == 1) {
      const Ends& ends = found->second;
      const long at = whole(bindings.formula, index.front(), bindings.indices);
      const auto beyond = ends.beyond.find(at);
      if (beyond != ends.beyond.end()) {
        if (prime == part.text.size()) return evaluate(beyond->second, bindings.indices);
        bindings.formula.fail(part.column,
                              fmt::format("expected a rate within the ends, got that of {}[{}]", base, at));
      }
      if (ends.cyclic && (at < ends.first || at > ends.last)) {
        const long count = ends.last - ends.first + 1;
        const long wrapped = ends.first + ((at - ends.first) % count + count) % count;
        name = fmt::format("{}{}{}", base, wrapped, part.text.substr(prime));
        index.clear();
      }
    }
    if (!index.empty()) name = flat(part.text, index, bindings.formula, bindings.indices);
  }
  if (const auto found = _names.find(name); found != _names.end()) return found->second;
  const auto definition = _definitions.find(name);
  if (definition == _definitions.end()) refuse_unknown(part, name, bindings);
  if (!definition->second.arguments.empty())
    bindings.formula.fail(part.column, fmt::format("expected `{}({})`, got it without arguments", name,
                                                   fmt::join(definition->second.arguments, ", ")));
  return of_definition(name, {}, part, bindings);
}

void Scope::refuse_unknown(const Formula& part, const std::string& name, const Bindings& bindings) const {
  if (name == "t")
    bindings.formula.fail(part.column, "expected nothing of time, got `t`, which may stand in the equations only");
  std::vector<std::string> known{"pi"};
  for (const auto& [own, node] : _names) known.push_back(own);
  for (const auto& [own, value] : _sizes) known.push_back(own);
  for (const auto& [own, definition] : _definitions) known.push_back(own);
  for (const auto& [own, node] : bindings.arguments) known.push_back(own);
  const std::string near = document::nearest(name, known);
  if (unary_functions().contains(name))
    bindings.formula.fail(part.column, fmt::format("expected `{}(...)`, got it without an argument", name));
  bindings.formula.fail(part.column, fmt::format("expected a name that stands for something, got `{}`; {}", name,
                                                 near.empty() ? "add it to `parameters` or `definitions`"
                                                              : fmt::format("did you mean `{}`?", near)));
}

int Scope::of_call(const Formula& part, const Bindings& bindings) {
  const auto require_count = [&](std::size_t count) {
    if (part.parts.size() != count)
      bindings.formula.fail(part.column, fmt::format("expected {} argument{} of `{}`, got {}", count,
                                                     count == 1 ? "" : "s", part.text, part.parts.size()));
  };
  const auto definition = _definitions.find(part.text);
  if (definition != _definitions.end()) {
    require_count(definition->second.arguments.size());
    std::map<std::string, int> arguments;
    for (std::size_t n = 0; n < part.parts.size(); ++n)
      arguments[definition->second.arguments[n]] = evaluate(part.parts[n], bindings);
    return of_definition(part.text, arguments, part, bindings);
  }
  if (const auto reason = not_smooth().find(part.text); reason != not_smooth().end())
    bindings.formula.fail(part.column,
                          fmt::format("expected a function with derivatives everywhere, got `{}`; instead take {}",
                                      part.text, reason->second));
  if (part.text == "atan2" || part.text == "pow") {
    require_count(2);
    const int a = evaluate(part.parts[0], bindings);
    const int b = evaluate(part.parts[1], bindings);
    return part.text == "pow" ? _graph.power(a, b) : _graph.atan2(a, b);
  }
  const auto function = unary_functions().find(part.text);
  if (function == unary_functions().end()) {
    if (_names.contains(part.text) || bindings.arguments.contains(part.text))
      bindings.formula.fail(part.column, fmt::format("expected an operator behind `{0}`, got `(`; products are written "
                                                     "with `*`, as in {0}*(...)",
                                                     part.text));
    std::vector<std::string> known = function_names();
    for (const auto& [own, one] : _definitions)
      if (!one.arguments.empty()) known.push_back(own);
    const std::string near = document::nearest(part.text, known);
    bindings.formula.fail(part.column,
                          fmt::format("expected a function, got `{}`; {}", part.text,
                                      near.empty() ? fmt::format("there are {}", fmt::join(function_names(), ", "))
                                                   : fmt::format("did you mean `{}`?", near)));
  }
  require_count(1);
  return (_graph.*function->second)(evaluate(part.parts[0], bindings));
}

int Scope::of_sum(const Formula& part, const Bindings& bindings) {
  const long first = whole(bindings.formula, part.parts[0], bindings.indices);
  const long last = whole(bindings.formula, part.parts[1], bindings.indices);
  if (last - first >= most_terms)
    bindings.formula.fail(part.column, fmt::format("expected a sum of at most {} terms, got more", most_terms));
  Indices indices = bindings.indices;
  int total = _graph.constant(0.0);
  for (long at = first; at <= last; ++at) {
    indices[part.text] = at;
    total = _graph.add(total, evaluate(part.parts[2], {bindings.formula, indices, bindings.arguments}));
  }
  return total;
}

int Scope::of_definition(const std::string& name, const std::map<std::string, int>& arguments, const Formula& part,
                         const Bindings& bindings) {
  Definition& definition = _definitions.at(name);
  if (definition.node >= 0) return definition.node;
  if (std::find(_open.begin(), _open.end(), name) != _open.end())
    bindings.formula.fail(
        part.column, fmt::format("expected definitions without circles, got {} -> {}", fmt::join(_open, " -> "), name));
  if (_open.size() > static_cast<std::size_t>(most_levels))
    bindings.formula.fail(part.column, fmt::format("expected definitions at most {} deep, got more", most_levels));
  _open.push_back(name);
  int total = -1;
  for (std::size_t n = 0; n < definition.terms.size(); ++n) {
    const int term = evaluate(definition.terms[n].formula, {definition.terms[n], definition.indices[n], arguments});
    total = total < 0 ? term : _graph.add(total, term);
  }
  _open.pop_back();
  if (definition.arguments.empty()) definition.node = total;
  return total;
}

long Scope::whole(const PlacedFormula& formula, const Formula& part, const Indices& indices) const {
  const auto refuse = [&] { formula.fail(part.column, "expected a whole number made of indices, sizes and numbers"); };
  const auto operand = [&](std::size_t n) { return whole(formula, part.parts[n], indices); };
  constexpr long most = 1000000;
  const auto within = [&](long value) {
    if (std::abs(value) > most) refuse();
    return value;
  };
  switch (part.kind) {
    case Formula::Kind::number:
      if (part.exponent != 0 || part.text.size() > 6) refuse();
      return std::stol(part.text);
    case Formula::Kind::name:
      if (part.index.empty()) {
        if (const auto found = indices.find(part.text); found != indices.end()) return found->second;
        if (const auto found = _sizes.find(part.text); found != _sizes.end()) return found->second;
      }
      refuse();
      return 0;
    case Formula::Kind::negate: return -operand(0);
    case Formula::Kind::add: return within(operand(0) + operand(1));
    case Formula::Kind::subtract: return within(operand(0) - operand(1));
    case Formula::Kind::multiply: return within(operand(0) * operand(1));
    case Formula::Kind::divide: {
      const long divisor = operand(1);
      if (divisor == 0 || operand(0) % divisor != 0) refuse();
      return operand(0) / divisor;
    }
    default: refuse(); return 0;
  }
}

}  // namespace orbweaver::model
