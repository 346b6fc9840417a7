#include "orbweaver/survey/tree/family_end.hpp"

#include <fmt/format.h>

namespace orbweaver::survey {

namespace {

constexpr std::string_view met_name = "met a family of more symmetry";
constexpr std::string_view joined_name = "joined";
constexpr std::string_view forwards_mark = "forwards: ";
constexpr std::string_view backwards_mark = "; backwards: ";

std::string_view name_of(EndKind kind) {
  using continuation::EndReason;
  switch (kind) {
    case EndKind::period_limit: return name_of(EndReason::period_limit);
    case EndKind::energy_limit: return name_of(EndReason::energy_limit);
    case EndKind::step_limit: return name_of(EndReason::step_limit);
    case EndKind::cutoff_limit: return name_of(EndReason::cutoff_limit);
    case EndKind::period_divergence: return name_of(EndReason::period_divergence);
    case EndKind::fixed_point: return name_of(EndReason::fixed_point);
    case EndKind::closed_loop: return name_of(EndReason::closed_loop);
    case EndKind::stopped: return name_of(EndReason::stopped);
    case EndKind::failure: return name_of(EndReason::failure);
    case EndKind::met: return met_name;
    case EndKind::joined: return joined_name;
    case EndKind::unknown: break;
  }
  return "unknown";
}

EndKind end_in(std::string_view text) {
  for (int n = 0; n < static_cast<int>(EndKind::unknown); ++n)
    if (const auto kind = static_cast<EndKind>(n); text.starts_with(name_of(kind))) return kind;
  return EndKind::unknown;
}

}  // namespace

std::string end_text(const BranchOutcome& outcome) {
  if (outcome.arrival.empty() || outcome.end.failed()) return outcome.end.text();
  const ArrivalRecord& arrival = outcome.arrival.front();
  return fmt::format("{} (T = {:.9g}, E = {:.9g})", met_name, arrival.period, arrival.energy);
}

std::string failure_text(const std::string& why) {
  return continuation::Ending{continuation::EndReason::failure, why}.text();
}

std::string joined_text(const std::string& name, const LocateOutcome& crossing) {
  return fmt::format("{} {} at T = {:.12g} (crossing at T = {:.12g}, {} times around)", joined_name, name,
                     crossing.multiplicity * crossing.period, crossing.period, crossing.multiplicity);
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
