#include "orbweaver/core/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/posix_file.hpp"
#include "orbweaver/core/survey_folder.hpp"

namespace orbweaver::core {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_unwritable(const fs::path& path) {
  const int code = errno;
  const char* advice = code == ENOENT || code == ENOTDIR ? "is there such a folder?" : "give another place";
  throw EnvironmentError(fmt::format("cannot write {}: {} ({})", path.string(), advice, std::strerror(code)));
}

void finish(std::ofstream& file, const fs::path& path) {
  file.close();
  if (!file) throw EnvironmentError(fmt::format("cannot write {}: is the disk full?", path.string()));
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
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

PartFile::PartFile(fs::path target) : _target(std::move(target)) {
  std::error_code ignored;
  if (fs::is_directory(_target, ignored))
    throw InputError(fmt::format("cannot write {}: it is a folder; name a file in it", _target.string()));
  for (int n = 1;; ++n) {
    _path = fs::path(_target).concat(fmt::format(".{}.part", n));
    const int file = open(_path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0) {
      close(file);
      return;
    }
    if (errno != EEXIST) throw_unwritable(_target);
  }
}

PartFile::~PartFile() {
  std::error_code ignored;
  if (!_path.empty()) fs::remove(_path, ignored);
}

void PartFile::publish() {
  sync_file(_path);
  rename_file(_path, _target);
  _path.clear();
}

TemporaryFolder::TemporaryFolder() {
  std::error_code code;
  const fs::path where = fs::temp_directory_path(code);
  if (code) throw EnvironmentError(fmt::format("TMPDIR names no folder: {}", code.message()));
  std::string name = (where / "orbweaver_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw EnvironmentError(fmt::format("cannot make the folder {}: {}; TMPDIR says where", name, std::strerror(errno)));
  _path = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(_path, ignored);
}

void write_output_file(const fs::path& path, const std::function<void(std::ostream&)>& write) {
  if (is_device_or_pipe(path)) {
    std::ofstream file(path, std::ios::binary);
    if (!file) throw_unwritable(path);
    write(file);
    return finish(file, path);
  }
  PartFile part(path);
  std::ofstream file(part.path(), std::ios::binary);
  write(file);
  finish(file, path);
  part.publish();
}

void copy_output_file(const fs::path& from, const fs::path& path) {
  write_output_file(path, [&](std::ostream& file) {
    std::ifstream stream(from, std::ios::binary);
    if (!(file << stream.rdbuf()))
      throw EnvironmentError(
          fmt::format("nothing was written for {}; messages of what writes it are above", path.string()));
  });
}

void require_output_file(const fs::path& path, const fs::path& input) {
  std::error_code ignored;
  if (fs::equivalent(path, atlas_named(input), ignored))
    throw InputError(fmt::format("cannot write {}: it is the file that is read; give another name", path.string()));
  if (!is_device_or_pipe(path)) static_cast<void>(PartFile(path));
}

}  // namespace orbweaver::core
