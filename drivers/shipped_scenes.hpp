#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace orbweaver::drivers {

/// A scene that comes with the program.
struct ShippedScene {
  std::filesystem::path file;
  std::string system;
  std::string title;  ///< the first sentence of the comment that it begins with
};

/// In the order of their names; none where their folder is missing. Files that this program cannot read are left out.
[[nodiscard]] std::vector<ShippedScene> shipped_scenes();

}  // namespace orbweaver::drivers
