#include <array>
#include <string>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/correct.hpp"

namespace orbweaver::corrector {

namespace {

struct MethodName {
  Method method;
  std::string_view name;
  bool second_order;
};

constexpr std::array<MethodName, 9> methods{{
    {Method::automatic, "automatic", true},
    {Method::collocation, "collocation", true},
    {Method::newton_krylov, "newton-krylov", true},
    {Method::brgn, "brgn", true},
    {Method::nls, "nls", true},
    {Method::ntr, "ntr", true},
    {Method::lmvm, "lmvm", false},
    {Method::rprop, "rprop", false},
    {Method::rprop_extrapolated, "rprop-extrapolated", false},
}};

}  // namespace

std::string_view name_of(Method method) { return methods.at(static_cast<std::size_t>(method)).name; }

bool is_second_order(Method method) { return methods.at(static_cast<std::size_t>(method)).second_order; }

Method method_of(std::string_view name) {
  std::string known;
  for (const MethodName& m : methods) {
    if (m.name == name) return m.method;
    known += known.empty() ? std::string(m.name) : fmt::format(", {}", m.name);
  }
  throw core::InputError(fmt::format("unknown corrector `{}`: use one of {}", name, known));
}

std::string_view name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged: return "converged";
    case Outcome::under_resolved: return "under-resolved";
    case Outcome::stalled: return "stalled";
    case Outcome::iteration_limit: return "iteration limit";
    case Outcome::period_not_positive: return "period not positive";
    case Outcome::not_finite: return "not finite";
    case Outcome::singular: return "singular";
    case Outcome::solver_failed: return "solver failed";
  }
  return "unknown";
}

}  // namespace orbweaver::corrector
