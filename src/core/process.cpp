#include "orbweaver/core/process.hpp"

#include <cerrno>
#include <cstring>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include "orbweaver/core/error.hpp"

extern char** environ;

namespace orbweaver::core {

namespace {

/// What the program does before it begins.
class Actions {
 public:
  explicit Actions(const ProcessOptions& options) {
    posix_spawn_file_actions_init(&_actions);
    const std::string input = options.input.empty() ? "/dev/null" : options.input.string();
    posix_spawn_file_actions_addopen(&_actions, 0, input.c_str(), O_RDONLY, 0);
    if (options.quiet) {
      posix_spawn_file_actions_addopen(&_actions, 1, "/dev/null", O_WRONLY, 0);
      posix_spawn_file_actions_adddup2(&_actions, 1, 2);
    }
    if (!options.folder.empty()) posix_spawn_file_actions_addchdir_np(&_actions, options.folder.c_str());
  }
  ~Actions() { posix_spawn_file_actions_destroy(&_actions); }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;

  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &_actions; }

 private:
  posix_spawn_file_actions_t _actions{};
};

std::vector<std::string> environment_with(std::map<std::string, std::string> variables) {
  variables.try_emplace("OMP_NUM_THREADS", "1");
  std::vector<std::string> all;
  for (const auto& [name, value] : variables) all.push_back(name + "=" + value);
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text(*entry);
    if (!variables.contains(std::string(text.substr(0, text.find('='))))) all.emplace_back(text);
  }
  return all;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

std::optional<int> run_program(const std::vector<std::string>& words, const ProcessOptions& options) {
  std::vector<std::string> arguments = words;
  std::vector<std::string> environment = environment_with(options.environment);
  const Actions actions(options);
  pid_t process = 0;
  const int failed = posix_spawnp(&process, words.front().c_str(), actions.get(), nullptr,
                                  pointers_to(arguments).data(), pointers_to(environment).data());
  if (failed == ENOENT) return std::nullopt;
  if (failed != 0)
    throw EnvironmentError(fmt::format("{} cannot be started: {}", words.front(), std::strerror(failed)));
  int status = 0;
  while (waitpid(process, &status, 0) == -1)
    if (errno != EINTR) throw EnvironmentError(fmt::format("{} was lost: {}", words.front(), std::strerror(errno)));
  if (!WIFEXITED(status))
    throw EnvironmentError(fmt::format("{} was ended by signal {}", words.front(), WTERMSIG(status)));
  return WEXITSTATUS(status);
}

}  // namespace orbweaver::core
