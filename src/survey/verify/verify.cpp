#include "orbweaver/survey/verify/verify.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <tuple>
#include <utility>

#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/queue/run_for_outcomes.hpp"
#include "run/display.hpp"
#include "verify/table_rules.hpp"
#include "verify/verified_atlas.hpp"
#include "verify/verify_task.hpp"

namespace orbweaver::survey {

namespace {

using What = VerifyWork::What;

/// Rows a task: a fraction of a second each.
constexpr std::int64_t orbits_a_task = 8;
constexpr std::int64_t checksums_a_task = 512;
constexpr std::int64_t sections_a_task = 256;
constexpr std::int64_t loci_a_task = 8;
constexpr std::int64_t equilibria_a_task = 256;

void add_blocks(What what, std::int64_t first, std::int64_t end, std::int64_t most, std::vector<queue::Task>& tasks) {
  for (; first < end; first += most) tasks.push_back(task_of({what, first, std::min(first + most, end)}));
}

/// Does the tasks, given on rank 0, and adds there what they found.
void run_tasks(const core::Communicator& comm, const std::vector<queue::Task>& tasks, VerifyExecutor& executor,
               Display display, Findings& findings) {
  TaskCountDisplay shown(display);
  const auto outcomes = queue::run_for_outcomes(comm, tasks, executor, shown);
  if (!outcomes) throw core::EnvironmentError("verify: stopped before all was computed");
  core::on_root(comm.get(), [&] {
    // Outcomes come by key, as tasks have been made but for their kinds.
    std::vector<queue::Task> sorted = tasks;
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    for (std::size_t n = 0; n < outcomes->size(); ++n) merge(findings, findings_in(sorted[n], (*outcomes)[n]));
  });
}

std::vector<queue::Task> tasks_of(const VerifiedAtlas& atlas) {
  std::vector<queue::Task> tasks;
  for (const TreeFamily& family : atlas.tree().families) {
    const auto first = static_cast<std::int64_t>(family.first_orbit);
    add_blocks(What::orbits, first, first + static_cast<std::int64_t>(family.orbits()), orbits_a_task, tasks);
  }
  add_blocks(What::crossings, 0, static_cast<std::int64_t>(atlas.archive().crossings().rows()), 1, tasks);
  add_blocks(What::loci, 0, static_cast<std::int64_t>(atlas.archive().loci().rows()), loci_a_task, tasks);
  add_blocks(What::equilibria, 0, static_cast<std::int64_t>(atlas.archive().equilibria().rows()), equilibria_a_task,
             tasks);
  if (!atlas.section().coordinate.empty())
    add_blocks(What::sections, 0, static_cast<std::int64_t>(atlas.archive().orbits().rows()), sections_a_task, tasks);
  return tasks;
}

}  // namespace

Verification verify(const core::Communicator& comm, const std::filesystem::path& atlas, Display display) {
  const auto begin = std::chrono::steady_clock::now();
  Verification out;
  out.ranks = comm.size();
  Findings findings;
  std::optional<archive::Archive> archive;
  std::vector<queue::Task> tasks;
  VerifyExecutor executor(core::agreed(comm.get(), atlas.string()));
  core::on_root(comm.get(), [&] {
    archive.emplace(atlas, archive::ChangedRows::listed);
    out.has_checksums = archive->has_checksums();
    out.families = static_cast<std::int64_t>(archive->families().rows());
    out.orbits = static_cast<std::int64_t>(archive->orbits().rows());
    out.crossings = static_cast<std::int64_t>(archive->crossings().rows());
    out.sections = static_cast<std::int64_t>(archive->sections().rows());
    out.loci = static_cast<std::int64_t>(archive->loci().rows());
    out.equilibria = static_cast<std::int64_t>(archive->equilibria().rows());
    for (const archive::ChangedRow& row : archive->changed_rows())
      findings.objections.push_back(
          {row.table, row.table.empty() ? -1 : static_cast<std::int64_t>(row.row), "", row.text});
    if (out.has_checksums) add_blocks(What::checksums, 0, out.orbits, checksums_a_task, tasks);
  });
  run_tasks(comm, tasks, executor, display, findings);
  out.is_computed = core::agreed(comm.get(), findings.objections.empty());
  if (out.is_computed) {
    tasks.clear();
    core::on_root(comm.get(), [&] {
      const VerifiedAtlas opened(std::move(*archive));
      check_tables(opened, findings);
      tasks = tasks_of(opened);
    });
    run_tasks(comm, tasks, executor, display, findings);
  }
  const auto place = [](const Objection& o) { return std::tie(o.table, o.row, o.column, o.text); };
  std::stable_sort(findings.objections.begin(), findings.objections.end(),
                   [&](const Objection& a, const Objection& b) { return place(a) < place(b); });
  std::sort(findings.margins.begin(), findings.margins.end(),
            [](const Margin& a, const Margin& b) { return a.column < b.column; });
  out.objections = std::move(findings.objections);
  out.margins = std::move(findings.margins);
  out.uninformative = findings.uninformative;
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace orbweaver::survey
