#include "verify/crossing_families.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/survey/tasks/branch_options.hpp"
#include "tasks/arrival.hpp"

namespace orbweaver::survey {

namespace {

/// How far the first orbit of a family may lie from its crossing, and the last from where it ends, in parts of the way
/// to the next orbit or of the orbit's amplitude, whichever is more.
constexpr double steps_away = 3.0;
constexpr double amplitudes_away = 0.1;
/// Of the way from the crossing to a first orbit, as the archive says it.
constexpr double same_birth = 1e-3;
/// Relative, of the period of a crossing that lies beneath the end of a branch.
constexpr double same_period = 1e-6;

class CrossingFamilies {
 public:
  CrossingFamilies(const VerifiedAtlas& atlas, std::size_t row, const loop::Loop& orbit)
      : _atlas(atlas),
        _system(*atlas.system()),
        _row(row),
        _multiplicity(atlas.tree().crossings[row].multiplicity),
        _around(_multiplicity == 1 ? orbit : loop::repeated(loop::evenly_in_time(orbit), _multiplicity)) {}

  void check_born(const TreeFamily& family, Claims& claims) const {
    near(family, _atlas.tree().first_step_of(family), "crossing", claims);
    check_birth(family, claims);
  }

  /// Family `number` ends there forwards, or backwards where that end has joined.
  void check_ended(const TreeFamily& family, std::size_t number, Findings& findings) const {
    Findings forwards;
    Claims there(forwards, "families", static_cast<std::int64_t>(number));
    near(family, family.orbits() - 1, "end_crossing", there);
    Findings backwards;
    Claims back(backwards, "families", static_cast<std::int64_t>(number));
    if (!forwards.objections.empty()) near(family, 0, "end_crossing", back);
    const bool is_near = forwards.objections.empty() || backwards.objections.empty();
    if (!is_near && lies_beneath(family)) return;
    merge(findings, std::move(forwards.objections.empty() || !is_near ? forwards : backwards));
  }

 private:
  /// Whether a branch's last orbit lies beside this crossing, as what of it repeats tells: before a weak resonance
  /// rounding hides the rest of the way, which may be many steps long (survey/tasks/arrival.hpp).
  [[nodiscard]] bool lies_beneath(const TreeFamily& family) const {
    if (_multiplicity < bifurcation::least_weak_resonance) return false;
    const double period = _atlas.archive().crossings().reals("period")[_row];
    for (const std::size_t orbit : {family.orbits() - 1, std::size_t{0}}) {
      ArrivalRecord found;
      found.multiplicity = _multiplicity;
      if (!locate_beneath(_atlas.system(), branch_options(_atlas.scene(), nullptr),
                          _atlas.loop(family.first_orbit + orbit), found))
        continue;
      const double away = std::abs(found.period / _multiplicity * _system.scales().time - period);
      if (away <= same_period * period + _atlas.tree().crossings[_row].place_error_period) return true;
    }
    return false;
  }

  void near(const TreeFamily& family, std::size_t orbit, const char* column, Claims& claims) const {
    const std::size_t beside = orbit + 1 < family.orbits() ? orbit + 1 : orbit - 1;
    const loop::Loop own = _atlas.loop(family.first_orbit + orbit);
    const loop::Loop next = _atlas.loop(family.first_orbit + beside);
    const systems::Structure& system = _system.structure();
    const double step = std::hypot(loop::align(system, next, own).distance, next.period / own.period - 1.0);
    const double away = std::hypot(loop::align(system, _around, own).distance, _around.period / own.period - 1.0);
    claims.below(column, away, std::max(steps_away * step, amplitudes_away * loop::rms_amplitude(own)),
                 fmt::format("the distance of orbit {} from the crossing in row {}", family.first_orbit + orbit, _row));
  }

  /// How far the orbits beside the birth lie from the crossing.
  void check_birth(const TreeFamily& family, Claims& claims) const {
    const std::vector<double>& orbits = family.arclengths;
    const double birth = family.birth_arclength;
    if (std::isnan(birth)) return;
    const auto next = std::lower_bound(orbits.begin(), orbits.end(), birth) - orbits.begin();
    const auto behind = static_cast<std::size_t>(next);
    for (std::size_t n = behind > 0 ? behind - 1 : 0; n <= behind && n < orbits.size(); ++n) {
      const loop::Loop own = _atlas.loop(family.first_orbit + n);
      const loop::Loop there = loop::aligned(_around, loop::align(_system.structure(), _around, own));
      const double way = continuation::arclength_in_units(_system, there, own);
      claims.agree("birth_arclength", std::abs(orbits[n] - birth), way, same_birth * way);
    }
  }

  const VerifiedAtlas& _atlas;
  const systems::System& _system;
  std::size_t _row;
  int _multiplicity;
  loop::Loop _around;
};

}  // namespace

void check_families_at(const VerifiedAtlas& atlas, std::size_t row, const loop::Loop& orbit, Findings& findings) {
  const auto& all = atlas.tree().families;
  std::optional<CrossingFamilies> crossing;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const bool born = all[n].crossing == static_cast<int>(row);
    const bool ends = all[n].end_crossing == static_cast<int>(row);
    if (all[n].orbits() < 2 || !(born || ends)) continue;
    if (!crossing) crossing.emplace(atlas, row, orbit);
    Claims claims(findings, "families", static_cast<std::int64_t>(n));
    if (born) crossing->check_born(all[n], claims);
    if (ends) crossing->check_ended(all[n], n, findings);
  }
}

}  // namespace orbweaver::survey
