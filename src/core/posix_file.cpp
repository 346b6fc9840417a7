#include "orbweaver/core/posix_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::core {

namespace {

constexpr std::size_t bytes_at_once = std::size_t{16} << 20;

[[noreturn]] void throw_system_error(const char* doing, const std::filesystem::path& path) {
  const int code = errno;
  throw EnvironmentError(fmt::format("cannot {} '{}': {}. Check the folder, its permissions and the free space.", doing,
                                     path.string(), std::strerror(code)));
}

/// Of a file or a folder: a pipe is refused, and not waited for; a link that has a file's name is not followed.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags, const char* doing)
      : _number(open(path.c_str(), flags | (flags & O_DIRECTORY ? 0 : O_NOFOLLOW) | O_CLOEXEC | O_NONBLOCK, 0666)) {
    const bool has_no_reader = _number < 0 && errno == ENXIO;
    if (_number < 0 && !has_no_reader) throw_system_error(doing, path);
    struct stat kind {};
    const bool is_file =
        !has_no_reader && fstat(_number, &kind) == 0 && (S_ISREG(kind.st_mode) || S_ISDIR(kind.st_mode));
    if (is_file) return;
    if (_number >= 0) close(_number);
    throw EnvironmentError(
        fmt::format("cannot {} '{}': a pipe, a socket or a device lies there. Remove it, or give another place.", doing,
                    path.string()));
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(_number); }
  [[nodiscard]] int get() const { return _number; }

 private:
  int _number;
};

/// A new file. A file or a link of that name goes first; a pipe or a folder is somebody's, and stays.
Descriptor created(const std::filesystem::path& path) {
  struct stat kind {};
  if (lstat(path.c_str(), &kind) == 0 && (S_ISREG(kind.st_mode) || S_ISLNK(kind.st_mode))) unlink(path.c_str());
  return {path, O_WRONLY | O_CREAT | O_EXCL, "create"};
}

void reserve(const Descriptor& file, int mode, std::uint64_t bytes, const std::filesystem::path& path) {
  // File systems without this call cannot be asked in advance.
  if (fallocate(file.get(), mode, 0, static_cast<off_t>(bytes)) != 0 && errno != EOPNOTSUPP && errno != ENOSYS)
    throw_system_error("reserve disk space for", path);
}

void sync(const std::filesystem::path& path, int flags) {
  const Descriptor descriptor(path, flags, "open");
  if (fsync(descriptor.get()) != 0) throw_system_error("sync", path);
}

}  // namespace

void try_out_file(const std::filesystem::path& path, std::uint64_t bytes) {
  const Descriptor file = created(path);
  reserve(file, 0, bytes, path);
  const std::array<char, 4096> block{};
  const off_t last = static_cast<off_t>(bytes > block.size() ? bytes - block.size() : 0);
  for (const off_t at : {off_t{0}, last})
    if (pwrite(file.get(), block.data(), block.size(), at) != static_cast<ssize_t>(block.size()))
      throw_system_error("write to", path);
}

void reserve_space(const std::filesystem::path& path, std::uint64_t bytes) {
  if (bytes > 0) reserve(Descriptor(path, O_WRONLY, "open"), FALLOC_FL_KEEP_SIZE, bytes, path);
}

void expect_writable(const std::filesystem::path& path) {
  const Descriptor file(path, O_RDWR, "open for writing on every rank (is the folder shared by all machines?)");
}

void write_file(const std::filesystem::path& path, std::initializer_list<std::string_view> pieces) {
  const Descriptor file = created(path);
  off_t begun = 0;  // what the disk was told to write, while the next piece is copied
  off_t size = 0;
  for (std::string_view piece : pieces)
    while (!piece.empty()) {
      const ssize_t written = write(file.get(), piece.data(), std::min(piece.size(), bytes_at_once));
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) throw_system_error("write to", path);
      piece.remove_prefix(static_cast<std::size_t>(written));
      size += written;
      if (size - begun < static_cast<off_t>(bytes_at_once)) continue;
      static_cast<void>(sync_file_range(file.get(), begun, size - begun, SYNC_FILE_RANGE_WRITE));
      begun = size;
    }
  if (fsync(file.get()) != 0) throw_system_error("sync", path);
}

void write_at(const std::filesystem::path& path, std::uint64_t offset, std::string_view bytes, bool create) {
  const Descriptor file(path, O_WRONLY | (create ? O_CREAT | O_EXCL : 0), create ? "create" : "open");
  while (!bytes.empty()) {
    const ssize_t written = pwrite(file.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw_system_error("write to", path);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void sync_file(const std::filesystem::path& path) { sync(path, O_WRONLY); }

void sync_folder_of(const std::filesystem::path& path) {
  sync(path.has_parent_path() ? path.parent_path() : std::filesystem::path("."), O_RDONLY | O_DIRECTORY);
}

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) throw_system_error("rename to its final name the file", from);
  sync_folder_of(to);
}

}  // namespace orbweaver::core
