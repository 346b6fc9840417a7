#include "pager.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace orbweaver::drivers {

namespace {

bool is_on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  return false;
}

/// For a shell; empty: none.
std::string pager_command() {
  const char* chosen = std::getenv("PAGER");
  if (chosen != nullptr) return chosen == std::string("cat") ? "" : chosen;
  return is_on_path("less") ? "less" : "";
}

extern "C" void reader_has_left(int) { _exit(0); }

}  // namespace

Pager::Pager() : _terminal(core::terminal_of(STDOUT_FILENO)) {
  const std::string command = isatty(STDOUT_FILENO) != 0 && _terminal.redraws ? pager_command() : "";
  std::array<int, 2> ends{};
  if (command.empty() || pipe(ends.data()) != 0) return;
  std::fflush(stdout);
  setenv("LESS", "FRSX", 0);  // ends where one screen holds all, shows colours, cuts long lines, leaves the text behind
  _process = fork();
  if (_process == 0) {
    dup2(ends[0], STDIN_FILENO);
    close(ends[0]);
    close(ends[1]);
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  if (_process > 0) {
    dup2(ends[1], STDOUT_FILENO);
    std::signal(SIGPIPE, reader_has_left);
    std::signal(SIGINT, SIG_IGN);  // it is the pager's: ours is to wait for it
  }
  close(ends[0]);
  close(ends[1]);
}

Pager::~Pager() {
  if (_process <= 0) return;
  std::fflush(stdout);
  close(STDOUT_FILENO);
  while (waitpid(_process, nullptr, 0) == -1 && errno == EINTR) {
  }
}

}  // namespace orbweaver::drivers
