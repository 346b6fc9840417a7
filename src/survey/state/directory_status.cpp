#include "orbweaver/survey/state/directory_status.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "checkpoint.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/survey_folder.hpp"
#include "orbweaver/scene/differences.hpp"
#include "orbweaver/survey/tree/family_end.hpp"
#include "resume.hpp"

namespace orbweaver::survey {

namespace {

bool has_end(const archive::Archive& archive, EndKind kind) {
  const std::vector<std::string>& reasons = archive.families().texts("end_reason");
  return std::any_of(reasons.begin(), reasons.end(), [kind](const std::string& reason) {
    const std::vector<EndKind> ends = ends_in(reason);
    return std::find(ends.begin(), ends.end(), kind) != ends.end();
  });
}

std::optional<Checkpoint> newest_readable(const std::filesystem::path& folder) {
  for (const std::filesystem::path& path : {checkpoint_path(folder), previous_checkpoint_path(folder)}) try {
      return read_checkpoint(path);
    } catch (const core::NewerVersionError&) {
      throw;
    } catch (const core::InputError&) {
      // The resume says what is wrong with it.
    }
  return std::nullopt;
}

/// Whether a survey has begun to write there.
bool holds_files(const std::filesystem::path& folder) {
  std::error_code absent;
  for (const auto& entry : std::filesystem::directory_iterator(folder, absent))
    if (const std::string name = entry.path().filename().string();
        name.starts_with("segment-") || name.starts_with("checkpoint"))
      return true;
  return false;
}

/// Throws InputError unless every row and loop of the archive is as it was written.
void require_whole(const std::filesystem::path& atlas) {
  try {
    const archive::Archive archive(atlas);
    for (std::size_t orbit = 0; orbit < archive.orbits().rows(); ++orbit) {
      (void)archive.modes(orbit);
      (void)archive.time_map(orbit);
    }
  } catch (const core::InputError& error) {
    throw core::InputError(fmt::format(
        "{} The survey has finished: once this archive is moved away, --resume makes it again from its segments.",
        error.what()));
  }
}

DirectoryStatus status_of(const Checkpoint& checkpoint, const std::filesystem::path& directory,
                          const scene::Scene& scene) {
  const scene::Scene before = scene_of(checkpoint);
  const std::string differing = refusal(before, scene);
  if (!differing.empty())
    throw core::InputError(
        fmt::format("{} holds a survey of another scene: {}. Nothing was changed: give another folder with -o, or the "
                    "scene that it was begun with",
                    directory.string(), differing));
  const auto differences = scene::differences(before, scene);
  const bool widened = std::any_of(differences.begin(), differences.end(), [](const scene::Difference& difference) {
    return difference.change == scene::Change::widened;
  });
  if (checkpoint.stage != Stage::finished || !std::filesystem::exists(core::atlas_in(directory)))
    return DirectoryStatus::unfinished;
  if (widened) return DirectoryStatus::finished_within_narrower_limits;
  require_whole(core::atlas_in(directory));
  return checkpoint.failures > 0 ? DirectoryStatus::finished_with_failures : DirectoryStatus::finished;
}

}  // namespace

DirectoryStatus status_of(const std::filesystem::path& directory, const scene::Scene& scene) {
  const std::filesystem::path folder = state_folder(directory);
  if (const auto checkpoint = newest_readable(folder)) return status_of(*checkpoint, directory, scene);
  const std::filesystem::path atlas = core::atlas_in(directory);
  if (!std::filesystem::exists(atlas)) return holds_files(folder) ? DirectoryStatus::unfinished : DirectoryStatus::none;
  const archive::Archive archive(atlas);
  if (archive.header().scene != scene.text || archive.header().model != scene.model)
    throw core::InputError(
        fmt::format("{} was made from another scene than this one: give another folder with -o, or move the "
                    "archive away",
                    atlas.string()));
  if (has_end(archive, EndKind::stopped)) return DirectoryStatus::unfinished;
  return has_end(archive, EndKind::failure) ? DirectoryStatus::finished_with_failures : DirectoryStatus::finished;
}

void require_startable(DirectoryStatus status, const std::filesystem::path& directory, bool resume) {
  if (status == DirectoryStatus::none || resume) return;
  std::string_view what = "a finished survey";
  std::string_view advice = "accept it as it is";
  if (status == DirectoryStatus::unfinished) {
    what = "an unfinished survey";
    advice = "go on with it";
  } else if (status == DirectoryStatus::finished_within_narrower_limits) {
    what = "a finished survey with narrower limits";
    advice = "go on with it to the wider ones";
  }
  throw core::InputError(
      fmt::format("{} already holds {}, and nothing was changed: give another folder with -o, or --resume to {}",
                  directory.string(), what, advice));
}

}  // namespace orbweaver::survey
