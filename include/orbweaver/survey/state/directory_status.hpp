#pragma once

#include <filesystem>

#include "orbweaver/scene/scene.hpp"

namespace orbweaver::survey {

/// What a folder holds of a survey.
enum class DirectoryStatus {
  none,                             ///< nothing: absent, empty, or no survey in it
  unfinished,                       ///< a survey that did not come to its end
  finished,                         ///< a survey of this very scene with its archive
  finished_with_failures,           ///< the same, with a family that failed
  finished_within_narrower_limits,  ///< a survey that came to its end, with limits that are wider in the scene
};

/// Looks into `directory`. Throws InputError if what is there is unreadable, of a newer version, or of a scene that
/// differs in more than wider limits. Not collective.
[[nodiscard]] DirectoryStatus status_of(const std::filesystem::path& directory, const scene::Scene& scene);

/// Throws InputError where a survey may not begin: a folder with a survey needs `resume`.
void require_startable(DirectoryStatus status, const std::filesystem::path& directory, bool resume);

}  // namespace orbweaver::survey
