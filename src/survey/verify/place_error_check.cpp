#include "verify/place_error_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/parted_crossings.hpp"
#include "orbweaver/bifurcation/slopes.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "tasks/orbit_row.hpp"
#include "tasks/units.hpp"

namespace orbweaver::survey {

namespace {

using archive::CrossingKind;
using bifurcation::Reading;

/// An error of a place is good to that factor (bifurcation/place_error.hpp).
constexpr double resolved = 2.0;
/// Relative, of period and level: two computations of one orbit.
constexpr double same_orbit = 1e-10;
/// What turns at a fold differs there by so many roundings at least from what it is beside it.
constexpr double roundings = 16.0;

class PlaceErrorCheck {
 public:
  PlaceErrorCheck(const VerifiedAtlas& atlas, std::size_t row, continuation::FamilyCurve& curve, Claims& claims)
      : _atlas(atlas),
        _table(atlas.archive().crossings()),
        _system(*atlas.system()),
        _row(row),
        _kind(atlas.archive().crossing_kinds()[row]),
        _curve(curve),
        _claims(claims) {}

  void run(double position) {
    const double stored = real("place_error");
    if (!(stored >= 0.0 && std::isfinite(stored)))
      return _claims.object("place_error", fmt::format("is {:.3g}; a length was expected", stored));
    const double reach = stored / std::abs(_curve.arclength_unit_at(position));
    const auto there = _curve.at(position, true);
    // Nearer than two computations of one orbit may be, in the survey's scales, nothing is asked.
    const double told = std::max(resolved * reach, continuation::same_orbit_tolerance);
    const auto before = beside(position - told);
    const auto behind = beside(position + told);
    // Where no orbit is, or none that is known, nothing can be told.
    if (there && before && behind && _kind != CrossingKind::unknown)
      _claims.expect(
          archive::is_fold(_kind) ? turns(*there, *before, *behind) : is_told(*before, *behind), "place_error",
          fmt::format("is {:.3g}; twice as far from the place its condition does not exceed its error", stored));
    if (there) changes(*there, beside(position - reach), beside(position + reach));
  }

 private:
  [[nodiscard]] double real(const char* column) const { return _table.reals(column)[_row]; }

  [[nodiscard]] std::optional<continuation::CurvePoint> beside(double position) {
    const bool is_known = position >= _curve.known().front().position && position <= _curve.known().back().position;
    return is_known ? _curve.at(position, true) : std::nullopt;
  }

  [[nodiscard]] double turning(const continuation::CurvePoint& point) const {
    return _kind == CrossingKind::fold_period ? point.loop.period : continuation::level_of(_system, point.loop);
  }
  [[nodiscard]] double slope(const continuation::CurvePoint& point) const {
    return _kind == CrossingKind::fold_period ? bifurcation::period_slope(point)
                                              : bifurcation::level_slope(_system, point);
  }

  /// By the slopes, or by what turns where they do not tell.
  [[nodiscard]] bool turns(const continuation::CurvePoint& there, const continuation::CurvePoint& before,
                           const continuation::CurvePoint& behind) const {
    if (slope(before) * slope(behind) < 0.0) return true;
    const double from = turning(before) - turning(there);
    const double to = turning(behind) - turning(there);
    const double rounding = roundings * std::numeric_limits<double>::epsilon() * std::abs(turning(there));
    return from * to > 0.0 && std::min(std::abs(from), std::abs(to)) > rounding;
  }

  /// Whether one of the functions by which such crossings are located exceeds its error on both sides.
  [[nodiscard]] bool is_told(const continuation::CurvePoint& before, const continuation::CurvePoint& behind) const {
    const std::vector<Reading> one = readings(before);
    const std::vector<Reading> other = readings(behind);
    for (std::size_t n = 0; n < std::min(one.size(), other.size()); ++n)
      // The last changes its sign; away from a crossing it may be anything.
      if (one[n].sign() * other[n].sign() != 0 && (n + 1 < one.size() || one[n].sign() != other[n].sign())) return true;
    return one.empty() || other.empty();
  }

  [[nodiscard]] std::vector<Reading> readings(const continuation::CurvePoint& point) const {
    const auto family = static_cast<std::size_t>(_table.integers("family")[_row]);
    const auto stability = stability_of(_system, point.loop, _atlas.isotropy(family));
    if (!stability) return {};
    bifurcation::TestFunction function;
    if (_kind == CrossingKind::krein) function.kind = bifurcation::TestFunction::Kind::krein;
    if (_kind == CrossingKind::torus) function.kind = bifurcation::TestFunction::Kind::torus;
    function.sector = {static_cast<int>(_table.integers("sector_q")[_row]),
                       static_cast<int>(_table.integers("sector_j")[_row])};
    const systems::Structure& structure = _system.structure();
    std::vector<Reading> all{bifurcation::evaluate(function, structure, *stability)};
    if (archive::has_sector(_kind)) {
      all.push_back(bifurcation::determinant_deviation(structure, *stability, function.sector));
      all.push_back(bifurcation::index_deviation(structure, *stability, function.sector));
    }
    all.push_back({stability->twist, stability->fundamental_error.front()});
    return all;
  }

  void changes(const continuation::CurvePoint& there, const std::optional<continuation::CurvePoint>& before,
               const std::optional<continuation::CurvePoint>& behind) {
    const Units units(_system);
    const auto hold = [&](const char* column, const char* of, const auto& value, double unit) {
      const double at = value(there.loop);
      double most = std::isnan(at) ? archive::not_computed : 0.0;
      for (const auto& point : {before, behind})
        if (point) most = std::max(most, std::abs(value(point->loop) - at) * unit);
      const double stored = real(column);
      if (std::isnan(most) != std::isnan(stored))
        return _claims.object(column, fmt::format("is {:.3g}, found {:.3g}", stored, most));
      if (std::isnan(most)) return;
      const double scale = std::fmax(std::abs(real(of)), _atlas.tree().crossings[_row].level_scale);
      _claims.below(column, most, resolved * stored + same_orbit * scale, "the change over the error of its place");
    };
    hold(
        "place_error_period", "period", [](const loop::Loop& loop) { return loop.period; }, units.time);
    hold(
        "place_error_energy", "energy", [&](const loop::Loop& loop) { return continuation::energy_of(_system, loop); },
        units.energy());
    if (_atlas.tree().in_parameter())
      hold(
          "place_error_parameter", "parameter", [](const loop::Loop& loop) { return loop.parameters.front(); },
          units.parameter(0));
  }

  const VerifiedAtlas& _atlas;
  const archive::Table& _table;
  const systems::System& _system;
  std::size_t _row;
  CrossingKind _kind;
  continuation::FamilyCurve& _curve;
  Claims& _claims;
};

}  // namespace

void check_place_error(const VerifiedAtlas& atlas, std::size_t crossing, continuation::FamilyCurve& curve,
                       double position, Claims& claims) {
  if (atlas.archive().format_minor() < archive::place_errors_since) return;
  PlaceErrorCheck(atlas, crossing, curve, claims).run(position);
}

}  // namespace orbweaver::survey
