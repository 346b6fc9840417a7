#include "orbweaver/survey/standing.hpp"

#include <fmt/format.h>

#include "orbweaver/archive/reader.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::survey {

Standing standing_of(const std::filesystem::path& directory, const scene::Scene& scene) {
  const std::filesystem::path atlas = directory / "atlas.h5";
  if (std::filesystem::exists(atlas)) {
    const archive::Archive archive(atlas);
    if (archive.header().scene != scene.text)
      throw core::InputError(fmt::format("{} was made from another scene than this one: give another folder with -o, or move the "
                                         "archive away", atlas.string()));
    return Standing::finished;
  }
  return std::filesystem::exists(directory / "segments") ? Standing::unfinished : Standing::none;
}

void require_startable(Standing standing, const std::filesystem::path& directory, bool resume) {
  if (standing == Standing::none || resume) return;
  throw core::InputError(fmt::format("{} already holds {} survey of this scene, and nothing was changed: give another folder with -o, "
                                     "or --resume to {}", directory.string(), standing == Standing::finished ? "a finished" : "an unfinished",
                                     standing == Standing::finished ? "accept it as it is" : "begin it anew (checkpoints are not built yet)"));
}

}  // namespace orbweaver::survey
