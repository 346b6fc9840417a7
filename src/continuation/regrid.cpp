#include "regrid.hpp"

#include <algorithm>
#include <cmath>

#include "cell_counts.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"

namespace orbweaver::continuation {

namespace {

/// Harmonics of density to try; many serve loops that go several times around.
constexpr int density_harmonics[] = {16, 32};
/// A new general map is to need at most this share of the harmonics.
constexpr double general_pays = 0.8;

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
                                             const loop::Isotropy& isotropy, double tolerance, int least_cutoff) {
  const loop::Loop loop = equations.to_loop(values.data());
  const int own = loop::harmonics_above(loop, tolerance);
  loop::TimeMapFit best{loop.time_map, own};
  for (const int most : density_harmonics) {
    loop::TimeMapFit fit = loop::fit_general(loop, isotropy, tolerance, most);
    if (fit.harmonics >= best.harmonics) break;
    best = std::move(fit);
  }
  if (best.map == loop.time_map || best.harmonics > general_pays * own || !loop::is_invariant(best.map, isotropy))
    return std::nullopt;
  const int cutoff = std::max(best.harmonics * 6 / 5, least_cutoff);
  const int cells = cell_counts::at_least_for_cutoff(equations.grid().domain(), cutoff);
  if (cells > equations.cells()) return std::nullopt;
  return Resolution{cells, best.map};
}

std::optional<Resolution> finer_resolution(const equations::Collocation& equations, const std::vector<double>& values,
                                           double tail_limit, int largest_cutoff, bool fit_pulse) {
  const loop::FundamentalDomain& domain = equations.grid().domain();
  const auto cutoff_of = [&](int cells) { return (cells * domain.copies() - 1) / 2; };
  Resolution best{cell_counts::next(equations.cells()), equations.time_map()};
  const bool tail_decides = loop::tail(equations.to_loop(values.data())) > tail_limit;
  if (fit_pulse && tail_decides && domain.order <= 2 && best.time_map.coefficients.empty()) {
    const int trial_cells = best.size;
    int fewest = cutoff_of(best.size);
    for (const double factor : {1.0, 1.2, 1.44}) {
      loop::TimeMap map = equations.time_map();
      map.kappa = std::round(1000.0 * map.kappa * factor) / 1000.0;
      equations::Collocation trial(equations.system(), domain, equations.centre(), equations.winding(), trial_cells,
                                   map);
      const loop::Loop loop = trial.to_loop(trial.resampled(equations, values).data());
      const int needed = harmonics_needed(loop, tail_limit);
      if (factor == 1.0) {
        fewest = needed;
      } else if (needed < 0.97 * fewest) {
        fewest = needed;
        best.time_map = map;
      }
    }
    // Some room above what is needed now, so that the next steps have enough.
    const int mapped = std::max(cell_counts::at_least_for_cutoff(domain, fewest * 11 / 10), equations.cells());
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
    if (harmonic_norm(loop, k) > 0.1 * tail_limit) return std::nullopt;
  const int needed = harmonics_needed(loop, 0.1 * tail_limit);
  return cell_counts::at_least_for_cutoff(domain, std::max(needed * 6 / 5, least_cutoff));
}

}  // namespace orbweaver::continuation
