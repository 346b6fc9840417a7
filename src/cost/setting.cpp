#include "setting.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/bifurcation/small_oscillations.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/refine/guess.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"
#include "orbweaver/survey/tasks/branch_options.hpp"
#include "orbweaver/survey/tasks/sweep_options.hpp"
#include "orbweaver/survey/tree/naming.hpp"
#include "timing.hpp"

namespace orbweaver::cost {

namespace {

/// Where the probes lie, in parts of the family's arclength, and how far before that one is looked for that can be
/// refined: beside a collision it cannot.
constexpr double middle = 0.5;
constexpr double near_end = 0.9;
constexpr double nearer_start = 0.1;
/// Patiences that the family may take.
constexpr double of_family = 3.0;
constexpr std::size_t least_orbits = 4;
/// Known orbits that a location gets along, as in a survey.
constexpr std::size_t kept_orbits = 5;

}  // namespace

Setting::Setting(const core::Communicator& comm, const scene::Scene& scene, const Options& options)
    : _comm(comm), _quick(options.quick), _asked(scene), _plain(survey::system_of(scene)), _scaled(scene, _plain) {
  static_cast<void>(refine::conservative_formulas(*_plain));
  _options = survey::branch_options(_scaled.scene(), nullptr);
  choose_family(options.family);
  trace();
}

void Setting::choose_family(const std::string& wanted) {
  const systems::System& system = *this->system();
  std::vector<std::string> names;
  int index = 0;
  for (const std::vector<double>& point : starts::find_fixed_points(system, this->scene().fixed_points.grid)) {
    const starts::SweepOptions sweep = survey::sweep_options(this->scene(), system, point);
    const auto all = bifurcation::small_oscillations(system, starts::sweep(system, point, sweep), sweep.cutoff);
    for (const bifurcation::SmallOscillation& family : all.families) {
      names.push_back(survey::base_family_name(this->scene(), system, point, index, family.place));
      if (!wanted.empty() && names.back() != wanted) continue;
      const starts::NormalMode& mode = family.mode;
      const int cutoff = (static_cast<int>(mode.direction.modes.size() / point.size()) - 1) / 2;
      _family = names.back();
      _start = {loop::constant_loop(point, mode.period, cutoff), mode.direction, mode.isotropy};
      if (family.amplitude > 0.0) _options.start_amplitude = family.amplitude;
      return;
    }
    ++index;
  }
  throw core::InputError(
      names.empty() ? "the scene has no family of small oscillations: nothing to measure on"
                    : fmt::format("expected --family to be one of {}, got `{}`", fmt::join(names, ", "), wanted));
}

void Setting::trace() {
  try {
    run_within(of_family * patience(), [this] {
      _ending = continuation::trace(system(), _start, _options, [this](const continuation::Orbit& orbit) {
                  _orbits.push_back(orbit);
                  return true;
                }).text();
    });
  } catch (const GivenUp& error) {
    _ending = error.what();
  }
  if (_orbits.size() < least_orbits)
    throw core::InputError(
        fmt::format("{} has {} orbits, too few to measure on: {}", _family, _orbits.size(), _ending));
  place_probes();
}

void Setting::place_probes() {
  const auto step_at = [this](double part) {
    const auto at =
        std::lower_bound(_orbits.begin(), _orbits.end(), part * _orbits.back().arclength,
                         [](const continuation::Orbit& o, double arclength) { return o.arclength < arclength; });
    return std::max<std::size_t>(1, static_cast<std::size_t>(at - _orbits.begin()));
  };
  continuation::Branch branch(system(), _start, _options);
  std::size_t last = 0;
  for (const auto& [name, part] : {std::pair("middle", middle), std::pair("end", near_end)}) {
    std::size_t step = step_at(part);
    std::unique_ptr<TrueOrbit> truth;
    for (double before = part; !truth && before > 0.0; before -= nearer_start) try {
        const std::size_t at = step_at(before);
        truth = std::make_unique<TrueOrbit>(_plain, *system(), _orbits[at].loop, _orbits[at - 1].loop, isotropy());
        step = at;
      } catch (const core::NumericalError&) {
      }
    if (step <= last) break;
    last = step;
    while (branch.advance().value().step < static_cast<int>(step)) {
    }
    _probes.push_back({name, _orbits[step], branch.frontier().tangent, _orbits[step - 1].loop});
    _truths.push_back(std::move(truth));
    if (step + 1 >= _orbits.size()) break;
  }
}

const TrueOrbit& Setting::truth_of(const Probe& probe) const {
  const std::unique_ptr<TrueOrbit>& truth = _truths.at(static_cast<std::size_t>(&probe - _probes.data()));
  if (!truth) throw core::NumericalError("no orbit of the family could be refined");
  return *truth;
}

TrueOrbit Setting::truth_beside(const loop::Loop& orbit, const loop::Loop& neighbour) const {
  return {_plain, *system(), orbit, neighbour, isotropy()};
}

std::optional<FoundEvent> Setting::first_event(const continuation::Options& options) const {
  const systems::Structure& structure = system()->structure();
  const auto functions = bifurcation::test_functions(structure, loop::SymmetryGroup(structure, isotropy()).order(),
                                                     this->scene().survey.subharmonics);
  if (functions.empty()) return std::nullopt;
  continuation::FamilyCurve curve(system(), isotropy(), options);
  bifurcation::Detector detector;
  std::optional<FoundEvent> found;
  const auto point_at = [&](double position, const loop::Loop& loop) {
    bifurcation::TestPoint point{position, {}};
    const spectrum::Stability stability = spectrum::floquet(*system(), loop, isotropy());
    for (const bifurcation::TestFunction& function : functions)
      point.readings.push_back(bifurcation::evaluate(function, structure, stability));
    return point;
  };
  const auto probe = [&](double position) -> std::optional<bifurcation::TestPoint> {
    if (position < curve.known().front().position) return std::nullopt;
    const auto point = curve.at(position);
    return point ? std::optional(point_at(position, point->loop)) : std::nullopt;
  };
  static_cast<void>(continuation::trace(system(), _start, options, [&](const continuation::Orbit& orbit) {
    curve.add(orbit.arclength, orbit.loop, kept_orbits);
    for (const bifurcation::Bracket& bracket : detector.advance(point_at(orbit.arclength, orbit.loop), probe)) {
      const bifurcation::TestFunction& function = functions[bracket.function];
      if (found || bracket.tangency || !bifurcation::has_sector(function.kind)) continue;
      found = FoundEvent{{bifurcation::Event::Kind::test_function, function, false},
                         std::max(bracket.from, curve.known().front().position),
                         bracket.to,
                         curve.known()};
    }
    return !found.has_value() && orbit.arclength < _orbits.back().arclength;
  }));
  return found;
}

}  // namespace orbweaver::cost
