#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "orbweaver/core/log/log.hpp"
#include "orbweaver/scene/scene.hpp"
#include "orbweaver/survey/run/survey.hpp"

namespace orbweaver::drivers {

/// SCENE and --set, as every subcommand that reads a scene has them.
struct SceneOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;

  /// Reads and checks the scene; throws core::InputError.
  [[nodiscard]] scene::Scene load() const { return scene::load(file, overrides); }
};

/// --quiet and --verbose.
struct LogOptions {
  bool quiet = false;
  bool verbose = false;

  [[nodiscard]] core::LogLevel level() const;
};

/// How work under way is shown; `style` as --progress has it.
[[nodiscard]] survey::Display display_of(const LogOptions& log, const std::string& style = "auto");

/// A check for paths: no empty word, which would be the working folder or no file at all.
[[nodiscard]] CLI::Validator named_path();

/// Adds the options to a subcommand; `options` must outlive the parser.
void add_scene_options(CLI::App& parser, SceneOptions& options);
void add_log_options(CLI::App& parser, LogOptions& options);
/// What --help shows behind the options: command lines that do something of use.
void add_examples(CLI::App& parser, const std::vector<std::string>& lines);

}  // namespace orbweaver::drivers
