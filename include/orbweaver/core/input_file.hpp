#pragma once

#include <filesystem>
#include <string>

namespace orbweaver::core {

/// What lies at a path where a file to be read was expected, in words that go on after "got" (`none`, `a folder`, `a
/// pipe`, `a link in a circle`, `one that may not be read`); empty: a file that can be read. Opens nothing, as to open
/// a pipe may wait.
[[nodiscard]] std::string unreadable_input(const std::filesystem::path& path);

/// The same in words that go on after the path: `does not exist`, `is a folder`.
[[nodiscard]] std::string input_problem(const std::filesystem::path& path);

}  // namespace orbweaver::core
