#include "output_file.hpp"

#include <fstream>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/scratch_file.hpp"
#include "orbweaver/core/survey_folder.hpp"

namespace orbweaver::drivers {

namespace {

namespace fs = std::filesystem;

/// Where a file lies while it is written.
fs::path part_of(const fs::path& path) {
  fs::path part = path;
  part += ".part";
  std::error_code ignored;
  const fs::file_status status = fs::status(part, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw core::EnvironmentError(
        fmt::format("cannot write {}: it is written as {} first, and what lies there is no file; remove that, or "
                    "give another name",
                    path.string(), part.string()));
  return part;
}

/// `asked`: the file of the user's words.
std::ofstream opened(const fs::path& path, const fs::path& asked) {
  std::ofstream file(path, std::ios::binary);
  if (!file) throw core::EnvironmentError(fmt::format("cannot write {}: is there such a folder?", asked.string()));
  return file;
}

void finish(std::ofstream& file, const fs::path& path) {
  file.close();
  if (!file) throw core::EnvironmentError(fmt::format("cannot write {}: is the disk full?", path.string()));
}

/// Whether it keeps its place: a device or a pipe, and what the system's folders hold, where /dev/stdout is the name of
/// whatever the standard output goes to, a file too.
bool is_device_or_pipe(const fs::path& path) {
  std::error_code ignored;
  const std::string folder = fs::absolute(path, ignored).lexically_normal().string();
  const bool is_system =
      folder.starts_with("/proc/") || (folder.starts_with("/dev/") && !folder.starts_with("/dev/shm/"));
  if (is_system) return fs::exists(path, ignored);
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status))
    throw core::InputError(fmt::format("cannot write {}: it is a folder; name a file in it", path.string()));
  return fs::exists(status) && !fs::is_regular_file(status);
}

}  // namespace

void write_output_file(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  if (is_device_or_pipe(path)) {
    std::ofstream file = opened(path, path);
    write(file);
    return finish(file, path);
  }
  const core::ScratchFile part(part_of(path));
  std::ofstream file = opened(part.path(), path);
  write(file);
  finish(file, path);
  std::error_code error;
  fs::rename(part.path(), path, error);
  if (error) throw core::EnvironmentError(fmt::format("cannot write {}: {}", path.string(), error.message()));
}

void require_output_file(const fs::path& path, const fs::path& input) {
  std::error_code ignored;
  if (fs::equivalent(path, core::atlas_named(input), ignored))
    throw core::InputError(
        fmt::format("cannot write {}: it is the file that is read; give another name", path.string()));
  if (is_device_or_pipe(path)) return;
  const core::ScratchFile part(part_of(path));
  static_cast<void>(opened(part.path(), path));
}

}  // namespace orbweaver::drivers
