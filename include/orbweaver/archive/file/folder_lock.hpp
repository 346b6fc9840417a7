#pragma once

#include <filesystem>

namespace orbweaver::archive {

/// Holds a folder for this process, by flock(2) on a file `lock` in it, until destruction or the process's end, however
/// it comes. Where the file system cannot lock, it holds nothing.
class FolderLock {
 public:
  FolderLock() = default;
  /// Throws EnvironmentError if another process holds the folder, or the file cannot be made.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int _descriptor = -1;
};

}  // namespace orbweaver::archive
