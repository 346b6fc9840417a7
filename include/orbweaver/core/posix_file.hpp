#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace orbweaver::core {

/// Files are written through these and through output_file.hpp only. What is created is a new file: a file or a link of
/// that name goes first, and nothing that it leads to is touched; a link is not followed where a file is opened,
/// either. All of these throw EnvironmentError with the path, what was being done and the system's reason.

/// Creates the file, gives it `bytes` bytes of disk and shows that they can be written.
void try_out_file(const std::filesystem::path& path, std::uint64_t bytes);

/// Takes the disk space of an existing file's first `bytes` bytes without changing its size.
void reserve_space(const std::filesystem::path& path, std::uint64_t bytes);

/// Shows that this rank can open the file for writing.
void expect_writable(const std::filesystem::path& path);

/// Creates the file, writes `pieces` one after the other and waits until they are on the disk.
void write_file(const std::filesystem::path& path, std::initializer_list<std::string_view> pieces);

/// Writes `bytes` from `offset` on, and closes the file. `create`: which must not be there yet.
void write_at(const std::filesystem::path& path, std::uint64_t offset, std::string_view bytes, bool create);

/// Waits until what this machine wrote to the file is on the disk.
void sync_file(const std::filesystem::path& path);

/// Waits until the folder remembers that the file is in it.
void sync_folder_of(const std::filesystem::path& path);

/// Renames, and waits until the folder remembers it.
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace orbweaver::core
