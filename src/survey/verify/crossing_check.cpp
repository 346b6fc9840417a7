#include "verify/crossing_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/bifurcation/kernel.hpp"
#include "orbweaver/bifurcation/slopes.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/corrector/method.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "tasks/executor.hpp"
#include "tasks/locate_task.hpp"
#include "tasks/orbit_row.hpp"
#include "tasks/units.hpp"
#include "verify/crossing_families.hpp"
#include "verify/distance_to_orbit.hpp"
#include "verify/place_error_check.hpp"

namespace orbweaver::survey {

namespace {

using archive::CrossingKind;

/// From which a crossing's is found: as a location has them (survey/tasks/branch/followed_branch.hpp).
constexpr std::size_t orbits_given = 5;
/// Relative, of period and energy, and of the state relative to the orbit's size; of the arclength and its unit. At
/// most a hundredth of it was seen.
constexpr double same_place = 1e-10;
/// Crossings beneath the end of a branch get their arclength by comparison of orbits (witness/placement).
constexpr double same_placement = 1e-6;
/// How far a birth may lie from the first orbit, in parts of the way to the next.
constexpr double steps_to_birth = 3.0;
/// Of an arclength, in parts of the way between the orbits beside: chords are measured in a loop's parameter, which the
/// standard phase has turned where no reversor fixes the phase.
constexpr double same_chord = 1e-2;
/// Relative to 1 + the position: rounding.
constexpr double position_width = 1e-14;
/// Of an index at a crossing besides its error bound: rounding; and of how much it changes over a length of 1, since
/// crossings are located to 1e-10 of the length along the family.
constexpr double index_rounding = 1e-10;
constexpr double located = 1e-9;
/// Between two computations of the largest singular value of a kernel, and what of it is rounding.
constexpr double kernel_factor = 100.0;
constexpr double kernel_rounding = 1e-8;

struct Place {
  continuation::CurvePoint point;
  double before = 0.0;  ///< lengths in scales to the orbits beside it
  double after = 0.0;
};

class CrossingCheck {
 public:
  CrossingCheck(const VerifiedAtlas& atlas, std::size_t row, Findings& findings)
      : _atlas(atlas),
        _table(atlas.archive().crossings()),
        _system(*atlas.system()),
        _row(row),
        _crossing(atlas.tree().crossings[row]),
        _family(atlas.tree().families[static_cast<std::size_t>(_crossing.family)]),
        _isotropy(atlas.isotropy(static_cast<std::size_t>(_crossing.family))),
        _kind(atlas.archive().crossing_kinds()[row]),
        _findings(findings),
        _claims(findings, "crossings", static_cast<std::int64_t>(row)) {}

  void run() {
    const double arclength = real("arclength");
    if (_family.orbits() < 2) return;                               // one orbit has no curve
    if (_family.parent >= 0 && is_beside_birth(arclength)) return;  // no orbits beside it to find it from
    if (arclength < _family.arclengths.front() || arclength > _family.arclengths.back())
      return _claims.object("arclength", fmt::format("is {:.12g}; its family runs from {:.12g} to {:.12g}", arclength,
                                                     _family.arclengths.front(), _family.arclengths.back()));
    // As many orbits as a location had been given, of which the last one or two lie behind the crossing; after those
    // one that went by Newton's method on whole loops, since collocation had failed.
    Findings best;
    bool any = false;
    for (const corrector::Method method : {options().corrector.method, corrector::Method::newton_krylov})
      for (const std::size_t behind : {1, 2}) {
        Findings findings;
        try {
          compare(method, behind, findings);
        } catch (const core::InputError&) {  // whole loops do not apply, as to driven orbits that a reversor fixes
          if (!any) throw;
          break;
        }
        if (findings.objections.empty()) return merge(_findings, std::move(findings));
        if (!any || findings.objections.size() < best.objections.size()) best = std::move(findings);
        any = true;
      }
    merge(_findings, std::move(best));
  }

 private:
  [[nodiscard]] double real(const char* column) const { return _table.reals(column)[_row]; }
  [[nodiscard]] continuation::Options options() const { return branch_options(_atlas.scene(), nullptr); }

  void compare(corrector::Method method, std::size_t behind, Findings& findings) {
    Claims claims(findings, "crossings", static_cast<std::int64_t>(_row));
    std::optional<Place> place;
    try {
      place = find(method, behind, claims);
      if (place) hold(*place, claims);
    } catch (const core::NumericalError& error) {
      claims.object("", error.what());
    }
    if (place && findings.objections.empty()) check_families_at(_atlas, _row, place->point.loop, findings);
  }

  /// The family's orbit whose period, or level where that changes more, is the row's.
  [[nodiscard]] std::optional<Place> find(corrector::Method method, std::size_t behind, Claims& claims) {
    const double arclength = real("arclength");
    const auto& number = _atlas.archive().orbits().integers("step");
    std::vector<std::size_t> steps;  // without the orbits between them that the scene asked for
    for (std::size_t n = 0; n < _family.orbits(); ++n)
      if (!_atlas.is_requested(_family.first_orbit + n)) steps.push_back(n);
    if (steps.size() < 2) return std::nullopt;
    const auto after = std::lower_bound(steps.begin(), steps.end(), arclength,
                                        [&](std::size_t n, double s) { return _family.arclengths[n] < s; });
    std::size_t next = std::clamp<std::size_t>(static_cast<std::size_t>(after - steps.begin()), 1, steps.size() - 1);
    // A branch that runs backwards has its orbits the other way round; neither side was given those of the other.
    const bool backwards = number[_family.first_orbit + steps[next - 1]] < 0;
    if (backwards) {
      std::reverse(steps.begin(), steps.end());
      next = steps.size() - next;
    }
    // From a start both sides leave its orbit, step 0; at a birth each side has a first orbit of its own.
    const std::int64_t begun_at = backwards && _family.parent >= 0 ? -1 : 0;
    const auto begin = std::find_if(steps.begin(), steps.end(), [&](std::size_t n) {
      const std::int64_t step = number[_family.first_orbit + n];
      return backwards ? step <= begun_at : step >= begun_at;
    });
    next -= static_cast<std::size_t>(begin - steps.begin());
    steps.erase(steps.begin(), begin);
    const std::size_t end = std::min(next + behind, steps.size());
    const std::size_t first = end > orbits_given ? end - orbits_given : 0;
    continuation::Options how = options();
    how.corrector.method = method;
    continuation::FamilyCurve curve(_atlas.system(), _isotropy, how);
    double position = 0.0;
    for (std::size_t i = first; i < end; ++i) {
      loop::Loop loop = _atlas.loop(_family.first_orbit + steps[i]);
      if (i > first) {
        const loop::Loop& last = curve.known().back().loop;
        loop = _atlas.begun_as(static_cast<std::size_t>(_crossing.family), loop, last,
                               std::abs(_family.arclengths[steps[i]] - _family.arclengths[steps[i - 1]]));
        position += continuation::arclength_between(last, loop);
      }
      curve.add({position, loop, _family.arclengths[steps[i]]}, orbits_given);
    }
    const continuation::FamilyCurve::Known& a = curve.known()[next - 1 - first];
    const continuation::FamilyCurve::Known& b = curve.known()[next - first];
    const double length = b.position - a.position;
    const double share = std::clamp((arclength - a.arclength) / (b.arclength - a.arclength), 0.0, 1.0);
    const double told = a.position + share * length;
    const bool both = both_turn(curve, a.position, b.position);
    const std::optional<double> found = position_of(curve, a, b, told, both);
    if (!found) {
      claims.object("period", fmt::format("{:.17g} with {} {:.17g}: no orbit between those beside it has it",
                                          real("period"), level(), real(level())));
      return std::nullopt;
    }
    const double unit = std::abs((b.arclength - a.arclength) / length);
    double way = _atlas.has_reversor(static_cast<std::size_t>(_crossing.family)) && !is_placed()
                     ? same_place * (unit + std::abs(arclength))
                     : same_chord * std::abs(b.arclength - a.arclength);
    // By its slope it is found as well as its place is known.
    if (both) way = std::fmax(way, real("place_error"));
    claims.agree("arclength", arclength, a.arclength + (*found - a.position) / length * (b.arclength - a.arclength),
                 way);
    std::optional<continuation::CurvePoint> point = curve.at(*found, true);
    if (!point) {
      claims.object("arclength", fmt::format("is {:.12g}: no orbit converges there", arclength));
      return std::nullopt;
    }
    if (archive::is_fold(_kind)) slopes(curve, a, b);
    check_place_error(_atlas, _row, curve, *found, claims);
    return Place{std::move(*point), *found - a.position, b.position - *found};
  }

  [[nodiscard]] std::optional<double> position_of(continuation::FamilyCurve& curve,
                                                  const continuation::FamilyCurve::Known& a,
                                                  const continuation::FamilyCurve::Known& b, double told,
                                                  bool both_turn) const {
    const Units units(_system);
    const double level_a = continuation::level_of(_system, a.loop);
    const double level_b = continuation::level_of(_system, b.loop);
    const double level_size = std::max(std::abs(level_a), std::abs(level_b));
    const double in_period = std::abs(b.loop.period / a.loop.period - 1.0);
    const double in_level = std::abs(level_b - level_a) / level_size;
    // A drive ties the period to its frequency: both turn there, or the period does not change at all. Where it changes
    // more than the parameter, as along a canard, it says better where the fold is than a slope that is small all over.
    if (both_turn || (_kind == CrossingKind::fold_parameter && !(in_period > in_level)))
      return root_near(a, b, told, [&](double position) {
        const auto point = curve.at(position, true);
        return point ? slope(*point) : std::numeric_limits<double>::quiet_NaN();
      });
    // Not by the one that turns; false where there is no level.
    bool by_level = _kind == CrossingKind::fold_period;
    if (!archive::is_fold(_kind)) {
      by_level = in_level > in_period;
      // Beside a fold of the one the other tells.
      if (const auto there = curve.at(told, true))
        by_level = std::abs(bifurcation::level_slope(_system, *there)) /
                       std::fmax(level_size, _crossing.level_scale / units.level()) >
                   std::abs(bifurcation::period_slope(*there)) / there->loop.period;
    }
    const double wanted = by_level ? real(level()) / units.level() : real("period") / units.time;
    return root_near(a, b, told, [&](double position) {
      const auto point = curve.at(position);
      if (!point) return std::numeric_limits<double>::quiet_NaN();
      return (by_level ? continuation::level_of(_system, point->loop) : point->loop.period) - wanted;
    });
  }

  /// The nearest zero to the place `told` between two orbits of a function that may turn between them: near the place
  /// it does not.
  template <class Function>
  [[nodiscard]] static std::optional<double> root_near(const continuation::FamilyCurve::Known& a,
                                                       const continuation::FamilyCurve::Known& b, double told,
                                                       const Function& function) {
    const double length = b.position - a.position;
    for (const double reach : {1e-6, 1e-3, 1e-2, 1.0}) {
      const double from = std::max(a.position, told - reach * length);
      const double to = std::min(b.position, told + reach * length);
      const auto place = numerics::locate_root(function, from, to, position_width * (1.0 + std::abs(to)));
      if (place) return place->position;
    }
    return std::nullopt;
  }

  /// Whether period and level turn so near to one another that neither says where the other does: in a narrow gap
  /// between two families both turn with the curve.
  [[nodiscard]] bool both_turn(continuation::FamilyCurve& curve, double from, double to) const {
    if (!archive::is_fold(_kind)) return false;
    const auto before = curve.at(from, true);
    const auto after = curve.at(to, true);
    return before && after && bifurcation::period_slope(*before) * bifurcation::period_slope(*after) < 0.0 &&
           bifurcation::level_slope(_system, *before) * bifurcation::level_slope(_system, *after) < 0.0;
  }

  /// The column of the energy, or of the parameter that moves.
  [[nodiscard]] const char* level() const { return _atlas.tree().in_parameter() ? "parameter" : "energy"; }

  [[nodiscard]] bool is_placed() const { return _crossing.multiplicity > _atlas.scene().survey.subharmonics; }

  /// The slopes at the orbits beside a fold, or half way to others of its kind that are nearer.
  void slopes(continuation::FamilyCurve& curve, const continuation::FamilyCurve::Known& a,
              const continuation::FamilyCurve::Known& b) {
    _slopes.clear();
    double from = std::min(a.arclength, b.arclength);
    double to = std::max(a.arclength, b.arclength);
    if (const auto before = next_of_kind(-1)) from = std::max(from, 0.5 * (*before + real("arclength")));
    if (const auto behind = next_of_kind(1)) to = std::min(to, 0.5 * (*behind + real("arclength")));
    for (const double arclength : {from, to}) {
      const double share = (arclength - a.arclength) / (b.arclength - a.arclength);
      const double position = a.position + share * (b.position - a.position);
      if (const auto point = curve.at(std::clamp(position, a.position, b.position), true))
        _slopes.push_back(slope(*point));
    }
  }

  /// The arclength of the family's next crossing of this kind, in rows that rise or fall with `way`.
  [[nodiscard]] std::optional<double> next_of_kind(int way) const {
    const auto rows = static_cast<std::ptrdiff_t>(_table.rows());
    for (auto n = static_cast<std::ptrdiff_t>(_row) + way; n >= 0 && n < rows; n += way) {
      const auto row = static_cast<std::size_t>(n);
      if (_table.integers("family")[row] != _crossing.family) break;
      if (_table.texts("kind")[row] == _crossing.kind) return _table.reals("arclength")[row];
    }
    return std::nullopt;
  }

  [[nodiscard]] double slope(const continuation::CurvePoint& point) const {
    return _kind == CrossingKind::fold_period ? bifurcation::period_slope(point)
                                              : bifurcation::level_slope(_system, point);
  }

  void hold(const Place& place, Claims& claims) {
    const loop::Loop& loop = place.point.loop;
    const Units units(_system);
    const bool placed = is_placed();
    const double allowed = placed ? same_placement : same_place;
    claims.agree("period", real("period"), loop.period * units.time, allowed * real("period"));
    const double level_there = continuation::level_of(_system, loop) * units.level();
    const double scale = std::fmax(std::abs(level_there), _crossing.level_scale);
    claims.agree(level(), real(level()), level_there, allowed * (std::isnan(scale) ? 1.0 : scale));
    if (_atlas.tree().in_parameter()) {
      const double energy = continuation::energy_of(_system, loop) * units.energy();
      claims.agree("energy", real("energy"), energy, allowed * std::abs(energy));
    } else {
      claims.agree("parameter", real("parameter"), archive::not_computed, 0.0);
    }
    state(loop, allowed, claims);
    const std::optional<spectrum::Stability> stability = stability_of(_system, loop, _isotropy);
    if (stability)
      claims.expect(
          stability->fundamental_order == _table.integers("fundamental_order")[_row], "fundamental_order",
          fmt::format("is {}, found {}", _table.integers("fundamental_order")[_row], stability->fundamental_order));
    rules(claims);
    if (archive::has_sector(_kind))
      sector(place, stability, placed, claims);
    else if (archive::is_fold(_kind))
      fold(claims);
    else if (_kind != CrossingKind::unknown)
      function(stability, claims);
  }

  /// The state is one of the orbit; at which phase, the standard one does not tell.
  void state(const loop::Loop& loop, double allowed, Claims& claims) {
    const auto dimension = static_cast<std::size_t>(loop.dimension);
    const auto stored = _table.reals("state").begin() + static_cast<std::ptrdiff_t>(_row * dimension);
    std::vector<double> target(stored, stored + static_cast<std::ptrdiff_t>(dimension));
    for (std::size_t i = 0; i < dimension; ++i) target[i] /= _system.scales().coordinate(i);
    claims.below("state", distance_to_orbit(_system.structure(), loop, target), allowed * (1.0 + loop::rms_size(loop)),
                 "the distance of the state from the orbit there");
  }

  /// Multiplicity, sector and kind say the same.
  void rules(Claims& claims) {
    const bifurcation::Sector sector{_crossing.sector_q, _crossing.sector_j};
    const int order = static_cast<int>(_table.integers("fundamental_order")[_row]);
    const int multiplicity = archive::has_sector(_kind) && order >= 1 ? sector.multiplicity(order) : 1;
    claims.expect(_crossing.multiplicity == multiplicity, "multiplicity",
                  fmt::format("is {}; sector and order give {}", _crossing.multiplicity, multiplicity));
    if (!archive::has_sector(_kind)) return;
    const CrossingKind kind = multiplicity == 1   ? CrossingKind::branch_point
                              : multiplicity == 2 ? CrossingKind::period_doubling
                                                  : CrossingKind::subharmonic;
    claims.expect(
        _kind == kind, "kind",
        fmt::format("is {}; a multiplicity of {} is called {}", _crossing.kind, multiplicity, archive::name_of(kind)));
  }

  void sector(const Place& place, const std::optional<spectrum::Stability>& stability, bool placed, Claims& claims) {
    const bifurcation::Sector sector{_crossing.sector_q, _crossing.sector_j};
    if (!stability) return claims.object("test_value", "the multipliers there cannot be computed");
    const bifurcation::Reading found = bifurcation::index_deviation(_system.structure(), *stability, sector);
    const double allowed = found.error + (placed ? same_placement : index_rounding);
    claims.agree("test_value", real("test_value"), sector.value(_system.structure().symplectic) + found.value, allowed);
    claims.agree("residual", real("residual"), found.value, allowed);
    claims.below("sector_q", std::abs(found.value), allowed + located * rate(sector, place),
                 "the index there, from its sector's,");
    if (_crossing.kernel_dimension < 0 || placed) return;
    kernel(place, *stability, sector, claims);
  }

  /// How fast the index changes with the length along the family, from the orbits beside.
  [[nodiscard]] double rate(const bifurcation::Sector& sector, const Place& place) const {
    const double length = place.before + place.after;
    double rate = 1.0;
    const std::size_t width = archive::stability_width(_atlas.archive().header());
    const std::size_t parts = archive::has_complex_stability(_atlas.archive().header()) ? 2 : 1;
    const auto& values = _atlas.archive().orbits().reals("fundamental_stability");
    const auto after = std::upper_bound(_family.arclengths.begin(), _family.arclengths.end(), real("arclength"));
    if (after == _family.arclengths.begin() || after == _family.arclengths.end() || width == 0) return rate;
    const std::size_t next = _family.first_orbit + static_cast<std::size_t>(after - _family.arclengths.begin());
    for (const std::size_t row : {next - 1, next}) {
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < width; i += parts)
        nearest = std::min(nearest, std::abs(values[row * width + i] - sector.value(_system.structure().symplectic)));
      if (std::isfinite(nearest)) rate = std::max(rate, 2.0 * nearest / length);
    }
    return rate;
  }

  void kernel(const Place& place, const spectrum::Stability& stability, const bifurcation::Sector& sector,
              Claims& claims) {
    bifurcation::KernelOptions settings;
    settings.even_in_time = false;
    const bool touches = _crossing.kernel_dimension > expected_dimension(_system.structure(), stability, sector, false);
    const int expected = expected_dimension(_system.structure(), stability, sector, touches);
    const bifurcation::Kernel kernel =
        bifurcation::kernel_of(_system, place.point, _isotropy, sector, expected, settings);
    claims.expect(kernel.dimension() == _crossing.kernel_dimension, "kernel_dimension",
                  fmt::format("is {}, found {}", _crossing.kernel_dimension, kernel.dimension()));
    if (kernel.dimension() > 0)
      claims.agree_within(kernel_factor, "kernel_residual", real("kernel_residual"), kernel.largest(), kernel_rounding);
  }

  void fold(Claims& claims) {
    if (_slopes.size() != 2) return claims.object("kind", "no orbits beside it converge");
    claims.expect(_slopes[0] * _slopes[1] < 0.0, "kind",
                  fmt::format("is {}; the slopes beside it, {:.3g} and {:.3g}, have one sign", _crossing.kind,
                              _slopes[0], _slopes[1]));
  }

  void function(const std::optional<spectrum::Stability>& stability, Claims& claims) {
    if (!stability) return claims.object("residual", "the multipliers there cannot be computed");
    bifurcation::TestFunction function;
    function.kind =
        _kind == CrossingKind::krein ? bifurcation::TestFunction::Kind::krein : bifurcation::TestFunction::Kind::torus;
    const bifurcation::Reading found = bifurcation::evaluate(function, _system.structure(), *stability);
    const double allowed = 2.0 * found.error + index_rounding;
    claims.agree("residual", real("residual"), found.value, allowed);
    claims.below("kind", std::abs(found.value), allowed, "the test function there");
  }

  /// Whether no orbit lies between it and the birth of its family, on a side that the family has.
  [[nodiscard]] bool is_beside_birth(double arclength) const {
    const std::vector<double>& orbits = _family.arclengths;
    const auto behind = [&](double s) { return std::lower_bound(orbits.begin(), orbits.end(), s); };
    double birth = _family.birth_arclength;
    if (std::isnan(birth)) {  // an archive that does not say where it is
      const std::size_t first = _atlas.tree().first_step_of(_family);
      birth =
          first > 0 ? 0.5 * (orbits[first - 1] + orbits[first]) : orbits[0] - steps_to_birth * (orbits[1] - orbits[0]);
    }
    const auto next = behind(birth);
    const double from = next == orbits.begin() ? birth : next[-1];
    const double to = next == orbits.end() ? birth : *next;
    return behind(arclength) == next && arclength >= from && arclength <= to;
  }

  const VerifiedAtlas& _atlas;
  const archive::Table& _table;
  const systems::System& _system;
  std::size_t _row;
  const TreeCrossing& _crossing;
  const TreeFamily& _family;
  const loop::Isotropy& _isotropy;
  CrossingKind _kind;
  Findings& _findings;
  Claims _claims;
  std::vector<double> _slopes;
};

}  // namespace

void check_crossing(const VerifiedAtlas& atlas, std::size_t crossing, Findings& findings) {
  try {
    CrossingCheck(atlas, crossing, findings).run();
  } catch (const core::InputError& error) {
    Claims(findings, "crossings", static_cast<std::int64_t>(crossing)).object("", error.what());
  }
}

}  // namespace orbweaver::survey
