#pragma once

#include <filesystem>
#include <functional>
#include <ostream>

namespace orbweaver::drivers {

/// Writes PATH.part and renames it: an older PATH stays until the new one is whole. Throws EnvironmentError where that
/// cannot be done; what `write` throws passes through, and nothing is left.
void write_output_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// Gives a whole file its name. Throws EnvironmentError.
void publish_file(const std::filesystem::path& part, const std::filesystem::path& path);

/// The name of a file until it is whole.
[[nodiscard]] std::filesystem::path part_of(std::filesystem::path path);

}  // namespace orbweaver::drivers
