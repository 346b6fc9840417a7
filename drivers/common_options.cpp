#include "common_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "orbweaver/core/terminal.hpp"

namespace orbweaver::drivers {

core::LogLevel LogOptions::level() const {
  if (quiet) return core::LogLevel::error;
  return verbose ? core::LogLevel::debug : core::LogLevel::info;
}

survey::Display display_of(const LogOptions& log, const std::string& style) {
  if (log.quiet) return survey::Display::none;
  if (style == "auto") return core::terminal_of(STDERR_FILENO).redraws ? survey::Display::live : survey::Display::lines;
  return style == "live" ? survey::Display::live : survey::Display::lines;
}

CLI::Validator named_path() {
  return {[](const std::string& path) { return path.empty() ? std::string("expected a path, got nothing") : ""; }, "",
          "named_path"};
}

void add_scene_options(CLI::App& parser, SceneOptions& options) {
  parser.add_option("scene", options.file, "The scene file (YAML)")->required()->type_name("SCENE");
  parser.add_option("--set", options.overrides, "Override a key of the scene: --set limits.period=20 (repeatable)")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->take_all();
}

void add_log_options(CLI::App& parser, LogOptions& options) {
  CLI::Option* quiet = parser.add_flag("-q,--quiet", options.quiet, "Say errors only");
  parser.add_flag("-v,--verbose", options.verbose, "Say more, from every rank")->excludes(quiet);
}

void add_examples(CLI::App& parser, const std::vector<std::string>& lines) {
  const std::string before = parser.get_footer();
  parser.footer(fmt::format("{}{}:\n  {}", before.empty() ? "" : before + "\n\n",
                            lines.size() == 1 ? "Example" : "Examples", fmt::join(lines, "\n  ")));
}

}  // namespace orbweaver::drivers
