// What rank 0 spends on the tree of families while a survey runs: the time per task that ends, and that of the tables
// at the end, for a tree of made-up outcomes: bench_tree [--families N].
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "support/stated_system.hpp"
#include "survey/tree_outcomes.hpp"
#include "tasks/payload/keys.hpp"
#include "tree/family_tree.hpp"

namespace {

using namespace orbweaver;
/// Of this process on its processor.
double microseconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// What a task of a survey carries: a first orbit of 60 harmonics.
survey::BranchWork with_orbit(survey::BranchWork work) {
  const std::vector<double> point(4, 0.0);
  work.base = loop::constant_loop(point, 10.0, 60);
  work.direction.modes.assign(work.base.modes.size(), 0.1);
  return work;
}

/// Places along one parent, in pairs: what leaves the first of two arrives at the second, and the other way round.
/// Periods and energies of all places are spread evenly.
std::vector<test::Place> places_on(const std::string& parent, int depth, int count, int& before) {
  std::vector<test::Place> places;
  for (int n = 0; n < count; ++n, ++before) {
    const double period = 8.0 + 12.0 * std::fmod(before * std::numbers::phi, 1.0);
    const double arclength = 0.5 + 3.0 * std::fmod(before * std::numbers::sqrt2, 1.0);
    places.push_back({fmt::format("{}/{:03}.q4.j1", parent, n), period, arclength, 2, parent, depth});
  }
  return places;
}

struct Times {
  double wanted = 0.0;
  double add = 0.0;
  int tasks = 0;
};

}  // namespace

int main(int argc, char** argv) {
  int families = 10000;
  CLI::App app("the tree of families, alone");
  app.add_option("--families", families);
  CLI11_PARSE(app, argc, argv);

  const scene::Scene scene = scene::parse(
      "system: {name: double_pendulum}\nstarts: {fixed_points: {grid: [[0, 180], [0, 180]]}}\nlimits: {families: "
      "1000000}\n",
      "the scene of a benchmark");
  survey::FamilyTree tree(scene, test::structure_of("double_pendulum"));
  Times recent;
  int known = 0;
  const auto add = [&](const test::Ended& ended) {
    const double began = microseconds();
    tree.add(ended.task, ended.outcome);
    recent.add += (microseconds() - began);
    ++recent.tasks;
  };
  const auto wanted = [&](const survey::BranchWork& work) {
    const queue::Task task = task_of(survey::StartWork{work});
    const double began = microseconds();
    const bool answer = tree.wanted(task);
    recent.wanted += (microseconds() - began);
    return answer;
  };
  std::printf("families  wanted, us  add, us\n");
  std::vector<std::string> parents{"0000.0000"};
  add(test::ended(with_orbit(test::base_work()), continuation::EndReason::period_limit, 5, 12));
  constexpr int places_a_branch = 20;
  int places_before = 0;
  int next_report = std::max(1, families / 8);
  // Every other family does not come to be asked for in time, as where many ranks work: it runs as well, and is
  // dropped.
  for (std::size_t at = 0; at < parents.size() && known < families; ++at) {
    const std::string parent = parents[at];
    const int depth = survey::depth_of(parent);
    const std::vector<test::Place> places = places_on(parent, depth, places_a_branch, places_before);
    for (const test::Place& place : places) add(test::located(place));
    for (int n = 0; n < places_a_branch; ++n)
      for (const int number : {0, 1}) {
        const survey::BranchWork work = with_orbit(test::work_from(places[static_cast<std::size_t>(n)], number));
        const bool asked = wanted(work);
        if (!asked && number == 0) continue;
        add(test::arrived(work, 10, places[static_cast<std::size_t>(n ^ 1)], number));
        ++known;
        if (asked) parents.push_back(work.key);
      }
    if (known >= next_report) {
      std::printf("%8d  %10.1f  %7.1f\n", known, recent.wanted / recent.tasks, recent.add / recent.tasks);
      std::fflush(stdout);
      recent = {};
      next_report *= 2;
    }
  }
  const double began = microseconds();
  const auto result = tree.resolve();
  std::printf("tables of %zu families, %zu crossings: %.1f ms\n", result.families.size(),
              result.tables.crossings.size(), 1e-3 * (microseconds() - began));
  return 0;
}
