#include "base_families.hpp"

#include <fmt/format.h>

#include "end_text.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/starts/fixed_points.hpp"
#include "orbweaver/survey/tree/naming.hpp"
#include "tasks/work/work.hpp"

namespace orbweaver::survey {

std::vector<queue::Task> sweep_tasks(const scene::Scene& scene, const systems::System& system) {
  std::vector<queue::Task> tasks;
  for (const std::vector<double>& point : starts::find_fixed_points(system, scene.fixed_points.grid))
    tasks.push_back(task_of(SweepWork{static_cast<int>(tasks.size()), point}));
  core::log_info(fmt::format("{} equilibria; sweeping the period from {:g} to {:g} at each", tasks.size(),
                             scene.sweep.period_from, scene.sweep.period_to));
  if (tasks.empty())
    throw core::InputError(
        "Newton's method finds no equilibrium from starts.fixed_points.grid: give start values nearer to one");
  return tasks;
}

std::vector<queue::Task> base_family_tasks(const scene::Scene& scene, const systems::System& system,
                                           const SweepsEnded& sweeps, Summary& summary) {
  std::vector<queue::Task> tasks;
  for (const auto& [key, ended] : sweeps) {
    const auto& [task, outcome] = ended;
    if (outcome.failed) continue;  // gather_failed_sweeps
    const SweepOutcome found = unpack_sweep_outcome(outcome.payload);
    if (found.modes.empty() && found.rejected.empty())
      summary.remarks.push_back(fmt::format("no small oscillations around {} for T in [{:g}, {:g}]",
                                            point_text(system, found.point), scene.sweep.period_from,
                                            scene.sweep.period_to));
    for (const std::string& reason : found.rejected)
      summary.remarks.push_back(fmt::format("dip passed over at {}: {}", point_text(system, found.point), reason));
    for (std::size_t n = 0; n < found.modes.size(); ++n) {
      const std::string name = base_family_name(scene, system, found.point, found.index, static_cast<int>(n));
      const std::string branch_key = fmt::format("{:04}.{:04}", found.index, n);
      const FoundMode& mode = found.modes[n];
      BranchWork work;
      work.key = work.lineage.family = branch_key;
      work.name = name;
      work.direction = mode.direction;
      work.isotropy = mode.isotropy;
      work.base = loop::constant_loop(found.point, mode.period, mode.cutoff);
      if (mode.one_direction) {
        tasks.push_back(task_of(work));
        continue;
      }
      work.key = work.lineage.family = branch_key + "+";
      tasks.push_back(task_of(work));
      work.key = work.lineage.family = branch_key + "-";
      work.name += " (other side)";
      work.direction *= -1.0;
      tasks.push_back(task_of(work));
    }
  }
  const auto allowed = static_cast<std::size_t>(scene.limits.families);
  if (tasks.size() > allowed) {
    summary.remarks.push_back(fmt::format("{} families found, {} followed (limits.families)", tasks.size(), allowed));
    tasks.resize(allowed);
  }
  return tasks;
}

void gather_failed_sweeps(const systems::System& system, const SweepsEnded& sweeps, Summary& summary,
                          archive::Records& tables) {
  for (const auto& [key, ended] : sweeps) {
    const auto& [task, outcome] = ended;
    if (!outcome.failed) continue;
    const SweepWork work = unpack_sweep_work(task.payload);
    archive::FamilyRecord record;
    record.key = fmt::format("{:04}", work.index);
    record.name = fmt::format("Equilibrium {}", work.index + 1);
    record.end_reason =
        limited(failure_text(fmt::format("the sweep at {}: {}", point_text(system, work.point), outcome.reason)));
    summary.families.push_back({record.key, record.name, "", 0, 0.0, 0.0, 0.0, 0.0, record.end_reason, true});
    summary.failed_tasks.push_back(fmt::format("{}: {}", key, outcome.reason));
    tables.families.push_back(std::move(record));
  }
}

}  // namespace orbweaver::survey
