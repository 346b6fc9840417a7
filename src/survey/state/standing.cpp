#include "orbweaver/survey/state/standing.hpp"

#include <algorithm>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "checkpoint.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/core/error.hpp"
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

Standing standing_of(const Checkpoint& checkpoint, const std::filesystem::path& directory, const scene::Scene& scene) {
  const scene::Scene before = scene::parse(checkpoint.scene, "the checkpoint's scene");
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
  if (checkpoint.stage != Stage::finished || widened || !std::filesystem::exists(directory / "atlas.h5"))
    return Standing::unfinished;
  return checkpoint.failures > 0 ? Standing::finished_with_failures : Standing::finished;
}

}  // namespace

Standing standing_of(const std::filesystem::path& directory, const scene::Scene& scene) {
  const std::filesystem::path folder = state_folder(directory);
  if (const auto checkpoint = newest_readable(folder)) return standing_of(*checkpoint, directory, scene);
  const std::filesystem::path atlas = directory / "atlas.h5";
  if (!std::filesystem::exists(atlas)) return holds_files(folder) ? Standing::unfinished : Standing::none;
  const archive::Archive archive(atlas);
  if (archive.header().scene != scene.text)
    throw core::InputError(
        fmt::format("{} was made from another scene than this one: give another folder with -o, or move the "
                    "archive away",
                    atlas.string()));
  if (has_end(archive, EndKind::stopped)) return Standing::unfinished;
  return has_end(archive, EndKind::failure) ? Standing::finished_with_failures : Standing::finished;
}

void require_startable(Standing standing, const std::filesystem::path& directory, bool resume) {
  if (standing == Standing::none || resume) return;
  const bool unfinished = standing == Standing::unfinished;
  throw core::InputError(
      fmt::format("{} already holds {} survey, and nothing was changed: give another folder with -o, or --resume to {}",
                  directory.string(), unfinished ? "an unfinished" : "a finished",
                  unfinished ? "go on with it" : "accept it as it is"));
}

}  // namespace orbweaver::survey
