#include "orbweaver/survey/tree/family_end.hpp"

#include <fmt/format.h>

#include "orbweaver/continuation/ending.hpp"

namespace orbweaver::survey {

namespace {

constexpr std::string_view forwards_mark = "forwards: ";
constexpr std::string_view backwards_mark = "; backwards: ";

EndKind end_in(std::string_view text) {
  for (int n = 0; n < static_cast<int>(EndKind::unknown); ++n)
    if (const auto kind = static_cast<EndKind>(n); text.starts_with(name_of(kind))) return kind;
  return EndKind::unknown;
}

}  // namespace

std::string_view name_of(EndKind kind) {
  using continuation::EndReason;
  switch (kind) {
    case EndKind::period_limit: return continuation::name_of(EndReason::period_limit);
    case EndKind::energy_limit: return continuation::name_of(EndReason::energy_limit);
    case EndKind::parameter_limit: return continuation::name_of(EndReason::parameter_limit);
    case EndKind::guard_limit: return continuation::name_of(EndReason::guard_limit);
    case EndKind::step_limit: return continuation::name_of(EndReason::step_limit);
    case EndKind::cutoff_limit: return continuation::name_of(EndReason::cutoff_limit);
    case EndKind::period_divergence: return continuation::name_of(EndReason::period_divergence);
    case EndKind::collision: return continuation::name_of(EndReason::collision);
    case EndKind::fixed_point: return continuation::name_of(EndReason::fixed_point);
    case EndKind::closed_loop: return continuation::name_of(EndReason::closed_loop);
    case EndKind::strong_resonance: return continuation::name_of(EndReason::strong_resonance);
    case EndKind::more_symmetry: return continuation::name_of(EndReason::more_symmetry);
    case EndKind::stopped: return continuation::name_of(EndReason::stopped);
    case EndKind::undecided: return continuation::name_of(EndReason::undecided);
    case EndKind::failure: return continuation::name_of(EndReason::failure);
    case EndKind::met: return "met a family of more symmetry";
    case EndKind::joined: return "joined";
    case EndKind::unknown: break;
  }
  return "unknown";
}

std::string both_ends_text(const std::string& forwards, const std::string& backwards) {
  return fmt::format("{}{}{}{}", forwards_mark, forwards, backwards_mark, backwards);
}

std::vector<EndKind> ends_in(std::string_view end_reason) {
  if (!end_reason.starts_with(forwards_mark)) return {end_in(end_reason)};
  const std::size_t middle = end_reason.find(backwards_mark);
  std::vector<EndKind> ends{end_in(end_reason.substr(forwards_mark.size()))};
  if (middle != std::string_view::npos) ends.push_back(end_in(end_reason.substr(middle + backwards_mark.size())));
  return ends;
}

}  // namespace orbweaver::survey
