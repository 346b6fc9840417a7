#pragma once

#include <filesystem>

#include "orbweaver/scene/scene.hpp"

namespace orbweaver::survey {

/// What a folder holds of a survey.
enum class Standing {
  none,                    ///< nothing: absent, empty, or no survey in it
  unfinished,              ///< segments of a survey that did not reach its archive, or one with families cut by a stop
  finished,                ///< an archive of this very scene
  finished_with_failures,  ///< the same, with a family that failed
};

/// Looks into `directory`. Throws InputError if an archive there is unreadable or of another scene. Not collective.
[[nodiscard]] Standing standing_of(const std::filesystem::path& directory, const scene::Scene& scene);

/// Throws InputError where a survey may not begin: a folder with a survey needs `resume`. An unfinished one is begun
/// anew, since checkpoints are not written yet.
void require_startable(Standing standing, const std::filesystem::path& directory, bool resume);

}  // namespace orbweaver::survey
