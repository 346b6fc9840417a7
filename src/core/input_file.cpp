#include "orbweaver/core/input_file.hpp"

#include <unistd.h>

#include <cerrno>

#include <fmt/format.h>

namespace orbweaver::core {

std::string unreadable_input(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::error_code ignored;
  switch (fs::status(path, error).type()) {
    case fs::file_type::regular: break;
    case fs::file_type::not_found: return fs::is_symlink(path, ignored) ? "a link to nothing" : "none";
    case fs::file_type::directory: return "a folder";
    case fs::file_type::fifo: return "a pipe";
    case fs::file_type::socket: return "a socket";
    case fs::file_type::block:
    case fs::file_type::character: return "a device";
    default:
      if (error == std::errc::too_many_symbolic_link_levels) return "a link in a circle";
      return fmt::format("one that cannot be reached ({})", error.message());
  }
  if (access(path.c_str(), R_OK) == 0) return "";
  if (errno == EACCES) return "one that may not be read (see its permissions)";
  return fmt::format("one that cannot be read ({})", std::generic_category().message(errno));
}

std::string input_problem(const std::filesystem::path& path) {
  const std::string got = unreadable_input(path);
  return got.empty() ? "" : got == "none" ? "does not exist" : "is " + got;
}

}  // namespace orbweaver::core
