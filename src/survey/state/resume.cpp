#include "resume.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "branch_state.hpp"
#include "orbweaver/archive/read/check_segments.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/core/pause.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/scene/differences.hpp"
#include "payload_store.hpp"
#include "reopen.hpp"
#include "tasks/payload/work.hpp"

namespace orbweaver::survey {

namespace {

// Throws as expect_readable unless the state before the limit that a branch has met can be.
void expect_state(const std::filesystem::path& folder, const BranchOutcome& outcome) {
  if (const std::string state = whole_payload(folder, outcome.before_limit); !state.empty())
    (void)unpack_branch_state(state);
}

// Throws EnvironmentError unless all that a task carries can be unpacked, InputError if its payload is not in the
// folder.
void expect_readable(const std::filesystem::path& folder, const queue::Task& task) {
  const TaskKind kind = kind_of(task);
  if (const std::string payload = whole_payload(folder, task.payload); !payload.empty()) switch (kind) {
      case TaskKind::sweep: (void)unpack_sweep_work(payload); break;
      case TaskKind::branch: (void)unpack_branch_work(payload); break;
      case TaskKind::locate: (void)unpack_locate_work(payload); break;
      case TaskKind::start: (void)unpack_start_work(payload); break;
      case TaskKind::locus: (void)unpack_locus_work(payload); break;
    }
  if (is_stored(task.payload) && (kind == TaskKind::branch || kind == TaskKind::start)) (void)told_branch(task);
  if (kind != TaskKind::branch || task.state.empty()) return;
  const BranchState state = unpack_branch_state(task.state);
  for (const queue::Task& child : state.children) expect_readable(folder, child);
  expect_state(folder, state.outcome);
}

void expect_readable(const std::filesystem::path& folder, const EndedTask& entry) {
  expect_readable(folder, entry.task);
  const std::string& outcome = entry.outcome.payload;
  if (outcome.empty()) return;
  switch (kind_of(entry.task)) {
    case TaskKind::sweep: (void)unpack_sweep_outcome(outcome); break;
    case TaskKind::locate: (void)unpack_locate_outcome(outcome); break;
    case TaskKind::start: (void)unpack_start_outcome(outcome); break;
    case TaskKind::locus: (void)unpack_locus_outcome(outcome); break;
    case TaskKind::branch: expect_state(folder, unpack_branch_outcome(outcome)); break;
  }
}

// Files are found, counted on and removed by these names.
void expect_name(const std::filesystem::path& path, const std::string& name, std::string_view before,
                 std::string_view behind) {
  constexpr std::size_t most_digits = 9;
  const bool framed = name.starts_with(before) && name.ends_with(behind) && name.size() > before.size() + behind.size();
  const std::string digits =
      framed ? name.substr(before.size(), name.size() - before.size() - behind.size()) : std::string();
  if (digits.empty() || digits.size() > most_digits || digits.find_first_not_of("0123456789") != std::string::npos)
    throw core::InputError(fmt::format("{}: it lists a file `{}`, where {}NNNNNN{} was expected", path.string(),
                                       core::printable(name), before, behind));
}

template <class Items>
void expect_all_readable(const std::filesystem::path& folder, const std::filesystem::path& path, const Items& items) {
  try {
    for (const auto& item : items) expect_readable(folder, item);
  } catch (const core::EnvironmentError& error) {
    throw core::InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

// Rank 0: the checkpoint in `path`, with its journals, everything unpacked; else why not.
std::optional<Checkpoint> readable(const std::filesystem::path& folder, const std::filesystem::path& path,
                                   std::vector<std::string>& problems) {
  try {
    Checkpoint checkpoint = read_checkpoint(path);
    for (const archive::WrittenSegment& segment : checkpoint.segments)
      expect_name(path, segment.name, "segment-", ".h5");
    for (const JournalFile& journal : checkpoint.journals) expect_name(path, journal.name, "journal-", "");
    expect_all_readable(folder, path, checkpoint.unfinished);
    expect_all_readable(folder, path, checkpoint.left_out);
    for (const JournalFile& journal : checkpoint.journals)
      expect_all_readable(folder, folder / journal.name, read_journal(folder, journal));
    return checkpoint;
  } catch (const core::NewerVersionError&) {
    throw;  // nothing is wrong with it: whoever fell back would destroy it
  } catch (const core::InputError& error) {
    problems.emplace_back(error.what());
  } catch (const std::exception& error) {
    problems.push_back(fmt::format("{}: it cannot be read: {}", path.string(), error.what()));
  }
  return std::nullopt;
}

// What stands in the way of a checkpoint and is none, a folder, is kept under another name.
void clear_the_way(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(std::filesystem::symlink_status(path))) return;
  const std::filesystem::path aside = path.string() + ".folder";
  std::error_code error;
  std::filesystem::rename(path, aside, error);
  if (error)
    throw core::EnvironmentError(
        fmt::format("{} is a folder, where a checkpoint should be, and cannot be renamed to {}: "
                    "{}; move it away",
                    path.string(), aside.string(), error.message()));
  core::log_warning(fmt::format("{} was a folder; it is now {}", path.string(), aside.string()));
}

void list_payload(const std::string& payload, std::set<std::string>& listed) {
  if (is_stored(payload)) listed.insert(payload_file(unpack_stored_work(payload).file));
}

// Files in which payloads of these tasks lie, those of running branches' states included.
void list_payloads(const std::vector<queue::Task>& tasks, std::set<std::string>& listed) {
  for (const queue::Task& task : tasks) {
    list_payload(task.payload, listed);
    if (kind_of(task) != TaskKind::branch || task.state.empty()) continue;
    const BranchState state = unpack_branch_state(task.state);
    list_payloads(state.children, listed);
    list_payload(state.outcome.before_limit, listed);
  }
}

// All files that a checkpoint counts on.
void list_files(const std::filesystem::path& folder, const Checkpoint& checkpoint, std::set<std::string>& listed) {
  for (const archive::WrittenSegment& segment : checkpoint.segments) listed.insert(segment.name);
  list_payloads(checkpoint.unfinished, listed);
  list_payloads(checkpoint.left_out, listed);
  for (const JournalFile& journal : checkpoint.journals) {
    if (!listed.insert(journal.name).second) continue;  // another checkpoint's too
    for (const EndedTask& entry : read_journal(folder, journal)) {
      list_payloads({entry.task}, listed);
      if (kind_of(entry.task) == TaskKind::branch && !entry.outcome.payload.empty())
        list_payload(unpack_branch_outcome(entry.outcome.payload).before_limit, listed);
    }
  }
}

/// `visit` of each payload or state of an ended task that wider limits may ask for; what they never do is dropped.
template <class Visit>
void for_needed(EndedTask& entry, const Visit& visit) {
  std::string& payload = entry.task.payload;
  const TaskKind kind = kind_of(entry.task);
  if (limits_of(entry) != 0) {
    visit(payload);
  } else if (is_stored(payload)) {  // of branches and starts the tree of families reads what rank 0 is told
    const bool branch = kind == TaskKind::branch;
    const std::string told = branch || kind == TaskKind::start ? pack(told_branch(entry.task)) : std::string();
    payload = kind == TaskKind::start ? pack(StartWork{unpack_branch_work(told)}) : told;
  }
  if (kind != TaskKind::branch || entry.outcome.payload.empty()) return;
  BranchOutcome outcome = unpack_branch_outcome(entry.outcome.payload);
  if (outcome.before_limit.empty()) return;
  visit(outcome.before_limit);
  entry.outcome.payload = pack(outcome);
}

std::uint64_t bytes_in_payload_files(const std::filesystem::path& folder) {
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().filename().string().starts_with(payload_prefix) && entry.is_regular_file())
      bytes += entry.file_size();
  return bytes;
}

void move_needed_payloads(const std::filesystem::path& folder, Checkpoint checkpoint) {
  std::uint64_t needed = 0;
  const auto add = [&](const std::string& payload) {
    if (is_stored(payload)) needed += unpack_stored_work(payload).bytes;
  };
  for (const JournalFile& journal : checkpoint.journals)
    for (EndedTask& entry : read_journal(folder, journal)) for_needed(entry, add);
  for (const queue::Task& task : checkpoint.left_out) add(task.payload);
  if (needed == bytes_in_payload_files(folder)) return;

  const core::Communicator alone(MPI_COMM_SELF);
  PayloadStore store(folder);
  store.open(alone);
  const auto move = [&](std::string& payload) {
    if (!is_stored(payload)) return;
    const std::string told = unpack_stored_work(payload).told;
    payload = whole_payload(folder, payload);
    store.keep(payload, told);
    if (!is_stored(payload)) throw core::EnvironmentError("a payload cannot be moved");
  };
  std::size_t number = next_journal(checkpoint);
  for (JournalFile& journal : checkpoint.journals) {
    std::vector<EndedTask> entries = read_journal(folder, journal);
    for (EndedTask& entry : entries) for_needed(entry, move);
    journal = write_journal(folder, number++, entries);
  }
  for (queue::Task& task : checkpoint.left_out) move(task.payload);
  store.sync();
  core::pause_point("count on moved payloads");
  write_checkpoint(folder, checkpoint);
  core::pause_point("count on moved payloads alone");
  write_checkpoint(folder, checkpoint);  // the one before counts on nothing else either
  core::pause_point("remove payloads");
  remove_unlisted(folder, checkpoint);
}

}  // namespace

void keep_needed_payloads(const std::filesystem::path& folder, const Checkpoint& checkpoint) {
  if (!checkpoint.unfinished.empty()) return;
  try {
    move_needed_payloads(folder, checkpoint);
  } catch (const core::EnvironmentError& error) {
    core::log_warning(fmt::format("the files of payloads stay as they are: {}", error.what()));
  } catch (const core::InputError& error) {
    core::log_warning(fmt::format("the files of payloads stay as they are: {}", error.what()));
  }
}

bool is_listed_kind(const std::string& name) {
  return name.starts_with("segment-") || name.starts_with("journal-") || name.starts_with(payload_prefix);
}

void remove_unlisted(const std::filesystem::path& folder, const Checkpoint& checkpoint) {
  std::set<std::string> listed;
  list_files(folder, checkpoint, listed);
  try {
    list_files(folder, read_checkpoint(previous_checkpoint_path(folder)), listed);
  } catch (const core::NewerVersionError&) {
    throw;  // what it lists is not this Orbweaver's to remove
  } catch (const core::InputError&) {
    // There is none to fall back to.
  } catch (const core::EnvironmentError&) {
    // The same: what lies in it is another build's.
  }
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (is_listed_kind(name) && !listed.contains(name)) std::filesystem::remove(entry.path(), ignored);
  }
}

Found find_checkpoint(const core::Communicator& comm, const std::filesystem::path& folder) {
  std::vector<std::string> problems;
  bool any = false;
  for (const std::filesystem::path& path : {checkpoint_path(folder), previous_checkpoint_path(folder)}) {
    std::optional<Checkpoint> candidate;
    bool there = false;
    core::on_root(comm.get(), [&] {
      std::error_code ignored;  // one that cannot be looked at is there
      there = std::filesystem::symlink_status(path, ignored).type() != std::filesystem::file_type::not_found;
      if (there) candidate = readable(folder, path, problems);
    });
    any |= core::agreed(comm.get(), there);
    if (!core::agreed(comm.get(), candidate.has_value())) continue;
    std::vector<std::string> scenes;
    if (candidate) {
      scenes = candidate->earlier_scenes;
      scenes.push_back(candidate->scene);
    }
    const auto faults = archive::check_segments(
        comm.get(), folder, candidate ? candidate->segments : std::vector<archive::WrittenSegment>{}, scenes);
    if (!faults.empty()) {
      problems.insert(problems.end(), faults.begin(), faults.end());
      continue;
    }
    Found found{true, candidate ? std::move(*candidate) : Checkpoint{}};
    core::on_root(comm.get(), [&] {
      for (const std::string& problem : problems) core::log_warning(problem);
      for (const std::filesystem::path& place : {checkpoint_path(folder), previous_checkpoint_path(folder)})
        clear_the_way(place);
      if (path != checkpoint_path(folder)) {
        core::log_warning("going on from the checkpoint before the last one");
        std::filesystem::rename(path, checkpoint_path(folder));
      }
      remove_unlisted(folder, found.checkpoint);
    });
    return found;
  }
  if (!any) return {};
  const std::string why = core::agreed(comm.get(), fmt::format("{}", fmt::join(problems, "\n  ")));
  throw core::InputError(
      fmt::format("the survey in {} cannot go on; nothing was changed:\n  {}\nbring the missing or damaged files back "
                  "from a copy, or begin the survey anew in another folder; the orbits in segments that are whole can "
                  "still be read with HDF5 (docs/file_format.md)",
                  folder.parent_path().string(), why));
}

std::string refusal(const scene::Scene& before, const scene::Scene& now) {
  std::string text;
  for (const scene::Difference& difference : scene::differences(before, now)) {
    const bool narrowed = difference.change == scene::Change::narrowed;
    if (!narrowed && difference.change != scene::Change::other) continue;
    text += fmt::format("{}{} was {} and is {}{}", text.empty() ? "" : "; ", difference.key,
                        difference.before.empty() ? "absent" : difference.before,
                        difference.now.empty() ? "absent" : difference.now,
                        narrowed ? " (a limit can only be made wider)" : "");
  }
  return text;
}

bool begins_again(const scene::Scene& scene, const systems::Scales& scales, const std::filesystem::path& folder,
                  const Checkpoint& checkpoint) {
  const scene::Scene before = scene_of(checkpoint);
  if (!refusal(before, scene).empty() || (widened_limits(before, scene) & parameter_limited) == 0) return false;
  systems::Scales measured = checkpoint.scales;
  measured.parameters = scales.parameters;
  if (!(measured == scales)) return false;  // which is refused
  if (!(checkpoint.scales == scales)) return true;
  // A family from a rest at a limit had one side only.
  const auto has_another_side = [&](const FoundMode& mode) {
    if (!mode.base_is_orbit || !mode.one_direction) return false;
    const double here = mode.base.parameters.back() * scales.parameter(0);
    return (here <= before.limits.parameter_from) != (here <= scene.limits.parameter_from) ||
           (here >= before.limits.parameter_to) != (here >= scene.limits.parameter_to);
  };
  const auto starts_otherwise = [&](const EndedTask& entry) {
    if (kind_of(entry.task) != TaskKind::sweep || entry.outcome.payload.empty()) return false;
    const SweepOutcome sweep = unpack_sweep_outcome(entry.outcome.payload);
    return sweep.equilibria.size() > 1 || std::any_of(sweep.modes.begin(), sweep.modes.end(), has_another_side);
  };
  return std::any_of(checkpoint.journals.begin(), checkpoint.journals.end(), [&](const JournalFile& journal) {
    const std::vector<EndedTask> entries = read_journal(folder, journal);
    return std::any_of(entries.begin(), entries.end(), starts_otherwise);
  });
}

void continue_with(const scene::Scene& scene, const std::filesystem::path& folder, Checkpoint& checkpoint,
                   const std::function<void(const EndedTask&)>& take) {
  const scene::Scene before = scene_of(checkpoint);
  const std::string differing = refusal(before, scene);
  if (!differing.empty())
    throw core::InputError(
        fmt::format("{} holds a survey of another scene: {}. Give another folder with -o, or the scene "
                    "that it was begun with",
                    folder.parent_path().string(), differing));
  Reopening reopening(widened_limits(before, scene), checkpoint, folder);
  for (JournalFile& journal : checkpoint.journals) {
    std::vector<EndedTask> entries = read_journal(folder, journal);
    const std::size_t listed = entries.size();
    std::erase_if(entries, [&](const EndedTask& entry) { return !reopening.stays(entry); });
    for (const EndedTask& entry : entries) take(entry);
    if (entries.size() == listed) continue;
    const std::size_t number = next_journal(checkpoint);
    journal = write_journal(folder, number, entries);
  }
  reopening.finish();
  if (scene.text != checkpoint.scene) {
    checkpoint.earlier_scenes.push_back(std::exchange(checkpoint.scene, scene.text));
  }
  checkpoint.model = scene.model;
  checkpoint.stage = std::min(checkpoint.stage, Stage::families);
}

}  // namespace orbweaver::survey
