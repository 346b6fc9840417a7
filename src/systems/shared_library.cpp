#include "shared_library.hpp"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::systems {

namespace {

using Head = ElfW(Ehdr);
using Segment = ElfW(Phdr);

/// Of a segment in memory; larger than any program.
constexpr std::uint64_t most_memory = std::uint64_t{1} << 32;

template <class Record>
bool read_at(std::ifstream& file, std::uint64_t place, Record& record) {
  file.clear();
  file.seekg(static_cast<std::streamoff>(place));
  return static_cast<bool>(file.read(reinterpret_cast<char*>(&record), sizeof record));
}

/// Class, order of bytes and processor are the running program's.
bool is_of_this_machine(const Head& head) {
  std::ifstream program("/proc/self/exe", std::ios::binary);
  Head own{};
  return read_at(program, 0, own) && std::memcmp(own.e_ident, head.e_ident, EI_VERSION + 1) == 0 &&
         own.e_machine == head.e_machine;
}

}  // namespace

void require_shared_library(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw core::InputError("it cannot be opened");
  file.seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(file.tellg());
  Head head{};
  if (!read_at(file, 0, head) || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 || head.e_type != ET_DYN)
    throw core::InputError("it is no shared library");
  if (!is_of_this_machine(head)) throw core::InputError("it is a shared library for another machine");
  if (head.e_phentsize != sizeof(Segment) || head.e_phnum == 0)
    throw core::InputError("it is a shared library without segments");
  for (std::uint64_t n = 0; n < head.e_phnum; ++n) {
    Segment segment{};
    if (head.e_phoff > size || !read_at(file, head.e_phoff + n * sizeof segment, segment))
      throw core::InputError(
          fmt::format("it is torn: of its {} segments not all are told in its {} bytes", head.e_phnum, size));
    if (segment.p_offset > size || segment.p_filesz > size - segment.p_offset)
      throw core::InputError(fmt::format("it is torn: it has {} bytes, and a segment of {} from byte {} on", size,
                                         segment.p_filesz, segment.p_offset));
    if (segment.p_type == PT_LOAD && (segment.p_memsz < segment.p_filesz || segment.p_memsz > most_memory))
      throw core::InputError(
          fmt::format("it is damaged: a segment of {} bytes takes {} in memory", segment.p_filesz, segment.p_memsz));
  }
}

}  // namespace orbweaver::systems
