#pragma once

#include <filesystem>
#include <utility>

namespace orbweaver::core {

/// A file that is gone when it is not needed any more: what was renamed meanwhile stays.
class ScratchFile {
 public:
  explicit ScratchFile(std::filesystem::path path) : _path(std::move(path)) {}
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(_path, ignored);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return _path; }

 private:
  std::filesystem::path _path;
};

}  // namespace orbweaver::core
