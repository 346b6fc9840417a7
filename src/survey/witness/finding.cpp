#include "orbweaver/survey/witness/finding.hpp"

#include <cmath>

#include <fmt/format.h>

#include "tasks/stability_columns.hpp"

namespace orbweaver::survey {

namespace {

std::string addition_of(const Finding& finding) { return finding.detail.empty() ? "" : "; " + finding.detail; }

std::string sentence_of(const Finding& f, const FindingNames& names) {
  switch (f.kind) {
    case FindingKind::duplicate_curve:
      return fmt::format("the same orbits are stored in {} ({} of {} compared are the same){}", names.other_family,
                         f.number, f.other_number, addition_of(f));
    case FindingKind::retraced_curve:
      return fmt::format("runs over its own orbits or their images again ({} of {} compared are the same){}", f.number,
                         f.other_number, addition_of(f));
    case FindingKind::shared_point:
      return fmt::format("passes through the {} of {}, where neither says so", names.crossing, names.other_family);
    case FindingKind::missing_directions:
      if (f.severity == Severity::undecided && f.other_number == 0)
        return fmt::format("{}: which families leave there is not decided", names.crossing);
      if (f.severity == Severity::undecided && f.number > 0 && f.number >= f.other_number)
        return fmt::format("{}: directions found: {}; whether there are others is not decided", names.crossing,
                           f.number);
      return fmt::format("{}: the kernel has {} directions, {} were found", names.crossing, f.other_number, f.number);
    case FindingKind::unfollowed_direction:
      return fmt::format("{}: along direction {} nothing has left or arrived", names.crossing, f.number);
    case FindingKind::beyond_depth:
      return fmt::format("{}: what is born there was not followed (survey.depth)", names.crossing);
    case FindingKind::beyond_period:
      return fmt::format("{}: orbits born there lie beyond limits.period", names.crossing);
    case FindingKind::beyond_order:
      return fmt::format("{}: what else is born there was not looked for (survey.subharmonics)", names.crossing);
    case FindingKind::beyond_limits:
      return fmt::format("{}: along direction {} the first orbit lies beyond the limits", names.crossing, f.number);
    case FindingKind::beyond_families:
      return fmt::format("{}: direction {} was left out (limits.families)", names.crossing, f.number);
    case FindingKind::equilibrium_families:
      return f.severity == Severity::contradiction
                 ? fmt::format(
                       "the indices of the families that leave the equilibrium, {} oscillations of one period ({}), "
                       "add up to {}: some are missing",
                       f.other_number, f.detail, f.number)
                 : fmt::format(
                       "whether all families are found that leave the equilibrium, {} oscillations of one period ({}), "
                       "is not known: of some the index is not told, and those of the others add up to {}",
                       f.other_number, f.detail, f.number);
    case FindingKind::base_birth:
      return "its first orbits do not lead back to its equilibrium with the period of the oscillation there, or their "
             "energy and action do not belong together (`conserved` and `action` of the model)";
    case FindingKind::continuum:
      return fmt::format(
          "oscillations that share a period: {} orbits were found near the equilibrium whose neighbours "
          "are orbits too, to rounding: which families leave there is not known",
          f.number);
    case FindingKind::unlisted_target: return "ends at a crossing that the archive does not have";
    case FindingKind::taken_direction:
      return fmt::format(
          "comes back to the {} at which it was born: {} families leave and arrive there, along {} directions",
          names.crossing, f.number, f.other_number);
    case FindingKind::unknown_direction:
      return fmt::format("ends near the {} of {}, along none of the directions found there", names.crossing,
                         names.other_family);
    case FindingKind::higher_order:
      return fmt::format("ends on {} gone around {} times, more than survey.subharmonics", names.other_family,
                         f.number);
    case FindingKind::unlisted_crossing:
      return fmt::format("ends near {} gone around {} times, and no crossing is listed there", names.other_family,
                         f.number);
    case FindingKind::unknown_family:
      return f.severity == Severity::cut ? "ends on a family of more symmetry beyond the scene's limits"
                                         : "ends on a family of more symmetry that this survey does not have";
    case FindingKind::unknown_branch:
      return fmt::format(
          "{}: other equilibria branch off, which no curve of this survey has: their families are found "
          "where the scene begins with a parameter at which they exist, and its grid leads to them",
          f.detail);
    case FindingKind::unknown_equilibrium: return "ends at an equilibrium that this survey does not have";
    case FindingKind::limited_end: return fmt::format("ends by the scene's limits: {}", f.detail);
    case FindingKind::mirror_crossings:
      return fmt::format("has {} crossings, its mirror image {} has {}", f.number, names.other_family, f.other_number);
    case FindingKind::mirror_place:
      return fmt::format("{}: lies elsewhere on the mirror image {}, or is another kind there", names.crossing,
                         names.other_family);
    case FindingKind::mirror_end:
      return fmt::format("ends otherwise, or elsewhere, than its mirror image {}", names.other_family);
    case FindingKind::open_place:
      return fmt::format(
          "{}: its place is known to {:.1e} in arclength only{}: so near what vanishes there does not exceed its own "
          "error",
          names.crossing, f.deviation, f.detail);
    case FindingKind::index_change:
      return fmt::format("a multiplier passes exp(2 pi i {}/{}), and no crossing is listed there", f.number,
                         f.other_number);
    case FindingKind::undecided_end:
      return fmt::format("ends where rounding does not tell orbits from their neighbours: {}", f.detail);
    case FindingKind::undecided_event: return f.detail;
    case FindingKind::undecided_indices:
      if (!(f.deviation < values_on_circle))
        return "a stability index is not known: crossings are not told from rounding there";
      return fmt::format("a stability index is known to {:.2g} only: crossings are not told from rounding there",
                         f.deviation);
    case FindingKind::failed_certificate:
      return fmt::format("{} of {} orbits are not what they are said to be: {}", f.number, f.other_number, f.detail);
    case FindingKind::silent_certificate:
      return fmt::format("the certificates of {} of {} orbits say nothing: so unstable that integrating confirms none",
                         f.number, f.other_number);
    case FindingKind::failed_task: return f.detail;
    case FindingKind::disputed_arrival:
      return "another branch arrives where this one starts, yet it is kept: arrivals contradict each other about which "
             "branches are the same";
    case FindingKind::interrupted: return fmt::format("not done: {}", f.detail);
  }
  return "";
}

}  // namespace

std::string_view name_of(Severity severity) {
  switch (severity) {
    case Severity::contradiction: return "contradiction";
    case Severity::failure: return "failure";
    case Severity::undecided: return "undecided";
    case Severity::cut: return "cut";
  }
  return "unknown";
}

std::string_view name_of(FindingKind kind) {
  switch (kind) {
    case FindingKind::duplicate_curve: return "duplicate-curve";
    case FindingKind::retraced_curve: return "retraced-curve";
    case FindingKind::shared_point: return "shared-point";
    case FindingKind::missing_directions: return "missing-directions";
    case FindingKind::unfollowed_direction: return "unfollowed-direction";
    case FindingKind::beyond_depth: return "beyond-depth";
    case FindingKind::beyond_period: return "beyond-period";
    case FindingKind::beyond_order: return "beyond-order";
    case FindingKind::beyond_limits: return "beyond-limits";
    case FindingKind::beyond_families: return "beyond-families";
    case FindingKind::equilibrium_families: return "equilibrium-families";
    case FindingKind::base_birth: return "base-birth";
    case FindingKind::continuum: return "continuum";
    case FindingKind::unlisted_target: return "unlisted-target";
    case FindingKind::taken_direction: return "taken-direction";
    case FindingKind::unknown_direction: return "unknown-direction";
    case FindingKind::higher_order: return "higher-order";
    case FindingKind::unlisted_crossing: return "unlisted-crossing";
    case FindingKind::unknown_family: return "unknown-family";
    case FindingKind::unknown_branch: return "unknown-branch";
    case FindingKind::unknown_equilibrium: return "unknown-equilibrium";
    case FindingKind::limited_end: return "limited-end";
    case FindingKind::mirror_crossings: return "mirror-crossings";
    case FindingKind::mirror_place: return "mirror-place";
    case FindingKind::mirror_end: return "mirror-end";
    case FindingKind::open_place: return "open-place";
    case FindingKind::index_change: return "index-change";
    case FindingKind::undecided_end: return "undecided-end";
    case FindingKind::undecided_event: return "undecided-event";
    case FindingKind::undecided_indices: return "undecided-indices";
    case FindingKind::failed_certificate: return "failed-certificate";
    case FindingKind::silent_certificate: return "silent-certificate";
    case FindingKind::failed_task: return "failed-task";
    case FindingKind::disputed_arrival: return "disputed-arrival";
    case FindingKind::interrupted: return "interrupted";
  }
  return "unknown";
}

std::string text_of(const Finding& finding, const FindingNames& names) {
  std::string text = names.family.empty() ? "" : names.family + ": ";
  text += sentence_of(finding, names);
  if (!std::isnan(finding.period)) {
    text += fmt::format(" (T = {:.9g}", finding.period);
    if (!std::isnan(finding.level)) text += fmt::format(", {} = {:.9g}", names.level, finding.level);
    text += ")";
  }
  return text;
}

}  // namespace orbweaver::survey
