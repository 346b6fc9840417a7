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

namespace orbweaver::drivers {

namespace {

/// Names a file that the first rank removes: mpirun ends with status 1 both where ranks do and where it starts none.
constexpr const char* mark_variable = "ORBWEAVER_LAUNCH_MARK";
constexpr int largest_status = static_cast<int>(core::ExitStatus::stopped_early);
constexpr int no_such_program = 127;  // as a shell says it
constexpr int signal_status = 128;    // and a signal's number: what mpirun ends with

/// A file that is there until the ranks run.
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
  ~Mark() { unlink(_path.c_str()); }
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

/// Waits for the process and passes signals on; its wait status.
int wait_for(pid_t process, bool stops_on_signals) {
  sigset_t awaited;
  sigemptyset(&awaited);
  for (const int signal : {SIGTERM, SIGUSR1, SIGINT, SIGCHLD}) sigaddset(&awaited, signal);
  int passed_on = 0;
  for (;;) {
    int status = 0;
    if (waitpid(process, &status, WNOHANG) == process) return status;
    int signal = 0;
    if (sigwait(&awaited, &signal) != 0 || signal == SIGCHLD) continue;
    // mpirun passes SIGUSR1 on to the ranks and ends with their status; SIGTERM ends them.
    kill(process, stops_on_signals && passed_on == 0 ? SIGUSR1 : SIGTERM);
    passed_on += signal == SIGINT || !stops_on_signals ? 1 : 0;
  }
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
  const int status = wait_for(process, options.stops_on_signals);

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

}  // namespace orbweaver::drivers
