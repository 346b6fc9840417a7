#pragma once

#include <filesystem>

namespace orbweaver::core {

/// What a survey leaves in its folder: the archive, and beside it what it needs to go on.
[[nodiscard]] std::filesystem::path atlas_in(const std::filesystem::path& directory);
[[nodiscard]] std::filesystem::path segments_in(const std::filesystem::path& directory);

/// The file that a user means by `path`: the atlas in it where it is the folder of a survey, else the path itself.
/// Throws InputError where a survey has begun in the folder and left no atlas yet.
[[nodiscard]] std::filesystem::path atlas_named(const std::filesystem::path& path);

}  // namespace orbweaver::core
