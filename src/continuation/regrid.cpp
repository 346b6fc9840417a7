#include "regrid.hpp"

#include <algorithm>
#include <cmath>

#include "cell_counts.hpp"
#include "guard_rate.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"

namespace orbweaver::continuation {

namespace {

/// Harmonics of density to try; many serve loops that go several times around. Where the fewer need no less than the
/// present map, the more are not tried: on the earth-moon families and the pendulum's, of 375 times, they then needed
/// less in 6, by 3 to 9 %, which does not pay.
constexpr int density_harmonics[] = {16, 32};
/// Harmonics of the density's logarithm to try for orbits that may have time scales far apart.
constexpr int scale_harmonics[] = {16, 32, 64};
/// Rates far from all guards to try, in parts of 2 pi/T. Larger ones spend harmonics where the orbit is slow.
constexpr double base_rates[] = {0.03, 0.3, 1.0};
/// A new general map is to need at most this share of the harmonics: less would not repay the regrid.
constexpr double general_pays = 0.8;
/// Harmonics to have above those needed: after a fit, or after harmonics were dropped, a number of cells more; after a
/// sharper pulse half of that, since the next steps may sharpen it again. Not measured.
int with_room(int harmonics) { return harmonics * 6 / 5; }
int with_little_room(int harmonics) { return harmonics * 11 / 10; }
/// Pulses tried where the tail asks for more cells: the present kappa, and one and two steps of 1.2 (from one number of
/// cells to the next). A sharper one is taken where it needs 3 % fewer harmonics; neither number was measured, and both
/// decide only about cells.
constexpr double pulse_factors[] = {1.0, 1.2, 1.44};
constexpr double pulse_pays = 0.97;
/// kappa is kept to thousandths, finer than harmonics can tell: maps of one pulse then compare equal.
constexpr double kappa_parts = 1000.0;
/// Of the bound on the tail: harmonics below it are dropped. At the bound itself cells would come and go.
constexpr double dropped_from_cells = 0.1;

double harmonic_norm(const loop::Loop& loop, int k) {
  double square = 0.0;
  for (int i = 0; i < loop.dimension; ++i)
    square += loop.cosine(k, i) * loop.cosine(k, i) + loop.sine(k, i) * loop.sine(k, i);
  return std::sqrt(square);
}

/// The highest harmonic above the limit.
int harmonics_needed(const loop::Loop& loop, double limit) {
  int k = loop.cutoff;
  while (k > 1 && harmonic_norm(loop, k) < limit) --k;
  return k;
}

}  // namespace

std::optional<Resolution> general_resolution(const equations::Collocation& equations, const std::vector<double>& values,
                                             const loop::Isotropy& isotropy, double tolerance, int least_cutoff,
                                             double least_density) {
  const loop::Loop loop = equations.to_loop(values.data());
  const int own = loop::harmonics_above(loop, tolerance);
  loop::TimeMapFit best{loop.time_map, own};
  for (const int most : density_harmonics) {
    loop::TimeMapFit fit = loop::fit_general(loop, isotropy, tolerance, most, least_density);
    if (fit.harmonics >= best.harmonics) break;
    best = std::move(fit);
  }
  if (!equations.system().structure().guards.empty())
    for (const double base : base_rates) {
      loop::TimeMapFit fit =
          loop::fit_to_rate(loop, guard_rate(equations.system(), loop.period, base), isotropy, tolerance);
      if (fit.harmonics < best.harmonics) best = std::move(fit);
    }
  if (equations.system().structure().dissipative)  // slow manifolds
    for (const int most : scale_harmonics) {
      loop::TimeMapFit fit = loop::fit_scales(loop, isotropy, tolerance, most);
      if (fit.harmonics < best.harmonics) best = std::move(fit);
    }
  if (best.map == loop.time_map || best.harmonics > general_pays * own || !loop::is_invariant(best.map, isotropy))
    return std::nullopt;
  const int cutoff = std::max(with_room(best.harmonics), least_cutoff);
  const int cells = cell_counts::at_least_for_cutoff(equations.grid().domain(), cutoff);
  if (cells > equations.cells()) return std::nullopt;
  return Resolution{cells, best.map};
}

std::optional<Resolution> finer_resolution(const equations::Collocation& equations, const std::vector<double>& values,
                                           double tail_limit, int largest_cutoff, bool fit_pulse) {
  const loop::FundamentalDomain& domain = equations.grid().domain();
  const auto cutoff_of = [&](int cells) { return cell_counts::cutoff_of(domain, cells); };
  Resolution best{cell_counts::next(equations.cells()), equations.time_map()};
  const bool tail_decides = loop::tail(equations.to_loop(values.data())) > tail_limit;
  if (fit_pulse && tail_decides && domain.order <= 2 && best.time_map.coefficients.empty()) {
    const int trial_cells = best.size;
    int fewest = cutoff_of(best.size);
    for (const double factor : pulse_factors) {
      loop::TimeMap map = equations.time_map();
      map.kappa = std::round(kappa_parts * map.kappa * factor) / kappa_parts;
      equations::Collocation trial(equations.system(), domain, equations.centre(), equations.winding(), trial_cells,
                                   map);
      const loop::Loop loop = trial.to_loop(trial.resampled(equations, values).data());
      const int needed = harmonics_needed(loop, tail_limit);
      if (factor == 1.0) {
        fewest = needed;
      } else if (needed < pulse_pays * fewest) {
        fewest = needed;
        best.time_map = map;
      }
    }
    // Room above what is needed now, so that the next steps have enough.
    const int mapped = std::max(cell_counts::at_least_for_cutoff(domain, with_little_room(fewest)), equations.cells());
    if (!(best.time_map == equations.time_map()) && cutoff_of(mapped) <= largest_cutoff)
      best.size = mapped;
    else
      best.time_map = equations.time_map();
  }
  if (cutoff_of(best.size) > largest_cutoff) return std::nullopt;
  return best;
}

std::optional<int> coarser_cells(const loop::Loop& loop, const loop::FundamentalDomain& domain, double tail_limit,
                                 int least_cutoff) {
  const int two_thirds = 2 * loop.cutoff / 3;
  for (int k = two_thirds; k <= loop.cutoff; ++k)
    if (harmonic_norm(loop, k) > dropped_from_cells * tail_limit) return std::nullopt;
  const int needed = harmonics_needed(loop, dropped_from_cells * tail_limit);
  return cell_counts::at_least_for_cutoff(domain, std::max(with_room(needed), least_cutoff));
}

}  // namespace orbweaver::continuation
