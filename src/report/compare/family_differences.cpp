#include "compare/family_differences.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "compare/orbit_places.hpp"
#include "orbweaver/loop/symmetry/conjugacy.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"

namespace orbweaver::report {

namespace {

/// Steps of the other family by which one may begin or end beyond it: where no limit fixes the last orbit, that is a
/// matter of the steps; they grow by less than this from one to the next.
constexpr double reach = 2.0;
/// At the birth: the first orbit's distance from the crossing or the equilibrium is the scene's or what served.
constexpr double reach_at_birth = 10.0;

std::string level_text(const AtlasTree& tree, double level) {
  return std::isnan(level) ? "" : fmt::format(" ({} = {:.9g})", level_name(tree), level);
}

// Orbits at the beginning and at the end of a family that have no place on the other's curve.
struct Overhang {
  std::size_t before;  // orbits
  std::size_t after;
};

Overhang overhang_of(const std::vector<CurveFit>& fits) {
  const auto fits_there = [](const CurveFit& fit) { return fit.fits(); };
  const auto first = std::find_if(fits.begin(), fits.end(), fits_there);
  const auto last = std::find_if(fits.rbegin(), fits.rend(), fits_there);
  return {static_cast<std::size_t>(first - fits.begin()), static_cast<std::size_t>(last - fits.rbegin())};
}

bool runs_the_other_way(const std::vector<CurveFit>& fits) {
  const Overhang out = overhang_of(fits);
  if (out.before + out.after >= fits.size()) return false;
  return fits[out.before].segment > fits[fits.size() - 1 - out.after].segment;
}

double step_at(const TreeFamily& family, bool at_its_end) {
  const std::size_t n = family.orbits();
  if (n < 2) return 0.0;
  return at_its_end ? family.arclengths[n - 1] - family.arclengths[n - 2] : family.arclengths[1] - family.arclengths[0];
}

bool has_end_at(const TreeFamily& family, std::size_t orbit) {
  return std::any_of(family.ends.begin(), family.ends.end(),
                     [orbit](const FamilyEnd& end) { return end.orbit == orbit; });
}

/// How far a family is followed there is a matter of the steps: it goes on beyond what can be computed.
bool is_open_end(const TreeFamily& family, std::size_t orbit) {
  return std::any_of(family.ends.begin(), family.ends.end(), [orbit](const FamilyEnd& end) {
    const bool is_open = end.kind == survey::EndKind::collision || end.kind == survey::EndKind::period_divergence;
    return is_open && end.orbit == orbit;
  });
}

double relative_distance(const Invariants& x, const Invariants& y, Invariant i) {
  return std::abs(x.value(i) - y.value(i)) / x.scale_of(i);
}

double distance(const TreeFamily& a, const FamilyEnd& x, const TreeFamily& b, const FamilyEnd& y) {
  const Invariants& one = a.curve.points()[x.orbit];
  const Invariants& other = b.curve.points()[y.orbit];
  const double in_level = relative_distance(one, other, Invariant::level);
  return relative_distance(one, other, Invariant::period) + (std::isnan(in_level) ? 0.0 : in_level);
}

/// "energy", or the name of the parameter that moves, for the level.
std::string told(const AtlasTree& tree, Invariant invariant) {
  if (invariant != Invariant::level) return name_of(invariant);
  return tree.in_parameter() ? tree.parameter : "energy";
}

}  // namespace

void FamilyDifferences::add(DifferenceKind kind, const Pair& pair, std::string text, double by, double allowed) {
  _result.differences.push_back({kind, pair.a.name, pair.b.name, std::move(text), by, allowed});
}

void FamilyDifferences::note_deviation(const std::string& quantity, double value, double allowed,
                                       const std::string& where) {
  if (std::isnan(value)) return;
  const auto known = std::find_if(_result.largest.begin(), _result.largest.end(),
                                  [&](const LargestDeviation& other) { return other.quantity == quantity; });
  if (known == _result.largest.end())
    _result.largest.push_back({quantity, value, allowed, where});
  else if (value * known->allowed > known->value * allowed)
    *known = {quantity, value, allowed, where};
}

void FamilyDifferences::run() {
  for (std::size_t row = 0; row < _a.families.size(); ++row) {
    const int other = _match.family_of_a[row];
    if (other >= 0) compare({static_cast<int>(row), _a.families[row], _b.families[index(other)]});
  }
  add_missing(_a, _match.family_of_a, true);
  add_missing(_b, _match.family_of_b, false);
}

void FamilyDifferences::compare(const Pair& pair) {
  ++_result.families;
  if (pair.a.name != pair.b.name) {
    _result.renamed.push_back({pair.a.name, pair.b.name});
    if (_options.strict_names) add(DifferenceKind::name, pair, fmt::format("is called {} in B", pair.b.name));
  }
  compare_birth(pair);
  compare_orbits(pair);
  compare_ends(pair);
  compare_crossings(pair);
}

void FamilyDifferences::compare_birth(const Pair& pair) {
  const auto born = [](const AtlasTree& tree, const TreeFamily& family) {
    if (family.parent < 0) return std::string("without a parent");
    const std::string crossing = family.crossing < 0 ? "" : " at " + place_text(tree.crossings[index(family.crossing)]);
    return fmt::format("on {}{}", tree.families[index(family.parent)].name, crossing);
  };
  if (_match.is_born_elsewhere[index(pair.row_a)])
    add(DifferenceKind::birth, pair, fmt::format("was born {} in A, {} in B", born(_a, pair.a), born(_b, pair.b)));
  if (pair.a.multiplicity != pair.b.multiplicity)
    add(DifferenceKind::birth, pair,
        fmt::format("goes {} times around its parent in A, {} times in B", pair.a.multiplicity, pair.b.multiplicity));
  if (pair.a.isotropy == pair.b.isotropy) return;
  const systems::Structure* system = _loops.structure();
  if (system != nullptr && loop::are_conjugate(*system, loop::isotropy_of(*system, pair.a.isotropy),
                                               loop::isotropy_of(*system, pair.b.isotropy)))
    return;
  add(DifferenceKind::isotropy, pair,
      fmt::format("isotropy is '{}' in A, '{}' in B", pair.a.isotropy, pair.b.isotropy));
}

/// Numbers that one has for its orbits and the other has not: no curve shows that.
void FamilyDifferences::compare_known(const Pair& pair) {
  if (pair.a.orbits() == 0 || pair.b.orbits() == 0) return;
  for (const Invariant invariant : all_invariants) {
    const auto unknown_in = [invariant](const TreeFamily& family) {
      const std::vector<Invariants>& points = family.curve.points();
      return static_cast<std::size_t>(std::count_if(
          points.begin(), points.end(), [invariant](const Invariants& x) { return std::isnan(x.value(invariant)); }));
    };
    const std::size_t in_a = unknown_in(pair.a);
    const std::size_t in_b = unknown_in(pair.b);
    if ((in_a == 0) == (in_b == 0)) continue;
    const std::size_t unknown = std::max(in_a, in_b);
    const std::size_t orbits = in_a > 0 ? pair.a.orbits() : pair.b.orbits();
    // Where its error is too large the stability is left out, and orbits at other places lie on the other side of that.
    if (invariant == Invariant::trace && unknown < orbits) continue;
    add(DifferenceKind::orbits, pair,
        fmt::format("{} is known in {}, and for {} of {} orbits of {} it is not", told(_a, invariant),
                    in_a > 0 ? "B" : "A", unknown, orbits, in_a > 0 ? "A" : "B"));
  }
}

void FamilyDifferences::compare_orbits(const Pair& pair) {
  compare_known(pair);
  std::vector<CurveFit> fits_a = fit_all(pair.b.curve, pair.a.curve.points());
  std::vector<CurveFit> fits_b = fit_all(pair.a.curve, pair.b.curve.points());
  const bool one_in_a = pair.a.orbits() == 1 && pair.b.orbits() > 1;
  const bool one_in_b = pair.b.orbits() == 1 && pair.a.orbits() > 1;
  if (one_in_a || one_in_b) {  // one orbit is no curve on which others could lie
    _result.notes.push_back(
        fmt::format("{} has one orbit in {}, which was held against the other's curve; the rest was not compared",
                    pair.a.name, one_in_a ? "A" : "B"));
    if (one_in_a) report_orbits(pair, "A", pair.a, fits_a);
    if (one_in_b) report_orbits(pair, "B", pair.b, fits_b);
    return;
  }
  OrbitPlaces({_a, pair.a}, {_b, pair.b}, _loops, _options, _result).settle(fits_a);
  OrbitPlaces({_b, pair.b}, {_a, pair.a}, _loops, _options, _result).settle(fits_b);
  report_orbits(pair, "A", pair.a, fits_a);
  report_orbits(pair, "B", pair.b, fits_b);
  compare_reach(pair, fits_a, fits_b);
  compare_loops(pair, fits_a);
}

void FamilyDifferences::report_orbits(const Pair& pair, const char* which, const TreeFamily& family,
                                      const std::vector<CurveFit>& fits) {
  const Overhang out = overhang_of(fits);
  const bool none = out.before == fits.size();
  const std::size_t first = none ? 0 : out.before;
  const std::size_t last = none ? fits.size() : fits.size() - out.after;
  std::size_t off = 0;
  std::size_t worst = first;
  for (std::size_t n = first; n < last; ++n) {
    if (!fits[n].fits()) {
      if (off++ == 0 || fits[n].excess > fits[worst].excess) worst = n;
      continue;
    }
    ++_result.orbits;
    note_deviation(fmt::format("{} of orbits", name_of(fits[n].worst)), fits[n].deviation, fits[n].allowed,
                   fmt::format("{}, {}", family.name, orbit_text(_a, family, n)));
  }
  if (off == 0) return;
  const CurveFit& fit = fits[worst];
  const std::string how =
      std::isinf(fit.excess)
          ? fmt::format("nothing of it is beside {}", orbit_text(_a, family, worst))
          : fmt::format("{} at {} is off by {:.2e} relative, where {:.1e} is allowed", name_of(fit.worst),
                        orbit_text(_a, family, worst), fit.deviation, fit.allowed);
  add(DifferenceKind::orbits, pair,
      fmt::format("{} of {} orbits of {} lie off the curve of the other: {}", off, fits.size(), which, how),
      fit.deviation, fit.allowed);
}

void FamilyDifferences::compare_reach(const Pair& pair, const std::vector<CurveFit>& fits_a,
                                      const std::vector<CurveFit>& fits_b) {
  const bool turned = runs_the_other_way(fits_a);
  const Overhang out_a = overhang_of(fits_a);
  Overhang out_b = overhang_of(fits_b);
  if (out_a.before == fits_a.size() || out_b.before == fits_b.size()) {
    if ((fits_a.empty() || fits_b.empty()) && fits_a.size() != fits_b.size())
      add(DifferenceKind::range, pair, fmt::format("has {} orbits in A, {} in B", fits_a.size(), fits_b.size()));
    return;  // else: said already
  }
  const auto compare_side = [&](bool at_end_of_a) {
    const bool at_end_of_b = at_end_of_a != turned;
    const std::size_t more_a = at_end_of_a ? out_a.after : out_a.before;
    const std::size_t more_b = at_end_of_b ? out_b.after : out_b.before;
    const std::size_t last_a = at_end_of_a ? pair.a.orbits() - 1 : 0;
    const std::size_t last_b = at_end_of_b ? pair.b.orbits() - 1 : 0;
    if (more_a > 0 && more_b > 0) {
      const std::size_t place = at_end_of_a ? pair.a.orbits() - more_a : more_a - 1;
      add(DifferenceKind::orbits, pair,
          fmt::format("A and B part at {}: {} orbits of A and {} of B lie off the curve of the other",
                      orbit_text(_a, pair.a, place), more_a, more_b));
      return;
    }
    if (more_a == 0 && more_b == 0) return;
    const bool a_goes_on = more_a > 0;
    const TreeFamily& longer = a_goes_on ? pair.a : pair.b;
    const TreeFamily& shorter = a_goes_on ? pair.b : pair.a;
    const bool at_end_of_longer = a_goes_on ? at_end_of_a : at_end_of_b;
    const std::size_t more = a_goes_on ? more_a : more_b;
    const std::size_t n = longer.orbits();
    const double beyond = at_end_of_longer ? longer.arclengths[n - 1] - longer.arclengths[n - more]
                                           : longer.arclengths[more - 1] - longer.arclengths[0];
    const double step = step_at(shorter, a_goes_on ? at_end_of_b : at_end_of_a);
    const bool is_end = has_end_at(pair.a, last_a) || has_end_at(pair.b, last_b);
    const double allowed = (is_end ? reach : reach_at_birth) * step;
    if (beyond <= allowed) return;
    const std::string text =
        fmt::format("goes {} orbits further in {}, to {}, than in {}, which {} at {}", more, a_goes_on ? "A" : "B",
                    orbit_text(_a, longer, a_goes_on ? last_a : last_b), a_goes_on ? "B" : "A",
                    is_end ? "ends" : "begins", orbit_text(_a, shorter, a_goes_on ? last_b : last_a));
    if (is_open_end(pair.a, last_a) && is_open_end(pair.b, last_b))
      _result.notes.push_back(fmt::format("{} {}", pair.a.name, text));
    else
      add(DifferenceKind::range, pair, text, beyond, allowed);
  };
  compare_side(false);
  compare_side(true);
}

void FamilyDifferences::compare_loops(const Pair& pair, const std::vector<CurveFit>& fits) {
  const auto samples = _loops.sample(_a, pair.a, _b, pair.b, fits, _options.loops);
  _result.loops += samples.size();
  for (const LoopCheck::Sample& sample : samples) {
    const std::string where = orbit_text(_a, pair.a, sample.orbit);
    if (sample.answer.same) {
      note_deviation("loops", sample.answer.distance, sample.answer.allowed, fmt::format("{}, {}", pair.a.name, where));
      continue;
    }
    if (_loops.are_same(_a, pair.a, _b, pair.b)) continue;  // Newton's method failed beside this one
    if (!sample.answer.decided) {
      _result.notes.push_back(
          fmt::format("{} at {} has the numbers of the other's family; its loop could not be compared: {}", pair.a.name,
                      where, sample.answer.detail));
      continue;
    }
    add(DifferenceKind::loop, pair,
        fmt::format(
            "the orbit of A at {} has the numbers of B's family and is not one of its loops: {}, distance {:.1e}",
            where, sample.answer.detail, sample.answer.distance),
        sample.answer.distance, sample.answer.allowed);
    return;
  }
}

void FamilyDifferences::compare_ends(const Pair& pair) {
  std::vector<FamilyEnd> ends_b = pair.b.ends;
  const bool have_orbits = pair.a.orbits() > 0 && pair.b.orbits() > 0;
  if (_match.is_born_elsewhere[index(pair.row_a)]) return;  // the other end was its birth
  if (pair.a.ends.size() != ends_b.size()) {
    add(DifferenceKind::end_reason, pair, fmt::format("has {} ends in A, {} in B", pair.a.ends.size(), ends_b.size()));
    return;
  }
  bool turned = false;
  if (ends_b.size() == 2 && have_orbits) {
    const double straight =
        distance(pair.a, pair.a.ends[0], pair.b, ends_b[0]) + distance(pair.a, pair.a.ends[1], pair.b, ends_b[1]);
    const double crossed =
        distance(pair.a, pair.a.ends[0], pair.b, ends_b[1]) + distance(pair.a, pair.a.ends[1], pair.b, ends_b[0]);
    turned = crossed < straight;
    if (turned) std::swap(ends_b[0], ends_b[1]);
  }
  for (std::size_t n = 0; n < ends_b.size(); ++n) {
    const FamilyEnd& a = pair.a.ends[n];
    const FamilyEnd& b = ends_b[n];
    if (a.kind != b.kind) {
      add(DifferenceKind::end_reason, pair,
          fmt::format("ended by '{}' in A, by '{}' in B", survey::name_of(a.kind), survey::name_of(b.kind)));
      continue;
    }
    if (!have_orbits) continue;
    // The last orbit has exactly the limit's period or energy.
    const auto at_limit = [&](survey::EndKind kind, Invariant invariant) {
      if (a.kind != kind) return;
      const Invariants& x = pair.a.curve.points()[a.orbit];
      const Invariants& y = pair.b.curve.points()[b.orbit];
      const double by = relative_distance(x, y, invariant);
      const double allowed = x.floor_of(invariant) / x.scale_of(invariant);
      if (by > allowed)
        add(DifferenceKind::end_place, pair,
            fmt::format("ends with {} = {:.12g} in A, {:.12g} in B", told(_a, invariant), x.value(invariant),
                        y.value(invariant)),
            by, allowed);
    };
    at_limit(survey::EndKind::period_limit, Invariant::period);
    at_limit(survey::EndKind::energy_limit, _a.in_parameter() ? Invariant::energy : Invariant::level);
    at_limit(survey::EndKind::parameter_limit, Invariant::level);
  }
  if (turned) return;  // the columns hold one of the two
  const auto other_of = [](const std::vector<int>& match, int row) { return row < 0 ? -1 : match[index(row)]; };
  const int family = other_of(_match.family_of_a, pair.a.end_family);
  const int crossing = other_of(_match.crossing_of_a, pair.a.end_crossing);
  const bool same_family = (pair.a.end_family < 0) == (pair.b.end_family < 0) && family == pair.b.end_family;
  const bool same_crossing = (pair.a.end_crossing < 0) == (pair.b.end_crossing < 0) && crossing == pair.b.end_crossing;
  if (same_family && same_crossing) return;
  const auto target = [](const AtlasTree& tree, const TreeFamily& end) {
    if (end.end_family < 0) return std::string("nothing");
    const std::string place = end.end_crossing < 0 ? "" : " at " + place_text(tree.crossings[index(end.end_crossing)]);
    return tree.families[index(end.end_family)].name + place;
  };
  add(DifferenceKind::end_target, pair, fmt::format("joined {} in A, {} in B", target(_a, pair.a), target(_b, pair.b)));
}

void FamilyDifferences::compare_crossings(const Pair& pair) {
  for (const int crossing : pair.a.crossings) {
    const int other = _match.crossing_of_a[index(crossing)];
    if (other >= 0)
      compare_places(pair, crossing, other);
    else
      add(DifferenceKind::crossing_only_in_a, pair,
          fmt::format("{}{} is in A only", place_text(_a.crossings[index(crossing)]),
                      level_text(_a, _a.crossings[index(crossing)].level)));
  }
  for (const int crossing : pair.b.crossings)
    if (_match.crossing_of_b[index(crossing)] < 0)
      add(DifferenceKind::crossing_only_in_b, pair,
          fmt::format("{}{} is in B only", place_text(_b.crossings[index(crossing)]),
                      level_text(_b, _b.crossings[index(crossing)].level)));
}

void FamilyDifferences::compare_places(const Pair& pair, int crossing_a, int crossing_b) {
  const TreeCrossing& a = _a.crossings[index(crossing_a)];
  const TreeCrossing& b = _b.crossings[index(crossing_b)];
  ++_result.crossings;
  const std::string where = fmt::format("{}, {}", pair.a.name, place_text(a));
  const auto compare_place = [&](const char* quantity, double x, double y, double scale, double open) {
    if (std::isnan(x) != std::isnan(y))
      add(DifferenceKind::crossing_place, pair,
          fmt::format("{}: {} is {:.15g} in A, {:.15g} in B", place_text(a), quantity, x, y));
    const double by = std::abs(x - y) / scale;
    const double allowed = _options.tolerance + open / scale;
    note_deviation(fmt::format("{} of crossings", quantity), by, allowed, where);
    if (by > allowed)
      add(DifferenceKind::crossing_place, pair,
          fmt::format("{}: {} is {:.15g} in A, {:.15g} in B: {:.2e} relative, where {:.1e} is allowed", place_text(a),
                      quantity, x, y, by, allowed),
          by, allowed);
  };
  // What both leave open of their places.
  compare_place("period", a.period, b.period, a.period, a.place_error_period + b.place_error_period);
  compare_place(_a.in_parameter() ? "parameter" : "energy", a.level, b.level, a.level_scale,
                a.place_error_level + b.place_error_level);
  if (a.kernel_dimension != b.kernel_dimension)
    add(DifferenceKind::crossing_kernel, pair,
        fmt::format("{}: the kernel has dimension {} in A, {} in B", place_text(a), a.kernel_dimension,
                    b.kernel_dimension));
  if (a.fundamental_order != b.fundamental_order)
    add(DifferenceKind::crossing_kernel, pair,
        fmt::format("{}: the fundamental map is of order {} in A, {} in B", place_text(a), a.fundamental_order,
                    b.fundamental_order));
}

void FamilyDifferences::add_missing(const AtlasTree& tree, const std::vector<int>& matched, bool is_in_a) {
  for (std::size_t row = 0; row < tree.families.size(); ++row) {
    if (matched[row] >= 0) continue;
    const TreeFamily& family = tree.families[row];
    const std::string born = family.parent < 0 || family.crossing < 0
                                 ? "without a parent"
                                 : fmt::format("born on {} at {}", tree.families[index(family.parent)].name,
                                               place_text(tree.crossings[index(family.crossing)]));
    Difference difference;
    difference.kind = is_in_a ? DifferenceKind::only_in_a : DifferenceKind::only_in_b;
    (is_in_a ? difference.family_a : difference.family_b) = family.name;
    difference.text = fmt::format("is in {} only: {}, {} orbits{}", is_in_a ? "A" : "B", born, family.orbits(),
                                  family.orbits() > 0 ? ", from " + orbit_text(_a, family, 0) : "");
    _result.differences.push_back(std::move(difference));
  }
}

}  // namespace orbweaver::report
