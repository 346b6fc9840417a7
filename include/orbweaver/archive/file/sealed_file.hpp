#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace orbweaver::archive {

/// What a sealed file holds: its mark and the version of its content.
struct Seal {
  std::string_view mark;  ///< 8 bytes
  std::uint32_t version = 1;
  std::uint32_t oldest = version;  ///< that is read
};

/// A file of any bytes that is whole or not there: mark (8 bytes), version (4), length of the bytes (8), CRC-32 of all
/// that and the bytes (4), then the bytes, numbers in the machine's layout. Written to PATH.part, synced and renamed;
/// an older PATH stays until then. Not collective. Throws EnvironmentError if it cannot be written.
void write_sealed(const std::filesystem::path& path, const Seal& seal, std::string_view bytes);

/// The same, and what PATH was before becomes PREVIOUS: one of the two is there and whole at any time.
void write_sealed_keeping(const std::filesystem::path& path, const std::filesystem::path& previous, const Seal& seal,
                          std::string_view bytes);

/// The bytes. Throws InputError for a file that is absent, torn, changed, foreign or of an older version than the
/// seal's oldest, NewerVersionError for one of a newer version than the seal's.
[[nodiscard]] std::string read_sealed(const std::filesystem::path& path, const Seal& seal);

}  // namespace orbweaver::archive
