#include "verify/orbit_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/archive/schema/schema.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/certificate/verdict.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "tasks/certified.hpp"
#include "tasks/orbit_row.hpp"
#include "tasks/stability_columns.hpp"

namespace orbweaver::survey {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
// What is allowed, with the largest that was seen in 10,000 orbits (docs/accuracy.md).
/// Of the rounding that a residual can have: the modes' own, turned into the standard phase, and the transforms'.
constexpr double residual_rounding = 32.0;
/// Of a sum over the loop: energies, actions, states.
constexpr double sum_rounding = 256.0;
/// Of a period that a family holds: rounding; of the states, a change of which the energy that it holds may show.
constexpr double held_period = 1e-14;
constexpr double held_state = 1e-10;
/// Of a stability value besides the two bounds.
constexpr double stored_index_rounding = 1e-13;
/// Of the bound computed again, where that of the stored values is not stored.
constexpr double both_bounds = 4.0;
/// Of a stability value: with a bound as large it is not told, and may come out as anything of its size.
constexpr double untold = 0.5;
/// Of the largest multiplier: a bound that leaves it no digit.
constexpr double no_digit = 0.1;
/// Of the largest multiplier: bounds by probes that are smaller may be any such (1.4e14 and 1.5e10 beside 5e22).
constexpr double well_told = 1e-8;
/// Between two bounds or integrations of one orbit whose loops differ by rounding.
constexpr double bounds_factor = 64.0;
constexpr double certificate_factor = 16.0;
/// The same of bounds of multipliers, which are the largest of a few random probes: up to 800 apart in orbits of
/// Lorenz' equations beside the origin, whose multipliers are 1e13 and more.
constexpr double probes_factor = 4096.0;
/// Of the way between two orbits; and where no reversor fixes the phase: a branch measures it between loops that were
/// begun nearly, not quite, where they are nearest to each other. By 8.5e-5 at most in 10,000 steps of the pendulum and
/// of the restricted problem. A long step is off by more: its phase by a part of it like the step's of the orbit, and
/// the way by the square of that; where units differ from scales loops are nearest to each other in scales, and their
/// phase counts itself. Not measured.
constexpr double same_way = 1e-9;
constexpr double same_way_without_phase = 3e-4;
constexpr double by_square_of_step = 0.5;
constexpr double by_step_in_units = 0.25;
/// The same of families in a parameter: by 3.1e-4 at most in the responses of Duffing's oscillator.
constexpr double same_way_in_parameter = 1e-3;

/// Stored and computed values of one orbit.
class OrbitCheck {
 public:
  OrbitCheck(const VerifiedAtlas& atlas, std::size_t row, const loop::Loop& loop, certificate::Certifier& certifier,
             Findings& findings)
      : _atlas(atlas),
        _orbits(atlas.archive().orbits()),
        _system(*atlas.system()),
        _row(row),
        _family(static_cast<std::size_t>(_orbits.integers("family")[row])),
        _loop(loop),
        _certifier(certifier),
        _findings(findings),
        _claims(findings, "orbits", static_cast<std::int64_t>(row)) {}

  void run() {
    _size = loop::rms_size(_loop);
    equation();
    const certificate::Certificate found = _certifier(_loop, stored_evidence(_atlas, _row, _loop).growth);
    constants(found);
    shape();
    std::optional<spectrum::Stability> stability;
    if (_atlas.scene().compute.stability) stability = stability_of(_system, _loop, _atlas.isotropy(_family));
    multipliers(stability);
    certificate(found);
  }

 private:
  [[nodiscard]] double real(const char* column) const { return _orbits.reals(column)[_row]; }

  /// The residual of loop and period, and what it can be of rounding alone.
  void equation() {
    const double rate = 2.0 * std::numbers::pi / _loop.period;
    const loss::Linearization there(_system, _loop, loss::Linearization::Order::jacobian);
    const double of_slope = rate * std::pow(static_cast<double>(_loop.cutoff) + 1.0, 1.5) * _size * rms_pace(there);
    _residual = std::sqrt(there.loss());
    _rounding = residual_rounding * epsilon * (of_slope + loop::rms_speed(_loop) + rms_jacobian(there) * _size);
    _claims.agree("loss_rms", real("loss_rms"), _residual, _rounding + 1e-9 * real("loss_rms"));
    if (_atlas.archive().format_minor() < archive::volumes_since) return;
    const bool has_volume = !_system.structure().symplectic;
    _claims.agree("log_volume", real("log_volume"), has_volume ? log_volume_of(_system, _loop) : archive::not_computed,
                  has_volume ? sum_rounding * epsilon * _loop.period * rms_jacobian(there) : 0.0);
  }

  /// sqrt of the mean over time of (ds/dt T / 2 pi)^2: what a slope in s becomes, where s does not run evenly.
  [[nodiscard]] static double rms_pace(const loss::Linearization& there) {
    double sum = 0.0;
    for (const double density : there.density()) sum += 1.0 / density;
    return std::sqrt(sum / there.nodes());
  }

  /// sqrt of the mean over time of |df/dz|^2.
  [[nodiscard]] static double rms_jacobian(const loss::Linearization& there) {
    double sum = 0.0;
    for (int i = 0; i < there.dimension(); ++i)
      for (int l = 0; l < there.dimension(); ++l) {
        const double* entries = there.field_jacobian(i, l);
        for (int j = 0; j < there.nodes(); ++j)
          sum += there.density()[static_cast<std::size_t>(j)] * entries[j] * entries[j];
      }
    return std::sqrt(sum / there.nodes());
  }

  void constants(const certificate::Certificate& found) {
    const double steepness = found.steepness;
    const systems::Scales& units = _system.scales();
    const double error = _loop.period * (_residual + _rounding);
    const double energy = continuation::energy_of(_system, _loop);
    const double energy_rounding = sum_rounding * epsilon * (std::abs(energy) + steepness * _size) +
                                   2.0 * found.energy_rounding + steepness * error;
    _claims.agree("energy", real("energy"), energy * units.energy(), energy_rounding * units.energy());
    const double action = continuation::action_of(_system, _loop);
    const double momentum = std::abs(action) + _loop.period * steepness * _size;
    _claims.agree("action", real("action"), action * units.action(),
                  sum_rounding * epsilon * momentum * units.action());
    parameter();
    held(steepness);
  }

  /// What the family holds is that of its first orbit.
  void held(double steepness) {
    using Hold = systems::FamilyScalars::Hold;
    const Hold hold = _system.family_scalars().hold;
    const std::size_t first = _atlas.tree().families[_family].first_orbit;
    if (hold == Hold::period)
      _claims.agree("period", real("period"), _orbits.reals("period")[first], held_period * real("period"));
    if (hold == Hold::energy)
      _claims.agree("energy", real("energy"), _orbits.reals("energy")[first],
                    held_state * steepness * (1.0 + _size) * _system.scales().energy());
  }

  /// That it moves, and within the limits; the equation says whether it is that of the orbit.
  void parameter() {
    if (_system.family_scalars().free.empty())
      return _claims.agree("parameter", real("parameter"), archive::not_computed, 0.0);
    const scene::Limits& limits = _atlas.scene().limits;
    const double value = real("parameter");
    const double allowed = at_limit * _system.scales().parameter(0);
    _claims.expect(
        value >= limits.parameter_from - allowed && value <= limits.parameter_to + allowed, "parameter",
        fmt::format("is {:.12g}; limits.parameter is [{:g}, {:g}]", value, limits.parameter_from, limits.parameter_to));
  }

  void shape() {
    const loop::Loop in_units = loop::in_units(_loop, _system.scales());
    const std::vector<double> state = loop::state_at(in_units, 0.0);
    const std::size_t d = state.size();
    const double rounding = sum_rounding * epsilon * loop::rms_size(in_units);
    for (std::size_t i = 0; i < d; ++i)
      _claims.agree("state", _orbits.reals("state")[_row * d + i], state[i], rounding);
    _claims.agree("tail", real("tail"), loop::tail(_loop), sum_rounding * epsilon * _size);
    const std::size_t angles = _system.structure().angles.size();
    for (std::size_t n = 0; n < angles; ++n) {
      const double turns = _orbits.reals("winding")[_row * angles + n];
      _claims.agree("winding", turns, std::round(turns), 0.0);
    }
    for (const loop::SymmetryElement& element : _atlas.isotropy(_family))
      _claims.below("modes", loop::symmetry_defect(_loop, element, _system.structure().angles),
                    loop::symmetry_tolerance * (1.0 + _size),
                    fmt::format("the distance from being symmetric under {}", loop::to_text({element})));
  }

  void multipliers(const std::optional<spectrum::Stability>& stability) {
    archive::OrbitRecord found;
    set_stability(_system.structure(), stability, found);
    const double errors = std::fmax(real("stability_error"), 0.0) + std::fmax(found.stability_error, 0.0);
    const auto compare = [&](const char* column, const std::vector<double>& values, double allowed) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double stored = _orbits.reals(column)[_row * values.size() + i];
        const double size = allowed >= untold * std::abs(stored) ? std::abs(stored) : 0.0;
        _claims.agree(column, stored, values[i], allowed + size + stored_index_rounding * (1.0 + std::abs(values[i])));
      }
    };
    double fundamental = 0.0;
    if (stability)
      for (const double error : stability->fundamental_error) fundamental = std::max(fundamental, error);
    const bool are_indices = _system.structure().symplectic;
    // Of a fundamental map that is the whole one the stored bound is the same.
    const double stored = !are_indices && stability && stability->fundamental_order == 1 ? errors : 0.0;
    compare("stability", found.stability, errors);
    compare("fundamental_stability", found.fundamental_stability, std::max(both_bounds * fundamental, stored));
    // A bound that leaves no multiplier a digit claims nothing.
    double largest = 0.0;
    for (std::size_t i = 0; i < found.stability.size(); ++i)
      largest = std::max(largest, std::abs(_orbits.reals("stability")[_row * found.stability.size() + i]));
    if (!(real("stability_error") >= no_digit * largest))
      _claims.agree_within(are_indices ? bounds_factor : probes_factor, "stability_error", real("stability_error"),
                           found.stability_error, stored_index_rounding + (are_indices ? 0.0 : well_told * largest));
  }

  /// At the level of the scene; of what is stored, since the multipliers' differences have been told.
  void certificate(const certificate::Certificate& found) {
    const certificate::Evidence evidence = stored_evidence(_atlas, _row, _loop);
    const archive::CertificateRecord record = record_of(found, evidence);
    const double integration = certificate_rounding * found.reach;
    const double growth = std::isnan(evidence.growth) ? 1.0 : std::max(1.0, evidence.growth);
    const auto within = [&](const char* column, double value, double negligible) {
      _claims.agree_within(certificate_factor, column, real(column), value, negligible);
    };
    const std::int64_t verdict = _orbits.integers("verdict")[_row];
    const bool has_closure = verdict >= 0 || _atlas.archive().format_minor() < archive::certificates_since;
    if (has_closure) {
      within("closure", record.closure, integration);
      if (!(real("single_shot") > found.reach && !(found.single_shot <= found.reach)))
        within("single_shot", record.single_shot, integration * growth);
      within("energy_drift", record.energy_drift,
             std::max({found.steepness * integration, sum_rounding * epsilon * found.steepness * found.reach,
                       2.0 * found.energy_rounding}));
    }
    if (verdict >= 0) {
      within("taylor_closure", record.taylor_closure, integration);
      within("integrators_apart", record.integrators_apart, integration);
      within("other_drift", record.other_drift, integration);
      within("symmetry_defect", record.symmetry_defect, integration);
      _claims.agree("recurrence", real("recurrence"), record.recurrence,
                    same_recurrence * record.recurrence + integration);
      within("orbit_distance", record.orbit_distance, newton_rounding * integration);
      within("contraction", record.contraction, 1.0);  // of two steps that may both be rounding
      within("pairing", record.pairing, transition_rounding);
      within("index_gap", record.index_gap, transition_rounding * (1.0 + std::abs(evidence.index)));
      const auto name = [](std::int64_t number) {
        const bool known = number <= static_cast<std::int64_t>(last_of(certificate::Verdict{}));
        return known ? std::string(name_of(static_cast<certificate::Verdict>(number))) : std::to_string(number);
      };
      _claims.expect(verdict == record.verdict, "verdict",
                     fmt::format("is '{}', found '{}'", name(verdict), name(record.verdict)));
    } else {
      _claims.expect(!_atlas.claims_certificates(), "verdict", "is missing, though the scene asks for certificates");
    }
    const certificate::Judgement judged = certificate::judge(found, evidence);
    if (judged.verdict == certificate::Verdict::says_nothing) ++_findings.uninformative;
    _claims.expect(!is_failure(judged.verdict), "",
                   fmt::format("its certificate contradicts it: {}, {:.3g} where {:.3g} is explained",
                               name_of(judged.verdict), judged.found, judged.allowed));
  }

  /// Of the parameter's scale: a family may begin so far beside a limit.
  static constexpr double at_limit = 1e-9;
  /// Of the largest state: what one integration of a segment can be off by rounding.
  static constexpr double certificate_rounding = 1e-13;
  /// Of a distance between two places of one loop.
  static constexpr double same_recurrence = 1e-9;
  /// Times that: what Newton's method makes of it; and of multipliers from transition matrices integrated to 1e-10.
  static constexpr double newton_rounding = 1e3;
  static constexpr double transition_rounding = 1e-7;

  const VerifiedAtlas& _atlas;
  const archive::Table& _orbits;
  const systems::System& _system;
  std::size_t _row;
  std::size_t _family;
  const loop::Loop& _loop;
  certificate::Certifier& _certifier;
  Findings& _findings;
  Claims _claims;
  double _size = 0.0;
  double _residual = 0.0;
  double _rounding = 0.0;
};

/// From the last orbit of the steps to this one, as the archive adds it up.
void check_way(const VerifiedAtlas& atlas, std::size_t from, const loop::Loop& a, std::size_t to, const loop::Loop& b,
               Findings& findings) {
  const archive::Table& orbits = atlas.archive().orbits();
  const auto& arclengths = orbits.reals("arclength");
  const auto family = static_cast<std::size_t>(orbits.integers("family")[to]);
  const bool backwards = orbits.integers("step")[to] < 0;  // it was followed the other way
  const auto end = [&](const loop::Loop& start, const loop::Loop& near) {
    return arclengths[from] +
           continuation::arclength_in_units(*atlas.system(), backwards ? near : start, backwards ? start : near);
  };
  const bool has_phase = atlas.has_reversor(family);
  const loop::Loop in_units = loop::in_units(b, atlas.system()->scales());
  const double rounding =
      sum_rounding * epsilon * (std::abs(arclengths[from]) + std::abs(arclengths[to]) + loop::rms_size(in_units));
  const double step = std::abs(arclengths[to] - arclengths[from]);
  const double of_orbit = std::min(1.0, step / loop::rms_amplitude(in_units));
  const double by_phase = by_square_of_step * of_orbit * of_orbit +
                          (atlas.system()->scales().are_one() ? 0.0 : by_step_in_units * of_orbit);
  const double of_step = has_phase              ? same_way
                         : a.parameters.empty() ? same_way_without_phase + by_phase
                                                : same_way_in_parameter;
  const double allowed = of_step * step + rounding;
  const double found = end(a, atlas.begun_as(family, b, a, step));
  Claims(findings, "orbits", static_cast<std::int64_t>(to)).agree("arclength", arclengths[to], found, allowed);
}

}  // namespace

void check_orbits(const VerifiedAtlas& atlas, std::size_t first, std::size_t end, Findings& findings) {
  const archive::Table& orbits = atlas.archive().orbits();
  const auto& steps = orbits.integers("step");
  const auto& families = orbits.integers("family");
  std::size_t before = first;
  while (before > 0 && families[before - 1] == families[first] && (before == first || atlas.is_requested(before)))
    --before;
  std::optional<loop::Loop> last;
  certificate::Options options;
  options.level = atlas.certificate_level();
  certificate::Certifier certifier(*atlas.system(), atlas.isotropy(static_cast<std::size_t>(families[first])), options);
  const auto unless_wrong = [&](std::size_t row, const auto& work) {
    try {
      work();
    } catch (const core::InputError& error) {
      Claims(findings, "orbits", static_cast<std::int64_t>(row)).object("modes", error.what());
    } catch (const core::NumericalError& error) {
      Claims(findings, "orbits", static_cast<std::int64_t>(row)).object("modes", error.what());
    }
  };
  if (before < first) unless_wrong(before, [&] { last = atlas.loop(before); });
  for (std::size_t row = first; row < end; ++row)
    unless_wrong(row, [&] {
      const loop::Loop loop = atlas.loop(row);
      OrbitCheck(atlas, row, loop, certifier, findings).run();
      if (atlas.is_requested(row)) return;
      const bool same_side = (steps[before] < 0) == (steps[row] < 0);
      if (last && same_side && before < row) check_way(atlas, before, *last, row, loop, findings);
      last = loop;
      before = row;
    });
}

}  // namespace orbweaver::survey
