#pragma once

#include <filesystem>

namespace orbweaver::drivers {

/// Where what belongs to the program lies: in its source tree as long as it runs from the build folder, else below its
/// prefix.
struct InstalledFiles {
  std::filesystem::path headers;
  std::filesystem::path models;
  std::filesystem::path scenes;
};
[[nodiscard]] InstalledFiles installed_files();

}  // namespace orbweaver::drivers
