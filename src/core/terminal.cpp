#include "orbweaver/core/terminal.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace orbweaver::core {

namespace {

std::string_view variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool is_rank() { return !variable("OMPI_COMM_WORLD_RANK").empty(); }

/// The terminal that mpirun, which started this rank, writes its stream to; empty: none. The rank's own stream, a pipe
/// or a terminal that mpirun has made, says nothing of it.
std::string terminal_of_mpirun(int stream) {
  struct stat own {};
  if (isatty(stream) == 0 && (fstat(stream, &own) != 0 || !S_ISFIFO(own.st_mode))) return "";
  std::error_code error;
  const auto program = std::filesystem::read_symlink(fmt::format("/proc/{}/exe", getppid()), error).filename().string();
  if (error || (!program.starts_with("orterun") && !program.starts_with("mpirun") && !program.starts_with("prte")))
    return "";
  const auto target = std::filesystem::read_symlink(fmt::format("/proc/{}/fd/{}", getppid(), stream), error).string();
  return !error && (target.starts_with("/dev/pts/") || target.starts_with("/dev/tty")) ? target : "";
}

std::size_t columns_of(int terminal) {
  winsize size{};
  return ioctl(terminal, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

bool is_utf8(std::string_view locale) {
  return locale.ends_with("UTF-8") || locale.ends_with("utf8") || locale.ends_with("UTF8") || locale.ends_with("utf-8");
}

bool speaks_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"})
    if (!variable(name).empty()) return is_utf8(variable(name));
  return false;
}

}  // namespace

Terminal terminal_of(int stream) {
  Terminal terminal;
  std::size_t columns = 0;
  if (!is_rank()) {
    terminal.reached = isatty(stream) != 0;
    columns = terminal.reached ? columns_of(stream) : 0;
  } else if (const std::string path = terminal_of_mpirun(stream); !path.empty()) {
    terminal.reached = true;
    if (const int file = open(path.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC); file >= 0) {
      columns = columns_of(file);
      close(file);
    }
  }
  if (columns == 0) columns = std::strtoul(std::string(variable("COLUMNS")).c_str(), nullptr, 10);
  if (columns > 0) terminal.width = columns;
  terminal.redraws = terminal.reached && !variable("TERM").empty() && variable("TERM") != "dumb";
  terminal.colours = terminal.redraws && variable("NO_COLOR").empty();
  terminal.unicode = speaks_utf8();
  return terminal;
}

}  // namespace orbweaver::core
