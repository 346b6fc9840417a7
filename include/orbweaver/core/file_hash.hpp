#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace orbweaver::core {

/// SHA-1 of the contents of files, one after the other: 40 hexadecimal digits. Throws InputError for one that cannot be
/// read.
[[nodiscard]] std::string file_hash(const std::vector<std::filesystem::path>& files);

/// The same of a text.
[[nodiscard]] std::string text_hash(std::string_view text);

}  // namespace orbweaver::core
