#pragma once

#include <filesystem>
#include <functional>
#include <ostream>

namespace orbweaver::core {

/// A new, empty file beside `target`, whose name it takes when it is whole: NAME.N.part with the least N that no file,
/// link or anything else has. Another process that writes the same target has another one.
class PartFile {
 public:
  /// Throws InputError where the target is a folder, EnvironmentError where no file can be made there.
  explicit PartFile(std::filesystem::path target);
  /// It goes, unless it was published.
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return _path; }
  /// Waits until what was written is on the disk, and takes the target's name from whatever has it. Throws
  /// EnvironmentError.
  void publish();

 private:
  std::filesystem::path _target;
  std::filesystem::path _path;
};

/// A folder that only this user reads, where TMPDIR says, which goes with the object. Throws EnvironmentError.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return _path; }

 private:
  std::filesystem::path _path;
};

/// Writes a PartFile and publishes it: an older PATH stays until the new one is whole. A device or a pipe (/dev/stdout)
/// is written into as it is. Throws InputError where PATH is a folder, EnvironmentError where it cannot be written;
/// what `write` throws passes through. Nothing is left of what was not finished.
void write_output_file(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// The same with the bytes of a file. Throws EnvironmentError where that is empty or cannot be read.
void copy_output_file(const std::filesystem::path& from, const std::filesystem::path& path);

/// What write_output_file would refuse, before any work is done for it. Where the file is `input` too, an atlas or the
/// folder that has it, which it would take the place of: InputError.
void require_output_file(const std::filesystem::path& path, const std::filesystem::path& input);

}  // namespace orbweaver::core
