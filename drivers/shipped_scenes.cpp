#include "shipped_scenes.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>

#include "build_settings.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/scene/scene.hpp"

namespace orbweaver::drivers {

namespace {

namespace fs = std::filesystem;

/// In the source tree as long as the program runs from its build folder, else below its prefix.
fs::path folder_of_scenes() {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  if (program.string().starts_with(build_folder + "/")) return source_scenes;
  return program.parent_path().parent_path() / installed_scenes;
}

std::string title_of(const fs::path& file) {
  std::ifstream in(file);
  std::string text;
  for (std::string line; std::getline(in, line) && line.starts_with("# ");)
    text += (text.empty() ? "" : " ") + line.substr(2);
  return text.substr(0, text.find(". "));
}

}  // namespace

std::vector<ShippedScene> shipped_scenes() {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_of_scenes(), error))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<ShippedScene> scenes;
  for (const fs::path& file : files) {
    try {
      scenes.push_back({file, scene::load(file).system.name, title_of(file)});
    } catch (const core::Error&) {  // of another version
    }
  }
  return scenes;
}

}  // namespace orbweaver::drivers
