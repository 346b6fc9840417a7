#include <algorithm>
#include <csignal>
#include <exception>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "command.hpp"
#include "failure.hpp"
#include "orbweaver/core/blas_kernels.hpp"
#include "orbweaver/core/error.hpp"

namespace {

using orbweaver::drivers::Command;
using orbweaver::drivers::Invocation;

constexpr int wrong_input = static_cast<int>(orbweaver::core::ExitStatus::wrong_input);

std::vector<Command> add_commands(CLI::App& program) {
  using namespace orbweaver::drivers;
  return {
      make_check_command(program),  make_compare_command(program), make_consolidate_command(program),
      make_cost_command(program),   make_refine_command(program),  make_show_command(program),
      make_survey_command(program), make_sweep_command(program),   make_systems_command(program),
      make_verify_command(program),
  };
}

std::vector<std::string> names_of(const std::vector<Command>& commands) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.parser->get_name());
  return names;
}

/// Cuts the words after the first `--` off `words`.
Invocation take_petsc_options(std::vector<std::string>& words) {
  const auto mark = std::find(words.begin(), words.end(), "--");
  Invocation invocation;
  if (mark != words.end()) invocation.petsc_options.assign(mark + 1, words.end());
  words.erase(mark, words.end());
  return invocation;
}

/// A closed stdin, stdout or stderr becomes /dev/null, so that no file of ours gets its number.
void open_standard_streams() {
  for (int fd = 0; fd <= 2; ++fd)
    if (fcntl(fd, F_GETFD) == -1) static_cast<void>(open("/dev/null", fd == 0 ? O_RDONLY : O_WRONLY));
}

int run(std::vector<std::string> words) {
  CLI::App program("Orbweaver maps how the periodic orbits of a dynamical system hang together.", "orbweaver");
  program.set_version_flag("--version", "orbweaver " ORBWEAVER_VERSION);
  program.footer("Options for PETSc, SLEPc and TAO follow after `--`.");
  program.require_subcommand(1);
  const std::vector<Command> commands = add_commands(program);
  const Invocation invocation = take_petsc_options(words);
  const std::string first = words.empty() ? "" : words.front();
  std::reverse(words.begin(), words.end());  // the order in which CLI11 wants a vector
  try {
    program.parse(words);
  } catch (const CLI::RequiredError& error) {
    if (!first.empty() && !first.starts_with('-') && program.get_subcommands().empty())
      throw orbweaver::core::InputError(fmt::format("expected a command, one of {}, got `{}`; see orbweaver --help",
                                                    fmt::join(names_of(commands), ", "), first));
    return program.exit(error) == 0 ? 0 : wrong_input;
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : wrong_input;
  }
  const auto chosen =
      std::find_if(commands.begin(), commands.end(), [](const Command& c) { return c.parser->parsed(); });
  return chosen->run(invocation);
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // beyond `ulimit -f` a write fails, as on a full disk, and the program says so
  orbweaver::core::prefer_fitting_blas_kernels(argv);
  try {
    return run({argv + 1, argv + argc});
  } catch (...) {
    return orbweaver::drivers::report_failure(std::current_exception());
  }
}
