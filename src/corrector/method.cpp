#include "orbweaver/corrector/method.hpp"

#include <array>
#include <string>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

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

}  // namespace orbweaver::corrector
