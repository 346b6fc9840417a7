#include "archive_writer.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "certify_orbits.hpp"
#include "orbweaver/archive/file/folder_lock.hpp"
#include "orbweaver/archive/write/consolidate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/core/survey_folder.hpp"
#include "orbweaver/loop/curve/in_units.hpp"
#include "orbweaver/survey/run/scaled_scene.hpp"
#include "orbweaver/systems/registry.hpp"
#include "state/branch_state.hpp"
#include "state/resume.hpp"
#include "tasks/certified.hpp"
#include "tasks/payload/keys.hpp"
#include "tree/equilibria.hpp"
#include "version.hpp"
#include "witness/placement.hpp"
#include "witness/witness.hpp"

namespace orbweaver::survey {

namespace {

/// Branches that a stop has cut: their rows are kept, and so must the families be.
void add_unfinished(const std::vector<queue::Task>& tasks, double unit, FamilyTree& tree) {
  for (const queue::Task& task : tasks) {
    if (kind_of(task) != TaskKind::branch || task.state.empty()) continue;
    BranchState state = unpack_branch_state(task.state);
    state.outcome.end = {continuation::EndReason::stopped, fmt::format("T = {:.9g}", state.last.loop.period * unit)};
    queue::TaskOutcome outcome;
    outcome.key = task.key;
    outcome.payload = pack(state.outcome);
    tree.add(task, outcome);
  }
}

/// What a task was about, by the names of families: one that was not begun has none, but where it is born.
std::string unfinished_text(const queue::Task& task, const std::map<std::string, std::string>& names) {
  std::string key = place_of(task.key);
  const auto name = [&] { return names.find(key.substr(0, key.find_last_not_of("+-") + 1)); };
  const bool is_family = name() != names.end();
  while (name() == names.end() && key.find('/') != std::string::npos) key.erase(key.rfind('/'));
  if (name() == names.end()) return task.key;
  return is_family ? name()->second : fmt::format("what lies on {} or is born there ({})", name()->second, task.key);
}

}  // namespace

archive::Header header_of(const scene::Scene& scene, const systems::System& system) {
  archive::Header header;
  header.orbweaver_version = version();
  header.scene = scene.text;
  header.model = scene.model;
  header.state_names = system.info().state_names;
  header.winding_names = system.winding_names();
  header.winding_coordinates = system.structure().angles;
  header.pairs = system.structure().pairs();
  header.symplectic = system.structure().symplectic;
  header.system = system.info().name;
  header.effects = scene.system.effects;
  for (const auto& [name, value] : system.parameters()) {
    header.parameter_names.push_back(name);
    header.parameter_values.push_back(value);
  }
  const systems::Scales& scales = system.scales();
  header.scale_names = {"time"};
  header.scales = {scales.time};
  for (std::size_t i = 0; i < header.state_names.size(); ++i) {
    header.scale_names.push_back(header.state_names[i]);
    header.scales.push_back(scales.coordinate(i));
  }
  for (std::size_t k = 0; k < system.structure().conserved.size(); ++k) {
    header.scale_names.push_back(system.structure().conserved[k]);
    header.scales.push_back(scales.conserved.empty() ? 1.0 : scales.conserved[k]);
  }
  for (std::size_t n = 0; n < system.family_scalars().free.size(); ++n) {
    header.scale_names.push_back(system.family_scalars().free[n]);
    header.scales.push_back(scales.parameter(n));
  }
  return header;
}

namespace {

/// The tables that segments are consolidated with, of rank 0.
void add_rows_left_out(const Checkpoint& checkpoint, archive::Records& tables) {
  tables.voided = checkpoint.voided;
  tables.earlier_scenes = checkpoint.earlier_scenes;
}

/// Crossings that branches have located beneath their ends are given their families, which an atlas that is not
/// published is looked through for. Only where there are any; collective.
void place_crossings(const core::Communicator& comm, const std::vector<std::filesystem::path>& segments,
                     const archive::Header& header, const std::shared_ptr<const systems::System>& system,
                     const Checkpoint& checkpoint, FamilyTree& tree, const std::filesystem::path& output) {
  archive::Records tables;
  std::vector<FamilyTree::Unplaced> unplaced;
  core::on_root(comm.get(), [&] {
    unplaced = tree.unplaced();
    if (unplaced.empty()) return;
    tables = tree.resolve().tables;
    add_rows_left_out(checkpoint, tables);
  });
  if (core::agreed(comm.get(), unplaced.empty())) return;
  const archive::Witness place = [&](const std::filesystem::path& atlas) {
    core::on_root(comm.get(), [&] {
      std::vector<std::string> keys;
      for (const archive::FamilyRecord& family : tables.families) keys.push_back(family.key);
      std::sort(keys.begin(), keys.end());
      for (const Placement& found : placements(atlas, keys, unplaced, system))
        tree.place(found.branch, found.family, found.side, found.arclength);
    });
    return std::optional<std::vector<archive::FindingRecord>>();
  };
  (void)archive::consolidate(comm.get(), segments, output, header, tables, {}, place);
}

}  // namespace

void write_archive(const core::Communicator& comm, const scene::Scene& scene,
                   const std::shared_ptr<const systems::System>& system, const Checkpoint& checkpoint, FamilyTree& tree,
                   const SweepsEnded& sweeps, Summary& summary) {
  archive::Records tables;
  WitnessInput known;
  std::vector<std::filesystem::path> segments;
  core::on_root(comm.get(), [&] {
    add_unfinished(checkpoint.unfinished, system->scales().time, tree);
    const std::filesystem::path folder = state_folder(summary.atlas.parent_path());
    for (const archive::WrittenSegment& segment : checkpoint.segments) segments.push_back(folder / segment.name);
  });
  const archive::Header header = header_of(scene, *system);
  if (summary.archived) place_crossings(comm, segments, header, system, checkpoint, tree, summary.atlas);
  core::on_root(comm.get(), [&] {
    FamilyTree::Result found = tree.resolve();
    tables = std::move(found.tables);
    summary.families = std::move(found.families);
    summary.parameter = Units(*system).parameter_name;
    known.tree = std::move(found.evidence);
    for (std::string& failure : found.failures) summary.failed_tasks.push_back(std::move(failure));
    for (std::string& remark : found.remarks) summary.remarks.push_back(std::move(remark));
    for (const FamilySummary& family : summary.families) summary.orbits += family.orbits;
    summary.crossings = static_cast<long>(tables.crossings.size());
    const std::size_t told = summary.failed_tasks.size();  // by the tree, from which the witness hears of them
    gather_failed_sweeps(*system, sweeps, summary, tables);
    add_equilibria(*system, sweeps, tables);
    require_families(*system, sweeps, summary);
    known.failures.assign(summary.failed_tasks.begin() + static_cast<std::ptrdiff_t>(told), summary.failed_tasks.end());
    known.stopped_early = summary.stopped_early;
    known.time_unit = system->scales().time;
    for (const queue::Task& task : checkpoint.unfinished)
      known.interrupted.push_back(unfinished_text(task, found.names));
    for (const auto& [key, ended] : sweeps) {
      SweepWork work = unpack_sweep_work(ended.first.payload);
      if (!work.given.empty()) break;  // behind the equilibria
      std::vector<double>& point = known.equilibria.emplace_back(std::move(work.point));
      for (std::size_t i = 0; i < point.size(); ++i) point[i] *= system->scales().coordinate(i);
      std::vector<KernelRecord>& kernels = known.kernels.emplace_back();
      std::vector<Oscillation>& oscillations = known.oscillations.emplace_back();
      if (ended.second.failed) continue;
      const SweepOutcome outcome = unpack_sweep_outcome(ended.second.payload);
      kernels = outcome.kernels;
      for (const FoundMode& mode : outcome.modes)
        oscillations.push_back({mode.place, mode.period * system->scales().time});
      for (const FoundMode& mode : outcome.modes) {
        if (mode.base.modes.empty() || mode.base_is_orbit) continue;
        const loop::Loop hopf = loop::in_units(mode.base, system->scales());
        std::vector<double>& beginning = known.beginnings[base_key(outcome.index, mode.place)];
        beginning.assign(hopf.modes.begin(), hopf.modes.begin() + hopf.dimension);
        beginning.push_back(hopf.parameters.front());
      }
    }
    for (const archive::FamilyRecord& family : tables.families) known.family_keys.push_back(family.key);
    std::sort(known.family_keys.begin(), known.family_keys.end());
    known.crossing_rows = archive::rows_of_crossings(tables);
    add_rows_left_out(checkpoint, tables);
  });
  if (!summary.archived) {
    summary.failures = core::agreed(comm.get(), static_cast<unsigned long>(summary.failed_tasks.size()));
    return;
  }
  // What tasks of their own certify: the orbits of an atlas that is not published. A stopped survey's are not.
  if (!is_certified_by_branches(scene) && certificate_level(scene) != certificate::Level::none &&
      !core::agreed(comm.get(), summary.stopped_early)) {
    bool stopped = false;
    const archive::Witness certify = [&](const std::filesystem::path& atlas) {
      auto certificates = certificates_of(comm, atlas);
      stopped = !certificates;
      if (certificates) tables.certificates = std::move(*certificates);
      return std::optional<std::vector<archive::FindingRecord>>();
    };
    (void)archive::consolidate(comm.get(), segments, summary.atlas, header, tables, {}, certify);
    if (stopped) {
      summary.archived = false;
      summary.stopped_early = true;
      return;
    }
  }
  const archive::Witness witness = [&](const std::filesystem::path& atlas) {
    auto testimony = testify(comm, atlas, scene, system, std::move(known));
    std::optional<std::vector<archive::FindingRecord>> records;
    if (!testimony) return records;
    summary.failures = testimony->wrong;
    summary.findings = std::move(testimony->summaries);
    for (FamilySummary& family : summary.families)
      if (const auto doubts = testimony->doubts.find(family.key); doubts != testimony->doubts.end())
        family.doubts = doubts->second;
    records = std::move(testimony->records);
    return records;
  };
  summary.archived = archive::consolidate(comm.get(), segments, summary.atlas, header, tables, {}, witness);
  summary.stopped_early |= !summary.archived;
}

Summary archive_survey(const core::Communicator& comm, const std::filesystem::path& directory) {
  archive::FolderLock lock;
  core::on_root(comm.get(), [&] {
    if (std::filesystem::exists(state_folder(directory))) lock = archive::FolderLock(state_folder(directory));
  });
  Found found = find_checkpoint(comm, state_folder(directory));
  if (!found.found) throw core::InputError(fmt::format("{} holds no survey with a checkpoint", directory.string()));
  found.checkpoint.scene = core::agreed(comm.get(), std::move(found.checkpoint.scene));
  found.checkpoint.model = core::agreed(comm.get(), std::move(found.checkpoint.model));
  const scene::Scene scene = scene_of(found.checkpoint);
  const ScaledScene scaled(scene, scene::bound_system(scene.system));
  const auto& system = scaled.system();
  core::on_root(comm.get(), [&] { scaled.expect(found.checkpoint.scales); });
  FamilyTree tree(scaled.scene(), system->structure(), Units(*system));
  SweepsEnded sweeps;
  core::on_root(comm.get(), [&] {
    const Stage stage = found.checkpoint.stage;
    continue_with(scene, state_folder(directory), found.checkpoint, [&](const EndedTask& entry) {
      if (kind_of(entry.task) == TaskKind::sweep)
        sweeps.insert_or_assign(entry.task.key, std::pair(entry.task, entry.outcome));
      else
        tree.add(entry.task, entry.outcome);
    });
    found.checkpoint.stage = stage;
  });
  Summary summary;
  summary.atlas = core::atlas_in(directory);
  summary.stopped_early = core::agreed(comm.get(), found.checkpoint.stage != Stage::finished);
  summary.archived = true;
  write_archive(comm, scene, system, found.checkpoint, tree, sweeps, summary);
  return summary;
}

}  // namespace orbweaver::survey
