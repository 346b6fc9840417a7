#pragma once

#include <string>
#include <vector>

namespace orbweaver::core {

/// As a shell wants it, which would take brackets and blanks for its own.
[[nodiscard]] std::string shell_word(const std::string& text);

/// A whole command to copy: "orbweaver sweep 'my scene.yaml'".
[[nodiscard]] std::string command_line(const std::vector<std::string>& words);

}  // namespace orbweaver::core
