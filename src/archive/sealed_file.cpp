#include "orbweaver/archive/sealed_file.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>
#include <boost/crc.hpp>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/pause.hpp"
#include "posix_file.hpp"

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
  boost::crc_32_type crc;
  crc.process_bytes(head.data(), head.size());
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw core::InputError(fmt::format("{}: {}", path.string(), what));
}

std::string contents_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, "it is not there, or cannot be opened");
  std::string all{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad()) refuse(path, "it cannot be read");
  return all;
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
    write_file(part, {head, bytes});
    core::pause_point("publish " + path.filename().string());
    if (previous != nullptr && std::filesystem::exists(path)) rename_file(path, *previous);
    core::pause_point("replace " + path.filename().string());
    rename_file(part, path);
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
  if (version > seal.version)
    refuse(path,
           fmt::format("its version is {}, and this Orbweaver reads up to {}: use the newer Orbweaver that wrote it",
                       version, seal.version));
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
