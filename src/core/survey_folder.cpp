#include "orbweaver/core/survey_folder.hpp"

#include <fmt/format.h>

#include "orbweaver/core/command_line.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::core {

std::filesystem::path atlas_in(const std::filesystem::path& directory) { return directory / "atlas.h5"; }

std::filesystem::path segments_in(const std::filesystem::path& directory) { return directory / "segments"; }

std::filesystem::path atlas_named(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return path;
  if (std::filesystem::exists(std::filesystem::symlink_status(atlas_in(path), ignored))) return atlas_in(path);
  if (std::filesystem::is_directory(segments_in(path), ignored))
    throw InputError(fmt::format(
        "'{}' is the folder of a survey that has not come to its end, and has no atlas.h5 yet. Go on with it by "
        "`orbweaver survey SCENE -o {} --resume`, with the scene and settings that it was begun with, or make an "
        "archive of what it has found by `{}`.",
        path.string(), shell_word(path.string()), command_line({"consolidate", path.string()})));
  return path;
}

}  // namespace orbweaver::core
