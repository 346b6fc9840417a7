#include "resume.hpp"

#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/archive/read/check_segments.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/scene/differences.hpp"
#include "reopen.hpp"

namespace orbweaver::survey {

namespace {

// Rank 0: the checkpoint in `path`, with its journals looked into; else why not.
std::optional<Checkpoint> readable(const std::filesystem::path& folder, const std::filesystem::path& path,
                                   std::vector<std::string>& problems) {
  try {
    Checkpoint checkpoint = read_checkpoint(path);
    for (const JournalFile& journal : checkpoint.journals) (void)read_journal(folder, journal);
    return checkpoint;
  } catch (const core::NewerVersionError&) {
    throw;  // nothing is wrong with it: whoever fell back would destroy it
  } catch (const core::InputError& error) {
    problems.emplace_back(error.what());
    return std::nullopt;
  }
}

}  // namespace

void remove_unlisted(const std::filesystem::path& folder, const Checkpoint& checkpoint) {
  std::set<std::string> listed;
  const auto list = [&](const Checkpoint& by) {
    for (const archive::WrittenSegment& segment : by.segments) listed.insert(segment.name);
    for (const JournalFile& journal : by.journals) listed.insert(journal.name);
  };
  list(checkpoint);
  try {
    list(read_checkpoint(previous_checkpoint_path(folder)));
  } catch (const core::InputError&) {
    // There is none to fall back to.
  }
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if ((name.starts_with("segment-") || name.starts_with("journal-")) && !listed.contains(name))
      std::filesystem::remove(entry.path(), ignored);
  }
}

Found find_checkpoint(const core::Communicator& comm, const std::filesystem::path& folder) {
  std::vector<std::string> problems;
  bool any = false;
  for (const std::filesystem::path& path : {checkpoint_path(folder), previous_checkpoint_path(folder)}) {
    std::optional<Checkpoint> candidate;
    bool there = false;
    core::on_root(comm.get(), [&] {
      there = std::filesystem::exists(path);
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
                  "from a copy, or "
                  "begin the survey anew in another folder",
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

void continue_with(const scene::Scene& scene, const std::filesystem::path& folder, Checkpoint& checkpoint,
                   const std::function<void(const EndedTask&)>& take) {
  const scene::Scene before = scene::parse(checkpoint.scene, "the checkpoint's scene");
  const std::string differing = refusal(before, scene);
  if (!differing.empty())
    throw core::InputError(
        fmt::format("{} holds a survey of another scene: {}. Give another folder with -o, or the scene "
                    "that it was begun with",
                    folder.parent_path().string(), differing));
  Reopening reopening(widened_limits(before, scene), checkpoint);
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
  checkpoint.stage = std::min(checkpoint.stage, Stage::families);
}

}  // namespace orbweaver::survey
