#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "command.hpp"
#include "common_options.hpp"
#include "failure.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/styled.hpp"
#include "orbweaver/systems/registry.hpp"
#include "pager.hpp"
#include "result_stream.hpp"
#include "shipped_scenes.hpp"
#include "structure_text.hpp"

namespace orbweaver::drivers {

namespace {

struct SystemsOptions {
  std::string name;
  bool text = false;
};

std::string range_text(const systems::Parameter& parameter) {
  std::string text = parameter.name;
  if (std::isfinite(parameter.lower))
    text = fmt::format("{} {} {}", parameter.lower, parameter.lower_open ? "<" : "<=", text);
  if (std::isfinite(parameter.upper)) text = fmt::format("{} <= {}", text, parameter.upper);
  return text == parameter.name ? "any" : text;
}

std::string parameters_text(const std::vector<systems::Parameter>& parameters, const std::string& indent) {
  std::string text;
  for (const systems::Parameter& parameter : parameters)
    text += fmt::format("{}{}; {}\n", indent, parameter_text(parameter, parameter.standard), range_text(parameter));
  return text;
}

std::string scenes_text(const std::string& system, const std::vector<ShippedScene>& scenes) {
  std::string text;
  for (const ShippedScene& scene : scenes) {
    if (scene.system != system) continue;
    if (text.empty()) text = fmt::format("  scenes, in {}\n", scene.file.parent_path().string());
    text += fmt::format("    {}: {}\n", scene.file.filename().string(), scene.title);
  }
  return text.empty() ? "  scenes        none\n" : text;
}

std::string effects_text(const systems::ModelInfo& info) {
  if (info.effects.empty()) return "  effects       none\n";
  std::string text = "  effects\n";
  for (const systems::Effect& effect : info.effects)
    text += fmt::format("    {}: {}\n{}", effect.name, effect.meaning, parameters_text(effect.parameters, "      "));
  return text;
}

std::string system_text(const std::string& name, const std::vector<ShippedScene>& scenes) {
  const systems::ModelInfo& info = systems::model_info(name);
  const auto ideal = systems::make_system(name);
  std::string text = fmt::format("{}: {}\n  {}\n  coordinates   {}\n", name, info.title, info.meaning,
                                 fmt::join(info.state_names, ", "));
  for (const auto& [label, line] : structure_lines(info, ideal->structure(), family_kind_text(ideal->structure())))
    text += fmt::format("  {:<14}{}\n", label, line);
  text += info.parameters.empty()
              ? "  parameters    none\n"
              : "  parameters, with their standard values and ranges\n" + parameters_text(info.parameters, "    ");
  return text + effects_text(info) + scenes_text(name, scenes);
}

int run(const SystemsOptions& options, const Invocation& invocation) {
  if (!invocation.petsc_options.empty())
    throw core::InputError(
        fmt::format("systems: expected no PETSc options, got `{}`; it follows no family, so drop `--` and what follows",
                    fmt::join(invocation.petsc_options, " ")));
  if (options.text) {
    if (options.name.empty()) throw core::InputError("systems --text: expected one system, `systems NAME --text`");
    print_result(systems::system_text(options.name));
    return 0;
  }
  const std::vector<std::string> names =
      options.name.empty() ? systems::system_names() : std::vector<std::string>{options.name};
  const std::vector<ShippedScene> scenes = shipped_scenes();
  std::vector<std::string> texts;
  for (const std::string& name : names) texts.push_back(system_text(name, scenes));
  const Pager pager;
  ResultStream out(pager.terminal());
  for (std::size_t n = 0; n < texts.size(); ++n) {
    const std::size_t end = texts[n].find('\n');
    out << (n == 0 ? "" : "\n") << core::Styled{core::Style::heading, texts[n].substr(0, end)} << texts[n].substr(end);
  }
  out.finish();
  return 0;
}

}  // namespace

Command make_systems_command(CLI::App& program) {
  const auto options = std::make_shared<SystemsOptions>();
  CLI::App* parser =
      program.add_subcommand("systems", "Systems, their parameters with units, their effects, and scenes of them");
  parser->add_option("name", options->name, "One system; none: all")->type_name("SYSTEM");
  parser->add_flag("--text", options->text, "The text of one system, to read and to begin one's own with");
  add_examples(*parser, {"orbweaver systems double_pendulum", "orbweaver systems lorenz --text"});
  return {parser, [options](const Invocation& invocation) { return run(*options, invocation); }};
}

}  // namespace orbweaver::drivers
