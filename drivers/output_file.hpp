#pragma once

#include <filesystem>
#include <functional>
#include <ostream>

namespace orbweaver::drivers {

/// Writes PATH.part and renames it: an older PATH stays until the new one is whole. A device or a pipe (/dev/stdout) is
/// written into as it is. Throws InputError where PATH is a folder, EnvironmentError where it cannot be written; what
/// `write` throws passes through. Nothing is left of what was not finished.
void write_output_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// What write_output_file would refuse, before any work is done for it. Where the file is `input` too, an atlas or the
/// folder that has it, which it would take the place of: InputError.
void require_output_file(const std::filesystem::path& path, const std::filesystem::path& input);

}  // namespace orbweaver::drivers
