#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace orbweaver::archive {

/// Where bytes lie in a file of pieces, and what they sum up to.
struct Piece {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::uint32_t checksum = 0;  ///< CRC-32

  friend bool operator==(const Piece&, const Piece&) = default;
};

/// Writes a file of pieces one behind the other, without anything between them: one process writes, any may read what
/// it has been told of. The file is made with the first piece; a file that is there already is not touched.
class PieceWriter {
 public:
  explicit PieceWriter(std::filesystem::path path) : _path(std::move(path)) {}

  /// Whoever opens the file from now on finds the piece, on other machines too: it is closed again. Throws
  /// EnvironmentError; the file may then be longer, and the next piece takes that place.
  Piece append(std::string_view bytes);
  /// Waits until all pieces are on the disk, and the folder remembers the file. Throws EnvironmentError.
  void sync();
  [[nodiscard]] const std::filesystem::path& path() const { return _path; }

 private:
  std::filesystem::path _path;
  std::uint64_t _end = 0;
  bool _is_made = false;
  bool _is_named = false;  // the folder remembers it
  bool _is_synced = true;
};

/// The piece's bytes. Throws InputError, with the file and the place, if it is absent, torn or changed.
[[nodiscard]] std::string read_piece(const std::filesystem::path& path, const Piece& piece);

}  // namespace orbweaver::archive
