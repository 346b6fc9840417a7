#include <algorithm>
#include <csignal>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "command.hpp"
#include "failure.hpp"
#include "launch.hpp"
#include "orbweaver/core/blas_kernels.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/pause.hpp"
#include "signals.hpp"

namespace {

using orbweaver::drivers::Command;
using orbweaver::drivers::Invocation;

constexpr int most_ranks = 100000;

std::vector<Command> add_commands(CLI::App& program) {
  using namespace orbweaver::drivers;
  return {
      make_check_command(program),       make_compare_command(program), make_completion_command(program),
      make_consolidate_command(program), make_cost_command(program),    make_export_command(program),
      make_manual_command(program),      make_page_command(program),    make_plot_command(program),
      make_refine_command(program),      make_show_command(program),    make_survey_command(program),
      make_sweep_command(program),       make_systems_command(program), make_verify_command(program),
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

/// Known for this version, and refused.
bool asks_for_plugin(const std::vector<std::string>& words, bool lacks_command) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return word == "--plugin" || word.starts_with("--plugin=") || (lacks_command && word == "build-system");
  });
}
constexpr const char* no_plugins =
    "`--plugin` and `build-system` are no more: a model is text, its equations in `system:` of the scene or in a file "
    "that `system.model_file` names; `orbweaver systems lorenz --text` shows one (docs/models.md)";

/// A closed stdin, stdout or stderr becomes /dev/null, so that no file of ours gets its number; what is written to a
/// closed stdout fails all the same, as results are.
void open_standard_streams() {
  for (int fd = 0; fd <= 2; ++fd)
    if (fcntl(fd, F_GETFD) == -1) static_cast<void>(open("/dev/null", fd == 2 ? O_WRONLY : O_RDONLY));
}

int run(std::vector<std::string> words) {
  CLI::App program("Orbweaver maps how the periodic orbits of a dynamical system hang together.", "orbweaver");
  program.set_version_flag("--version", "orbweaver " ORBWEAVER_VERSION);
  program.footer(
      "Options for PETSc, SLEPc and TAO follow after `--`.\n\nExamples:\n  orbweaver --ranks 4 survey scene.yaml -o "
      "out\n  "
      "orbweaver survey --help");
  program.require_subcommand(1);
  int ranks = 0;
  program.add_option("--ranks", ranks, "Before survey, verify or consolidate: start this many MPI ranks (by mpirun)")
      ->type_name("N")
      ->check(CLI::Range(1, most_ranks));
  const std::vector<Command> commands = add_commands(program);
  const std::vector<std::string> all_words = words;
  const Invocation invocation = take_petsc_options(words);
  const auto word = std::find_if(words.begin(), words.end(), [](const std::string& w) { return !w.starts_with('-'); });
  const std::string got = word != words.end() ? *word : words.empty() ? "" : words.front();
  const bool is_empty = words.empty();
  std::reverse(words.begin(), words.end());  // the order in which CLI11 wants a vector
  try {
    program.parse(words);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text;
      const int status = program.exit(error, text, text);
      orbweaver::drivers::print_as_it_is(text.str());
      return status;
    }
    const bool lacks_command = program.get_subcommands().empty();
    if (asks_for_plugin(all_words, lacks_command)) throw orbweaver::core::InputError(no_plugins);
    throw orbweaver::core::InputError(
        lacks_command
            ? fmt::format("expected a command, one of {}, got {}; see orbweaver --help",
                          fmt::join(names_of(commands), ", "), is_empty ? "none" : fmt::format("`{}`", got))
            : fmt::format("{}; see orbweaver {} --help", error.what(), program.get_subcommands().front()->get_name()));
  }
  const auto chosen =
      std::find_if(commands.begin(), commands.end(), [](const Command& c) { return c.parser->parsed(); });
  const bool launched = orbweaver::drivers::is_launched();
  if (ranks > 0 && !launched) {
    if (!chosen->takes_ranks)
      throw orbweaver::core::InputError(fmt::format("{} runs on one rank: drop --ranks", chosen->parser->get_name()));
    return orbweaver::drivers::launch({ranks, chosen->stops_on_signals}, all_words);
  }
  if (!chosen->stops_on_signals) orbweaver::drivers::release_signals();
  return chosen->run(invocation);
}

}  // namespace

int main(int argc, char** argv) {
  orbweaver::drivers::hold_signals();  // also those that come while MPI starts
  open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // beyond `ulimit -f` a write fails, as on a full disk, and the program says so
  orbweaver::core::prefer_fitting_blas_kernels(argv);
  orbweaver::core::pause_point("begin");
  int status = 0;
  try {
    status = run({argv + 1, argv + argc});
  } catch (...) {
    status = orbweaver::drivers::report_failure(std::current_exception());
  }
  orbweaver::drivers::tell_of_mpirun(status);
  return status;
}
