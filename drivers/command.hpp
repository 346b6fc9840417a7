#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace orbweaver::drivers {

/// What the command line holds besides a subcommand's own options.
struct Invocation {
  std::vector<std::string> petsc_options;  ///< the words after `--`, for core::Session
};

/// One subcommand: its parser, and what runs when the parser was chosen. `run` returns the exit status
/// (core::ExitStatus as an int); what it throws is reported by main.
struct Command {
  CLI::App* parser = nullptr;
  std::function<int(const Invocation&)> run;
  bool stops_on_signals = false;  ///< `run` calls stop_on_signals; until then signals wait
  bool takes_ranks = false;       ///< ranks share its work: --ranks may start them
};

// One function a subcommand, each in the file of its name. To add one: write drivers/<name>.cpp, name it here, in the
// list of drivers/main.cpp and in drivers/CMakeLists.txt. The function adds a subcommand with its options to `program`;
// option values live in a shared_ptr that `run` captures.
Command make_check_command(CLI::App& program);
Command make_compare_command(CLI::App& program);
Command make_completion_command(CLI::App& program);
Command make_consolidate_command(CLI::App& program);
Command make_cost_command(CLI::App& program);
Command make_export_command(CLI::App& program);
Command make_manual_command(CLI::App& program);
Command make_page_command(CLI::App& program);
Command make_plot_command(CLI::App& program);
Command make_refine_command(CLI::App& program);
Command make_show_command(CLI::App& program);
Command make_survey_command(CLI::App& program);
Command make_sweep_command(CLI::App& program);
Command make_systems_command(CLI::App& program);
Command make_verify_command(CLI::App& program);

}  // namespace orbweaver::drivers
