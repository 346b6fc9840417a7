#include "regrid.hpp"

#include <algorithm>
#include <cmath>

#include "cell_counts.hpp"

namespace orbweaver::continuation {

namespace {

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

std::optional<Resolution> finer_resolution(const corrector::Collocation& equations, const std::vector<double>& values,
                                           double tail_limit, int largest_cutoff, bool fit_time_map) {
  const loop::FundamentalDomain& domain = equations.grid().domain();
  const auto cutoff_of = [&](int cells) { return (cells * domain.copies() - 1) / 2; };
  Resolution best{cell_counts::next(equations.cells()), equations.time_map()};
  const bool tail_decides = loop::tail(equations.to_loop(values.data())) > tail_limit;
  if (fit_time_map && tail_decides && domain.order <= 2) {
    const int trial_cells = best.cells;
    int fewest = cutoff_of(best.cells);
    for (const double factor : {1.0, 1.2, 1.44}) {
      loop::TimeMap map = equations.time_map();
      map.kappa = std::round(1000.0 * map.kappa * factor) / 1000.0;
      corrector::Collocation trial(equations.system(), domain, equations.centre(), equations.winding(), trial_cells,
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
      best.cells = mapped;
    else
      best.time_map = equations.time_map();
  }
  if (cutoff_of(best.cells) > largest_cutoff) return std::nullopt;
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
