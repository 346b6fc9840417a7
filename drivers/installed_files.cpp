#include "installed_files.hpp"

#include "build_settings.hpp"

namespace orbweaver::drivers {

namespace fs = std::filesystem;

InstalledFiles installed_files() {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  if (program.string().starts_with(build_folder + "/")) return {source_headers, source_models, source_scenes};
  const fs::path prefix = program.parent_path().parent_path();
  return {prefix / installed_headers, prefix / installed_models, prefix / installed_scenes};
}

}  // namespace orbweaver::drivers
