#include "orbweaver/bifurcation/small_oscillations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

/// Families that take places of their own: one, or some that are left out.
struct Entry {
  double period = 0.0;
  std::size_t oscillation = none;  // the first of its period
  std::optional<SmallOscillation> family;
  LeftOut left_out;
  int images = 1;
};

// Scaled to |dz(s = 0)| = 1.
loop::Tangent at_unit_start(const loop::Loop& base, loop::Tangent tangent) {
  const double length = loop::change_at_start(base, tangent);
  if (length > starts::still_at_start) tangent *= 1.0 / length;
  return tangent;
}

class Gatherer {
 public:
  Gatherer(const systems::System& system, const starts::SweepResult& sweep, int cutoff)
      : _system(system), _sweep(sweep), _cutoff(cutoff) {}

  SmallOscillations run() {
    for (const starts::SharedPeriod& shared : _sweep.left_out) add_left_out(shared);
    for (const starts::UndecidedEigenvalues& eigenvalues : _sweep.linear.undecided)
      if (std::isfinite(eigenvalues.period()))
        _entries.push_back({eigenvalues.period(), none, {}, {eigenvalues.period(), 0, eigenvalues.count, true}});
    for (const starts::NormalMode& mode : _sweep.modes) {
      Entry& entry = _entries.emplace_back(Entry{mode.period, first_with(mode.period), SmallOscillation{mode}, {}});
      if (!std::isfinite(mode.apart_below)) continue;
      set_amplitude(entry, mode.apart_below);
      entry.family->amplitude = std::min(entry.family->amplitude, _sweep.range.amplitude);
    }
    for (const starts::DegenerateMode& mode : _sweep.degenerate) add(mode);
    std::stable_sort(_entries.begin(), _entries.end(),
                     [](const Entry& a, const Entry& b) { return a.period > b.period; });
    place();
    for (std::size_t n = 0; n < _sweep.degenerate.size(); ++n) {
      const starts::DegenerateMode& mode = _sweep.degenerate[n];
      if (mode.members.size() > 1) set_amplitudes(mode);
      _all.kernels.push_back(kernel_of(mode));
      _all.kernels.back().not_isolated = _not_isolated[n];
    }
    for (Entry& entry : _entries)
      if (entry.family)
        _all.families.push_back(std::move(*entry.family));
      else
        _all.left_out.push_back(entry.left_out);
    return std::move(_all);
  }

 private:
  /// Of first orbits: their length in the kernel.
  [[nodiscard]] double amplitude_in(const starts::SharedPeriod& shared) const {
    const double wanted = std::max(_sweep.range.amplitude, starts::least_search_amplitude);
    return std::min(std::max(wanted, shared.together_from), shared.apart_below);
  }

  [[nodiscard]] Directions directions_of(const starts::SharedPeriod& shared) const {
    DirectionOptions options;
    options.amplitude = amplitude_in(shared);
    Directions all = equilibrium_directions(_system, _sweep.fixed_point, shared, _cutoff, options);
    std::erase_if(all.found, [](const Direction& direction) { return direction.repetitions > 1; });
    return all;
  }

  [[nodiscard]] std::size_t first_with(double period) const {
    const auto& all = _sweep.linear.oscillations;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& o) { return o.period == period; });
    return static_cast<std::size_t>(found - all.begin());
  }

  [[nodiscard]] int families_of(const starts::SharedPeriod& shared) const {
    if (shared.is_simple()) return 1;
    try {
      return std::max(1, static_cast<int>(directions_of(shared).found.size()));
    } catch (const core::NumericalError&) {  // a place each, of families that are not asked for
      return static_cast<int>(std::count(shared.harmonics.begin(), shared.harmonics.end(), 1));
    }
  }

  /// Whether places of families in the range, or their kernels, depend on how many these are. A search along
  /// combinations of many oscillations takes minutes.
  [[nodiscard]] bool is_asked_for(const starts::SharedPeriod& left_out) const {
    const auto behind = [&](const auto& inside) { return inside.period < left_out.period; };
    const auto takes_in = [&](const starts::SharedPeriod& inside) {
      return std::any_of(inside.members.begin(), inside.members.end(), [&](const starts::SharedPeriod::Member& member) {
        return member.oscillation == left_out.members.front().oscillation;
      });
    };
    return std::any_of(_sweep.modes.begin(), _sweep.modes.end(), behind) ||
           std::any_of(_sweep.degenerate.begin(), _sweep.degenerate.end(), behind) ||
           std::any_of(_sweep.degenerate.begin(), _sweep.degenerate.end(), takes_in);
  }

  void add_left_out(const starts::SharedPeriod& shared) {
    const int families = shared.is_simple() || is_asked_for(shared) ? families_of(shared) : not_counted;
    _entries.push_back({shared.period, shared.members.front().oscillation, {}, {shared.period, 0, families}});
  }

  void add(const starts::DegenerateMode& mode) {
    const Directions directions = directions_of(mode);
    _not_isolated.push_back(directions.not_isolated);
    if (directions.found.empty()) add_without_family(mode, directions.doubt);
    for (const Direction& direction : directions.found) {
      const loop::Tangent tangent = at_unit_start(direction.base, direction.tangent);
      SmallOscillation family{{mode.period, mode.grid_period, mode.residual, tangent, tangent, direction.isotropy}};
      family.both_sides = direction.both_sides;
      if (direction.amplitude > 0.0)
        family.amplitude = direction.amplitude * loop::change_at_start(direction.base, direction.tangent);
      _entries.push_back({mode.period, mode.members.front().oscillation, std::move(family), {}, direction.images});
    }
  }

  /// `doubt`: why there may be some all the same.
  void add_without_family(const starts::SharedPeriod& shared, const std::string& doubt) {
    _entries.push_back({shared.period, shared.members.front().oscillation, {}, {shared.period, 0, 1, true}});
    if (!doubt.empty()) return _all.without_family.push_back({shared.period, doubt});
    std::vector<std::string> others;
    for (const starts::SharedPeriod::Member& member : shared.members)
      if (member.harmonic > 1)
        others.push_back(fmt::format("{} times T = {:.12g}", member.harmonic,
                                     _sweep.linear.oscillations[member.oscillation].period * _system.scales().time));
    _all.without_family.push_back(
        {shared.period,
         fmt::format("a resonance ({}): no family leaves along this oscillation", fmt::join(others, ", "))});
  }

  void place() {
    for (Entry& entry : _entries) {
      if (!entry.family && (_all.count == not_counted || entry.left_out.families == not_counted)) {
        entry.left_out.families = _all.count = not_counted;
        continue;
      }
      (entry.family ? entry.family->place : entry.left_out.place) = _all.count;
      _all.count += entry.family ? 1 : entry.left_out.families;
    }
  }

  // Whether the entry's own period is that of a member of the kernel, and how many times it goes around.
  [[nodiscard]] int repetitions_in(const Entry& entry, const starts::SharedPeriod& shared) const {
    for (const starts::SharedPeriod::Member& member : shared.members)
      if (member.oscillation == entry.oscillation) return member.harmonic;
    return 0;
  }

  // All families of a kernel start at one length in it: what is born further out is a crossing on one of them, what was
  // born further in is among those found.
  void set_amplitudes(const starts::SharedPeriod& shared) {
    for (Entry& entry : _entries)
      if (entry.family && repetitions_in(entry, shared) > 0 && entry.family->amplitude == 0.0)
        set_amplitude(entry, amplitude_in(shared));
  }

  /// From a length in the kernel.
  void set_amplitude(Entry& entry, double length) const {
    const loop::Tangent& direction = entry.family->mode.direction;
    const loop::Loop base = loop::constant_loop(_sweep.fixed_point, entry.period, cutoff_of(direction));
    entry.family->amplitude =
        length * loop::change_at_start(base, direction) / loop::Tangent{direction.modes, {}}.norm();
  }

  [[nodiscard]] int cutoff_of(const loop::Tangent& direction) const {
    return (static_cast<int>(direction.modes.size() / _sweep.fixed_point.size()) - 1) / 2;
  }

  [[nodiscard]] OscillationKernel kernel_of(const starts::SharedPeriod& shared) const {
    OscillationKernel kernel{shared.period,  static_cast<int>(shared.kernel.cols()), shared.is_definite, 0, {},
                             shared.detuning};
    for (const Entry& entry : _entries) {
      const int repetitions = repetitions_in(entry, shared);
      if (repetitions == 0) continue;
      if (!entry.family && entry.left_out.is_told) continue;
      if (entry.family)
        kernel.families.push_back(
            {entry.family->place, entry.images * (entry.family->both_sides ? 2 : 1), repetitions});
      else
        for (int n = 0; n < entry.left_out.families; ++n)
          kernel.families.push_back({entry.left_out.place + n, 1, repetitions});
    }
    return kernel;
  }

  const systems::System& _system;
  const starts::SweepResult& _sweep;
  int _cutoff;
  std::vector<Entry> _entries;
  std::vector<int> _not_isolated;  // one a kernel
  SmallOscillations _all;
};

}  // namespace

SmallOscillations small_oscillations(const systems::System& system, const starts::SweepResult& sweep, int cutoff) {
  return Gatherer(system, sweep, cutoff).run();
}

}  // namespace orbweaver::bifurcation
