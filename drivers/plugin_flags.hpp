#pragma once

#include <string>
#include <vector>

namespace orbweaver::drivers {

/// How the program was compiled, which plugins must be too.
extern const std::string plugin_compiler;
extern const std::vector<std::string> plugin_machine_flags;
extern const std::vector<std::string> plugin_packages;
/// Headers and models, where the program runs from its build folder.
extern const std::string plugin_headers;
extern const std::string plugin_models;
/// The same below the prefix of an installed program.
extern const std::string plugin_installed_headers;
extern const std::string plugin_installed_models;
extern const std::string plugin_build_folder;

}  // namespace orbweaver::drivers
