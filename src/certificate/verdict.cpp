#include "orbweaver/certificate/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "explained.hpp"

namespace orbweaver::certificate {

namespace {

/// Of the bounds on the roundings of H at two places: their difference.
constexpr double of_both = 2.0;
/// Of the amplitude: fewer digits than four confirm no orbit.
constexpr double informative = 1e-4;
/// Of the product of the multipliers, and of an index relative to 1 + |k| beside its bound: transition matrices are
/// integrated to 1e-10 of 1 + their entries.
constexpr double unpaired_by = 1e-6;
constexpr double times_index_bound = 16.0;
/// A second step of Newton's method that is no smaller than this part of the first leads nowhere, where the first is
/// more than this part of the amplitude: below it both are rounding, which near a crossing grows by 1e7.
constexpr double contracting = 0.5;
constexpr double beyond_rounding = 1e-6;

}  // namespace

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds: return "holds";
    case Verdict::says_nothing: return "says nothing";
    case Verdict::closure_contradicts: return "closure contradicts";
    case Verdict::drift_contradicts: return "drift contradicts";
    case Verdict::wrong_period: return "wrong period";
    case Verdict::integrators_differ: return "integrators differ";
    case Verdict::return_contradicts: return "return contradicts";
    case Verdict::not_symmetric: return "not symmetric";
    case Verdict::not_minimal: return "not minimal";
    case Verdict::truncated: return "truncated";
    case Verdict::unpaired: return "unpaired";
    case Verdict::other_multipliers: return "other multipliers";
    case Verdict::no_orbit_near: return "no orbit near";
  }
  return "unknown";
}

// What was not computed is NaN, and compares as not larger.
Judgement judge(const Certificate& c, const Evidence& evidence) {
  const double error = evidence.period * evidence.residual + integration_error * c.reach;
  const double growth =
      std::isnan(evidence.growth) ? std::numeric_limits<double>::infinity() : std::max(1.0, evidence.growth);
  const double explained = unexplained * error;
  const double resolved = std::max(informative * evidence.amplitude, evidence.winds ? explained : 0.0);

  const double grown = explained * growth;
  const double closure = std::fmax(c.closure, c.taylor_closure);
  if (closure > grown)
    return {c.beside_flow <= grown ? Verdict::wrong_period : Verdict::closure_contradicts, closure, grown};
  const double drift_allowed =
      std::max({c.steepness * explained, energy_roundings * c.energy_size, of_both * c.energy_rounding});
  if (c.energy_drift > drift_allowed) return {Verdict::drift_contradicts, c.energy_drift, drift_allowed};
  if (c.other_drift > explained) return {Verdict::drift_contradicts, c.other_drift, explained};

  if (c.apart > grown) return {Verdict::integrators_differ, c.apart, grown};
  // An error of the energy is one of the period too, however stable the orbit is; and an error may grow on the way that
  // the multipliers, once around, do not show.
  const double shear = std::fmax(evidence.period * c.steepness * c.steepness, c.displaced_growth);
  const double returned = explained * (growth + shear);
  if (c.single_shot > returned && returned < nearby * c.reach)
    return {Verdict::return_contradicts, c.single_shot, returned};

  if (c.symmetry_defect > explained) return {Verdict::not_symmetric, c.symmetry_defect, explained};
  // An orbit that is all error has no period at all.
  if (c.recurrence <= std::min(explained, resolved)) return {Verdict::not_minimal, c.recurrence, explained};
  if (c.tail > resolved) return {Verdict::truncated, c.tail, resolved};

  if (c.pairing > unpaired_by) return {Verdict::unpaired, c.pairing, unpaired_by};
  const double index_allowed =
      times_index_bound * evidence.index_error + unpaired_by * (1.0 + std::abs(evidence.index));
  if (const double gap = std::abs(c.index - evidence.index); gap > index_allowed)
    return {Verdict::other_multipliers, gap, index_allowed};
  if (c.distance > resolved || (c.contraction > contracting && c.distance > beyond_rounding * evidence.amplitude))
    return {Verdict::no_orbit_near, c.distance, resolved};

  // Newton's method follows an orbit segment by segment, however unstable it is.
  const bool is_confirmed = c.distance <= resolved;
  if (c.closure > resolved && !is_confirmed) return {Verdict::says_nothing, c.closure, resolved};
  return {Verdict::holds, c.closure, resolved};
}

}  // namespace orbweaver::certificate
