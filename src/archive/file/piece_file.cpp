#include "orbweaver/archive/file/piece_file.hpp"

#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <zlib.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/posix_file.hpp"

namespace orbweaver::archive {

namespace {

std::uint32_t checksum_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

Piece PieceWriter::append(std::string_view bytes) {
  if (!_is_made) core::write_at(_path, 0, {}, true);
  _is_made = true;
  core::write_at(_path, _end, bytes, false);
  const Piece piece{_end, bytes.size(), checksum_of(bytes)};
  _is_synced = false;
  _end += bytes.size();
  return piece;
}

void PieceWriter::sync() {
  if (_is_synced) return;
  core::sync_file(_path);
  if (!_is_named) core::sync_folder_of(_path);
  _is_synced = _is_named = true;
}

std::string read_piece(const std::filesystem::path& path, const Piece& piece) {
  const auto refuse = [&](const std::string& what) {
    throw core::InputError(fmt::format("{}, {} bytes from {} on: {}", path.string(), piece.bytes, piece.offset, what));
  };
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) refuse("the file is not there, or is not a regular one");
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) refuse("the file cannot be opened");
  // Of the open file: network file systems look again when one is opened, and may tell an older size by its name.
  const auto size = static_cast<std::uint64_t>(file.tellg());
  if (piece.offset > size || piece.bytes > size - piece.offset)
    refuse(fmt::format("the file has {} bytes: it is torn", size));
  std::string bytes(piece.bytes, '\0');
  file.seekg(static_cast<std::streamoff>(piece.offset));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file) refuse("they cannot be read");
  if (checksum_of(bytes) != piece.checksum) refuse("their checksum is wrong: they were damaged");
  return bytes;
}

}  // namespace orbweaver::archive
