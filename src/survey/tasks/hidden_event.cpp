#include "hidden_event.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "orbit_row.hpp"
#include "orbweaver/bifurcation/family_jump.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "tasks/branch/followed_branch.hpp"

namespace orbweaver::survey {

namespace {

/// Whether the function had its sign before the event on the first known orbit, or before it: those since have none.
bool is_cut(const LocateWork& work, const continuation::FamilyCurve& family) {
  return work.event.kind == bifurcation::Event::Kind::test_function && family.known().size() >= kept_orbits &&
         work.from <= family.known().front().position;
}

/// Says so where an index is between -2 and 2 on too short a part of the way between the known orbits around the event.
std::string steep_in(const systems::System& system, const LocateWork& work, const continuation::FamilyCurve& family,
                     core::Team* team) {
  if (!system.structure().symplectic) return {};
  const loop::Loop* before = nullptr;
  const loop::Loop* after = nullptr;
  for (const continuation::FamilyCurve::Known& known : family.known()) {
    if (known.position <= work.from) before = &known.loop;
    if (known.position >= work.to && !after) after = &known.loop;
  }
  if (!before || !after) return {};
  const auto from = stability_of(system, *before, family.isotropy(), team);
  const auto to = stability_of(system, *after, family.isotropy(), team);
  const double smallest = family.options().smallest_jump;
  if (!from || !to ||
      bifurcation::are_turns_asked(*from, *to, continuation::arclength_between(*before, *after), smallest))
    return {};
  return fmt::format(
      "an index of {:.2g} is between -2 and 2 on less than {:.0e} of the way: families cross to rounding",
      std::max(std::abs(from->fundamental[0]), std::abs(to->fundamental[0])), smallest);
}

}  // namespace

std::pair<double, double> between_known(const LocateWork& work, const continuation::FamilyCurve& family) {
  double from = family.known().front().position;
  double to = family.known().back().position;
  for (const continuation::FamilyCurve::Known& known : family.known()) {
    if (known.position <= work.from) from = std::max(from, known.position);
    if (known.position >= work.to) to = std::min(to, known.position);
  }
  return {from, to};
}

std::string hidden_by_rounding(const systems::System& system, const LocateWork& work,
                               const continuation::FamilyCurve& family, bifurcation::NotLocated::Reason reason,
                               core::Team* team) {
  if (reason == bifurcation::NotLocated::Reason::no_zero && is_cut(work, family))
    return "on all orbits that are known between both signs of the function it is within its error bound";
  std::vector<const loop::Loop*> ends;
  const auto [from, to] = between_known(work, family);
  for (const continuation::FamilyCurve::Known& known : family.known())
    if (known.position == from || known.position == to) ends.push_back(&known.loop);
  for (std::size_t n = 0; n < ends.size(); ++n) {
    const loop::Loop* beside = ends.size() > 1 ? ends[n == 0 ? 1 : n - 1] : nullptr;
    std::string why = not_told_apart(system, *ends[n], beside, family.isotropy(), team);
    if (!why.empty()) return why;
  }
  return steep_in(system, work, family, team);
}

}  // namespace orbweaver::survey
