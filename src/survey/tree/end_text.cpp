#include "end_text.hpp"

#include <fmt/format.h>

#include "orbweaver/continuation/ending.hpp"
#include "orbweaver/survey/tree/family_end.hpp"

namespace orbweaver::survey {

std::string end_text(const BranchOutcome& outcome, const Units& units) {
  if (outcome.arrival.empty() || outcome.end.failed()) return outcome.end.text();
  const ArrivalRecord& arrival = outcome.arrival.front();
  const double period = arrival.period * units.time;
  const double level = arrival.level * units.level();
  std::string where = fmt::format("T = {:.9g}{}", period, units.level_text(level));
  if (!arrival.beneath.empty())
    where = fmt::format("T = {:.12g}{}, {} times around T = {:.12g}", period, units.level_text(level, 12),
                        arrival.multiplicity, period / arrival.multiplicity);
  return fmt::format("{} ({})", name_of(EndKind::met), where);
}

std::string failure_text(const std::string& why) {
  return continuation::Ending{continuation::EndReason::failure, why}.text();
}

std::string joined_text(const std::string& name, const LocateOutcome& crossing, const Units& units) {
  const double period = crossing.period * units.time;
  return fmt::format("{} {} at T = {:.12g} (crossing at T = {:.12g}, {} times around)", name_of(EndKind::joined), name,
                     crossing.multiplicity * period, period, crossing.multiplicity);
}

}  // namespace orbweaver::survey
