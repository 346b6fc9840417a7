#include "doubt_text.hpp"

#include <fmt/format.h>

namespace orbweaver::survey {

std::string doubt_text(const DoubtfulOrbits& doubtful) {
  using certificate::Verdict;
  const certificate::Judgement& worst = doubtful.worst;
  const std::string orbits = fmt::format("{} orbit{}", doubtful.count, doubtful.count == 1 ? "" : "s");
  switch (worst.verdict) {
    case Verdict::says_nothing:
      return fmt::format(
          "the certificates of {} say nothing: at T = {:.9g} the integration of a part of the period is "
          "off by {:.2g}, as multipliers up to {:.2g} allow",
          orbits, worst.period, worst.found, worst.growth);
    case Verdict::closure_contradicts:
      return fmt::format(
          "the certificates of {} contradict them: at T = {:.9g} the integration of a part of the period "
          "is off by {:.2g}, where residual and multipliers explain {:.2g}",
          orbits, worst.period, worst.found, worst.allowed);
    case Verdict::drift_contradicts:
      return fmt::format(
          "the energy changes along {}: at T = {:.9g} by {:.2g}, where the residual explains {:.2g}; "
          "does the model conserve it?",
          orbits, worst.period, worst.found, worst.allowed);
    case Verdict::holds: break;
  }
  return fmt::format("the certificates of {} hold", orbits);
}

}  // namespace orbweaver::survey
