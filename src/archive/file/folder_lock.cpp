#include "orbweaver/archive/file/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::archive {

FolderLock::FolderLock(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "lock";
  _descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (_descriptor < 0)
    throw core::EnvironmentError(fmt::format("cannot create '{}': {}. Check the folder and its permissions.",
                                             path.string(), std::strerror(errno)));
  if (flock(_descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(std::exchange(_descriptor, -1));
  throw core::EnvironmentError(fmt::format("another process is at work on the survey in {}: wait until it has ended",
                                           folder.parent_path().string()));
}

FolderLock::FolderLock(FolderLock&& other) noexcept : _descriptor(std::exchange(other._descriptor, -1)) {}

FolderLock& FolderLock::operator=(FolderLock&& other) noexcept {
  std::swap(_descriptor, other._descriptor);
  return *this;
}

FolderLock::~FolderLock() {
  if (_descriptor >= 0) close(_descriptor);
}

}  // namespace orbweaver::archive
