#include "resolution.hpp"

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "correction.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loop/grid/time_map_fit.hpp"
#include "reach.hpp"
#include "timing.hpp"

namespace orbweaver::cost {

namespace {

/// Below what any loop reaches: every solver goes on as far as it can.
constexpr double beyond_reach = 1e-14;
constexpr double rung = 1.5;  // cutoffs grow by this
constexpr double quick_rung = 2.2;
constexpr int first_cutoff = 4;
/// From the cutoff that the branch took on: twice the harmonics show the floor.
constexpr int beyond = 2;
/// Without a time map an orbit may take many times the harmonics: so many that whole loops are solved in a second.
constexpr int most_cutoff = 1500;

std::vector<int> cutoffs_to(int last, double factor) {
  std::vector<int> cutoffs;
  for (double k = first_cutoff; cutoffs.empty() || cutoffs.back() < last; k *= factor) {
    const int cutoff = loop::allowed_cutoff_at_least(static_cast<int>(std::lround(k)));
    if (cutoffs.empty() || cutoff > cutoffs.back()) cutoffs.push_back(cutoff);
  }
  return cutoffs;
}

struct Grid {
  const char* name;
  loop::TimeMap map;
  int last;  ///< cutoff
};

std::vector<Grid> grids_for(const Setting& setting, const Probe& probe) {
  const loop::Loop& loop = probe.orbit.loop;
  const loop::Loop even = loop::evenly_in_time(loop);
  loop::TimeMap fitted = loop.time_map;
  int harmonics = loop.cutoff;
  if (fitted == loop::TimeMap{}) {  // the branch has found none that pays
    const loop::TimeMapFit fit = loop::fit_general(loop, setting.isotropy(), loop::negligible_harmonic);
    fitted = fit.map;
    harmonics = std::max(fit.harmonics, loop.cutoff);
  }
  std::vector<Grid> grids{{"no", {}, std::min(most_cutoff, beyond * even.cutoff)}};
  if (!(fitted == loop::TimeMap{})) grids.push_back({"yes", fitted, std::min(most_cutoff, beyond * harmonics)});
  return grids;
}

void measure_resolution(const Setting& setting, const Take& take) {
  Table table{"resolution",
              fmt::format("{}: error of an orbit against its time as the harmonics K grow", setting.family()),
              {{"orbit"}, {"T"}, {"space"}, {"time map"}, {"K"}, {"unknowns"}, {"time", "s"}, {"error"}},
              {},
              {},
              Plot{6, 7, {2, 3}, 0},
              false};
  Table reach{"resolution_reach",
              fmt::format("{}: seconds in which a way to solve reaches a true error, at the K that is enough",
                          setting.family()),
              {{"orbit"}, {"T"}, {"space"}, {"time map"}},
              {},
              {}};
  for (Column& column : Reach::columns()) reach.columns.push_back(std::move(column));
  const double unit = setting.system()->scales().time;
  const std::string obstacle = obstacle_to_collocation(setting);
  if (!obstacle.empty()) reach.remarks.emplace_back(fmt::format("no collocation: {}", obstacle));
  for (const Probe& probe : setting.probes()) {
    const TrueOrbit& truth = setting.truth_of(probe);
    for (const Grid& grid : grids_for(setting, probe)) {
      std::map<std::string, Reach> reached;
      std::set<std::string> given_up;
      int last_cells = 0;
      for (const int cutoff : cutoffs_to(grid.last, setting.quick() ? quick_rung : rung)) {
        const Directed guess = expanded(probe, grid.map, cutoff);
        const auto add = [&](const char* space, int unknowns, double seconds, const loop::Loop& found) {
          const double error = truth.error_of(found);
          table.rows.push_back(
              {probe.name, probe.orbit.loop.period * unit, space, grid.name, found.cutoff, unknowns, seconds, error});
          reached[space].add(seconds, error);
        };
        for (const auto& [space, isotropy] :
             {std::pair("subspace", setting.isotropy()), std::pair("whole loop", loop::Isotropy{})}) {
          if (given_up.contains(space)) continue;
          const Correction correction(setting, guess, isotropy);
          corrector::Result result;
          try {
            const Timing timing =
                timing_of([&] { result = correction.by(corrector::Method::newton_krylov, beyond_reach); },
                          setting.budget(), setting.patience());
            add(space, correction.unknowns(), timing.seconds, result.loop);
          } catch (const GivenUp&) {
            given_up.insert(space);
          }
        }
        const int cells = cells_for(setting, cutoff);
        if (!obstacle.empty() || cells == last_cells) continue;
        last_cells = cells;
        CollocationResult result;
        const Timing timing = timing_of(
            [&] { result = by_collocation(setting, guess, guess.loop, cells, beyond_reach); }, setting.budget());
        add("collocation", result.unknowns, timing.seconds, result.loop);
      }
      for (const auto& [space, times] : reached) {
        std::vector<Cell> row{probe.name, probe.orbit.loop.period * unit, space, grid.name};
        for (Cell& cell : times.cells()) row.push_back(std::move(cell));
        reach.rows.push_back(std::move(row));
      }
    }
  }
  reach.remarks.emplace_back(
      "subspace and whole loop by newton-krylov, collocation on the fundamental domain; from the true orbit cut off at "
      "K");
  take(table);
  take(reach);
}

}  // namespace

const Ladder resolution_ladder{"resolution", "error of an orbit against its time as K grows", measure_resolution};

}  // namespace orbweaver::cost
