#include "output_file.hpp"

#include <fstream>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::drivers {

std::filesystem::path part_of(std::filesystem::path path) { return path += ".part"; }

void publish_file(const std::filesystem::path& part, const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) throw core::EnvironmentError(fmt::format("cannot write {}: {}", path.string(), error.message()));
}

void write_output_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  const std::filesystem::path part = part_of(path);
  std::ofstream file(part, std::ios::binary);
  if (!file) throw core::EnvironmentError(fmt::format("cannot write {}: is there such a folder?", part.string()));
  try {
    write(file);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw;
  }
  file.close();
  if (!file) throw core::EnvironmentError(fmt::format("cannot write {}: is the disk full?", part.string()));
  publish_file(part, path);
}

}  // namespace orbweaver::drivers
