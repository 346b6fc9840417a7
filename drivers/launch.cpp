#include "launch.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log.hpp"
#include "signals.hpp"

namespace orbweaver::drivers {

namespace {

constexpr int largest_status = static_cast<int>(core::ExitStatus::stopped_early);
constexpr int no_such_program = 127;  // as a shell says it
constexpr int signal_status = 128;    // and a signal's number: what mpirun ends with

/// A file that is there until the ranks run: mpirun ends with status 1 both where ranks do and where it starts none.
class Mark {
 public:
  Mark() {
    const char* folder = std::getenv("TMPDIR");
    _path = fmt::format("{}/orbweaver-launch-XXXXXX", folder != nullptr ? folder : "/tmp");
    const int file = mkstemp(_path.data());
    if (file < 0)
      throw core::EnvironmentError(
          fmt::format("cannot write {}: {}. Set TMPDIR to a folder that can be written.", _path, std::strerror(errno)));
    close(file);
    setenv(mark_variable, _path.c_str(), 1);
  }
  ~Mark() {
    unlink(_path.c_str());
    forget_passed_on();
  }
  Mark(const Mark&) = delete;
  Mark& operator=(const Mark&) = delete;

  [[nodiscard]] bool is_there() const { return access(_path.c_str(), F_OK) == 0; }

 private:
  std::string _path;
};

[[noreturn]] void become_mpirun(std::vector<std::string> words, pid_t parent) {
  setpgid(0, 0);  // so that a terminal's Ctrl-C comes to us alone, and we pass it on as what ends well
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(largest_status);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  if (const int nothing = open("/dev/null", O_RDONLY); nothing >= 0) dup2(nothing, STDIN_FILENO);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(arguments.front(), arguments.data());
  _exit(no_such_program);
}

struct Waited {
  int status = 0;    // as waitpid has it
  int ended_by = 0;  // a signal that was to end the ranks at once; 0: none
};

/// Waits for the process and passes signals on.
Waited wait_for(pid_t process, bool stops_on_signals) {
  sigset_t awaited = stopping_signals();
  sigaddset(&awaited, SIGCHLD);
  Waited waited;
  bool interrupted = false;
  for (;;) {
    if (waitpid(process, &waited.status, WNOHANG) == process) return waited;
    int signal = 0;
    if (sigwait(&awaited, &signal) != 0 || signal == SIGCHLD) continue;
    if (stops_on_signals && !interrupted) {
      interrupted = signal == SIGINT;
      tell_passed_on(signal);
      kill(process, SIGUSR1);  // which mpirun passes on to the ranks, and ends with their status
    } else {
      waited.ended_by = signal;
      kill(process, SIGTERM);  // ends them
    }
  }
}

/// Ends this process as the signal would have without us.
void end_by(int signal) {
  forget_passed_on();
  unlink(std::getenv(mark_variable));
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  release_signals();
}

}  // namespace

int launch(const Launch& options, const std::vector<std::string>& words) {
  setenv("OMP_NUM_THREADS", "1", 0);
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  const Mark mark;
  std::vector<std::string> all{"mpirun",        "--quiet", "--oversubscribe", "-n", fmt::to_string(options.ranks),
                               "/proc/self/exe"};
  std::string self(4096, '\0');
  const ssize_t length = readlink("/proc/self/exe", self.data(), self.size());
  if (length > 0) all.back() = self.substr(0, static_cast<std::size_t>(length));
  all.insert(all.end(), words.begin(), words.end());

  sigset_t child;
  sigemptyset(&child);
  sigaddset(&child, SIGCHLD);
  sigprocmask(SIG_BLOCK, &child, nullptr);
  const pid_t self_id = getpid();
  const pid_t process = fork();
  if (process < 0) throw core::EnvironmentError(fmt::format("cannot start mpirun: {}", std::strerror(errno)));
  if (process == 0) become_mpirun(all, self_id);
  const Waited waited = wait_for(process, options.stops_on_signals);
  if (waited.ended_by != 0) end_by(waited.ended_by);

  const int status = waited.status;
  const int ended = WIFEXITED(status) ? WEXITSTATUS(status) : signal_status + WTERMSIG(status);
  if (ended == no_such_program && mark.is_there())
    throw core::EnvironmentError(
        "--ranks starts ranks by mpirun, which is not there: install it (Debian: openmpi-bin)");
  if (mark.is_there())
    throw core::EnvironmentError(
        fmt::format("mpirun could not start {} ranks; it says why to `mpirun -n {} orbweaver --version`", options.ranks,
                    options.ranks));
  if (ended > signal_status)
    throw core::EnvironmentError(
        fmt::format("signal {} ({}) has ended a rank{}", ended - signal_status, strsignal(ended - signal_status),
                    options.stops_on_signals ? "; the survey goes on from its last checkpoint with --resume" : ""));
  return ended;
}

bool is_launched() {
  const char* rank = std::getenv("OMPI_COMM_WORLD_RANK");
  const char* mark = std::getenv(mark_variable);
  if (rank != nullptr && mark != nullptr && std::strcmp(rank, "0") == 0) unlink(mark);
  return rank != nullptr;
}

void tell_of_mpirun(int status) {
  const char* rank = std::getenv("OMPI_COMM_WORLD_RANK");
  const bool is_plain = rank != nullptr && std::strcmp(rank, "0") == 0 && std::getenv(mark_variable) == nullptr;
  if (status == 0 || !is_plain) return;
  core::write_line(stderr,
                   "orbweaver: lines of mpirun may follow that say no more: `orbweaver --ranks N ...`, or "
                   "`mpirun --quiet`, leaves them out (docs/terminal.md)");
}

}  // namespace orbweaver::drivers
