#pragma once

#include <string>
#include <vector>

namespace orbweaver::drivers {

// What CMake knew when the program was built.

/// How the program was compiled, which plugins must be too.
extern const std::string plugin_compiler;
extern const std::vector<std::string> plugin_machine_flags;
extern const std::vector<std::string> plugin_packages;
/// Headers, models and scenes, where the program runs from its build folder (installed_files.hpp).
extern const std::string source_headers;
extern const std::string source_models;
extern const std::string source_scenes;
/// The same below the prefix of an installed program.
extern const std::string installed_headers;
extern const std::string installed_models;
extern const std::string installed_scenes;
extern const std::string build_folder;

}  // namespace orbweaver::drivers
