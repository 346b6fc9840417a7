#pragma once

#include <string>

namespace orbweaver::drivers {

// What CMake knew when the program was built.

/// The folder of shipped scenes (shipped_scenes.cpp), and the same below the prefix of an installed program.
extern const std::string source_scenes;
extern const std::string installed_scenes;
extern const std::string build_folder;

}  // namespace orbweaver::drivers
