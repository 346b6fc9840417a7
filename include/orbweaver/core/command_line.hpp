#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orbweaver::core {

/// As a shell wants it, which would take brackets and blanks for its own.
[[nodiscard]] std::string shell_word(const std::string& text);

/// A whole command to copy: "orbweaver sweep 'my scene.yaml'".
[[nodiscard]] std::string command_line(const std::vector<std::string>& words);

/// The same of a command that takes --plugin, which it has for each plugin that this process has loaded.
[[nodiscard]] std::string archive_command_line(const std::vector<std::string>& words);

/// Whether there is one.
[[nodiscard]] bool names_plugins_in_commands();

/// Says that a plugin has been loaded.
void name_plugin_in_commands(const std::filesystem::path& file);

}  // namespace orbweaver::core
