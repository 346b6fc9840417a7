#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "build_settings.hpp"
#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "installed_files.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/file_hash.hpp"
#include "orbweaver/core/input_file.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/output_file.hpp"
#include "orbweaver/core/posix_file.hpp"
#include "orbweaver/core/process.hpp"
#include "orbweaver/systems/plugins.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::drivers {

namespace {

namespace fs = std::filesystem;

struct BuildSystemOptions {
  fs::path source;
  fs::path output;
};

/// A program that has been copied out of its place has none.
void require_headers(const InstalledFiles& at) {
  const fs::path header = at.headers / "orbweaver/systems/plugin.hpp";
  if (!fs::exists(header))
    throw core::EnvironmentError(
        fmt::format("'{}' is not there, which every plugin is compiled with: run the program from where it was built "
                    "or installed, not a copy of it (docs/packaging.md)",
                    header.string()));
}

std::vector<std::string> compiler_words(const InstalledFiles& at) {
  std::vector<std::string> words{plugin_compiler, "-std=c++20", "-O3", "-DNDEBUG", "-DFMT_SHARED", "-Wall", "-Wextra"};
  for (const std::string& flag : plugin_machine_flags)
    if (!flag.empty()) words.push_back(flag);
  // Not /usr/include, where the compiler looks anyhow, and in which order matters to its own headers.
  for (const fs::path& folder : {at.headers, at.models})
    if (!folder.empty() && folder != "/usr/include") words.insert(words.end(), {"-isystem", folder.string()});
  for (const std::string& folder : plugin_packages) words.insert(words.end(), {"-isystem", folder});
  return words;
}

void compile(const std::vector<std::string>& words, const std::string& what) {
  const auto status = core::run_program(words);
  if (!status)
    throw core::EnvironmentError(fmt::format("there is no compiler {}: install it (Debian: g++)", words.front()));
  if (*status != 0)
    throw core::InputError(
        fmt::format("{} does not compile; the compiler's messages are above, and docs/your_own_system.md says what a "
                    "field is made of (sin, not std::sin; smooth functions of the state, no abs, max, if or ?:)",
                    what));
}

/// The source and the files beside it that it includes: what a rule of make lists.
std::vector<fs::path> sources_of(const fs::path& source, std::vector<std::string> words, const fs::path& scratch) {
  const fs::path rule = scratch / "rule.d";
  words.insert(words.end(), {"-MM", source.string(), "-MF", rule.string()});
  compile(words, source.string());
  std::ifstream stream(rule);
  std::vector<fs::path> files;
  std::string word;
  for (stream >> word; stream >> word;)
    if (word != "\\") files.emplace_back(word);
  return files;
}

int run(const BuildSystemOptions& options, const Invocation& invocation) {
  if (!invocation.petsc_options.empty())
    throw core::InputError("build-system takes no PETSc options: drop `--` and what follows");
  core::require_output_file(options.output, options.source);
  const core::TemporaryFolder scratch;
  const fs::path source = options.source;
  if (const std::string got = core::unreadable_input(source); !got.empty())
    throw core::InputError(
        fmt::format("'{}': expected a source that can be read, got {}; check the path", source.string(), got));

  const InstalledFiles at = installed_files();
  require_headers(at);
  const std::vector<std::string> words = compiler_words(at);
  const std::string hash = core::file_hash(sources_of(source, words, scratch.path()));
  core::PartFile unfinished(options.output);
  std::vector<std::string> build = words;
  build.insert(build.end(), {fmt::format("-DORBWEAVER_PLUGIN_SOURCE=\"{}\"", hash),
                             "-DORBWEAVER_PLUGIN_VERSION=\"" ORBWEAVER_VERSION "\"", "-shared", "-fPIC", "-Wl,-z,lazy",
                             source.string(), "-o", unfinished.path().string()});
  const std::string what = source.string();
  core::write_line(stderr, fmt::format("compiling {}", what));
  std::vector<std::string> first = words;
  first.insert(first.end(), {"-DORBWEAVER_ONE_SCALAR", "-fsyntax-only", source.string()});
  compile(first, what);
  compile(build, what);
  const systems::Plugin& plugin = systems::load_plugin(unfinished.path());
  unfinished.publish();
  print_result(fmt::format("{}: {}, source {}\n", options.output.string(), fmt::join(plugin.models, ", "), hash));
  return 0;
}

}  // namespace

Command make_build_system_command(CLI::App& program) {
  const auto options = std::make_shared<BuildSystemOptions>();
  CLI::App* parser = program.add_subcommand("build-system", "Compile a model of your own into a plugin for scenes");
  parser->add_option("SOURCE", options->source, "The model's C++ source (docs/your_own_system.md)")->required();
  parser->add_option("-o,--output", options->output, "The plugin to write")->required()->check(named_path());
  add_examples(*parser, {"orbweaver build-system my_system.cpp -o my_system.so"});
  return {parser, [options](const Invocation& invocation) { return run(*options, invocation); }};
}

}  // namespace orbweaver::drivers
