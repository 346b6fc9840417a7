#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orbweaver::core {

/// SHA-1 of the contents of files, one after the other: 40 hexadecimal digits. Throws InputError for one that cannot be
/// read.
[[nodiscard]] std::string file_hash(const std::vector<std::filesystem::path>& files);

}  // namespace orbweaver::core
