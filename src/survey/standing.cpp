#include "orbweaver/survey/standing.hpp"

#include <fmt/format.h>

#include "orbweaver/archive/reader.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::survey {

namespace {

bool has_end(const archive::Archive& archive, const char* beginning) {
  for (const std::string& reason : archive.families().texts("end_reason"))
    if (reason.starts_with(beginning)) return true;
  return false;
}

}  // namespace

Standing standing_of(const std::filesystem::path& directory, const scene::Scene& scene) {
  const std::filesystem::path atlas = directory / "atlas.h5";
  if (std::filesystem::exists(atlas)) {
    const archive::Archive archive(atlas);
    if (archive.header().scene != scene.text)
      throw core::InputError(
          fmt::format("{} was made from another scene than this one: give another folder with -o, or move the "
                      "archive away",
                      atlas.string()));
    if (has_end(archive, "stopped")) return Standing::unfinished;
    return has_end(archive, "failure") ? Standing::finished_with_failures : Standing::finished;
  }
  return std::filesystem::exists(directory / "segments") ? Standing::unfinished : Standing::none;
}

void require_startable(Standing standing, const std::filesystem::path& directory, bool resume) {
  if (standing == Standing::none || resume) return;
  const bool unfinished = standing == Standing::unfinished;
  throw core::InputError(
      fmt::format("{} already holds {} survey, and nothing was changed: give another folder with -o, or --resume to {}",
                  directory.string(), unfinished ? "an unfinished" : "a finished",
                  unfinished ? "begin it anew (checkpoints are not built yet)" : "accept it as it is"));
}

}  // namespace orbweaver::survey
