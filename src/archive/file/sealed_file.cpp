#include "orbweaver/archive/file/sealed_file.hpp"

#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <zlib.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/pause.hpp"
#include "orbweaver/core/posix_file.hpp"

namespace orbweaver::archive {

namespace {

constexpr std::size_t mark_bytes = 8;
constexpr std::size_t head_bytes = mark_bytes + sizeof(std::uint32_t) + sizeof(std::uint64_t) + sizeof(std::uint32_t);

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::uint32_t checksum(std::string_view head, std::string_view bytes) {
  const auto add = [](unsigned long crc, std::string_view more) {
    return crc32_z(crc, reinterpret_cast<const Bytef*>(more.data()), more.size());
  };
  return static_cast<std::uint32_t>(add(add(0, head), bytes));
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw core::InputError(fmt::format("{}: {}", path.string(), what));
}

std::string contents_of(const std::filesystem::path& path) {
  std::error_code code;
  const auto type = std::filesystem::status(path, code).type();
  if (type != std::filesystem::file_type::regular && type != std::filesystem::file_type::not_found)
    refuse(path, code ? fmt::format("it cannot be looked at ({})", code.message()) : "it is not a regular file");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, "it is not there, or cannot be opened");
  std::ostringstream all;
  all << file.rdbuf();
  if (file.bad() || all.bad()) refuse(path, "it cannot be read");
  return std::move(all).str();
}

}  // namespace

namespace {

void write(const std::filesystem::path& path, const std::filesystem::path* previous, const Seal& seal,
           std::string_view bytes) {
  core::require(seal.mark.size() == mark_bytes, "a sealed file's mark has 8 bytes");
  std::string head(seal.mark);
  append(head, seal.version);
  append(head, static_cast<std::uint64_t>(bytes.size()));
  append(head, checksum(head, bytes));
  const std::filesystem::path part = path.string() + ".part";
  try {
    core::write_file(part, {head, bytes});
    core::pause_point("publish " + path.filename().string());
    if (previous != nullptr && std::filesystem::exists(path)) core::rename_file(path, *previous);
    core::pause_point("replace " + path.filename().string());
    core::rename_file(part, path);
  } catch (const core::EnvironmentError&) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw;
  }
}

}  // namespace

void write_sealed(const std::filesystem::path& path, const Seal& seal, std::string_view bytes) {
  write(path, nullptr, seal, bytes);
}

void write_sealed_keeping(const std::filesystem::path& path, const std::filesystem::path& previous, const Seal& seal,
                          std::string_view bytes) {
  write(path, &previous, seal, bytes);
}

std::string read_sealed(const std::filesystem::path& path, const Seal& seal) {
  std::string all = contents_of(path);
  if (all.size() < head_bytes || all.compare(0, mark_bytes, seal.mark) != 0)
    refuse(path, "it does not begin as such a file should: it is torn, or another program's");
  const auto version = number_at<std::uint32_t>(all, mark_bytes);
  const std::string reads = seal.oldest == seal.version ? fmt::format("version {}", seal.version)
                                                        : fmt::format("versions {} to {}", seal.oldest, seal.version);
  if (version > seal.version)
    throw core::NewerVersionError(
        fmt::format("{}: its version is {}, and this Orbweaver reads {}; nothing was changed: use the newer "
                    "Orbweaver that wrote it",
                    path.string(), version, reads));
  if (version < seal.oldest)
    refuse(path, fmt::format("its version is {}, and this Orbweaver reads {}: use the Orbweaver that wrote it", version,
                             reads));
  const auto length = number_at<std::uint64_t>(all, mark_bytes + 4);
  if (length != all.size() - head_bytes)
    refuse(path, fmt::format("it should hold {} bytes and holds {}: it is torn", length, all.size() - head_bytes));
  const auto stored = number_at<std::uint32_t>(all, mark_bytes + 12);
  const std::string_view view = all;
  if (checksum(view.substr(0, mark_bytes + 12), view.substr(head_bytes)) != stored)
    refuse(path, "its checksum is wrong: it was damaged");
  all.erase(0, head_bytes);
  return all;
}

}  // namespace orbweaver::archive
