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
#include "orbweaver/systems/registry.hpp"
#include "structure_text.hpp"

namespace orbweaver::drivers {

namespace {

struct SystemsOptions {
  std::string name;
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

std::string system_text(const std::string& name) {
  const systems::ModelInfo& info = systems::model_info(name);
  const auto ideal = systems::make_system(name);
  std::string text = fmt::format("{}: {}\n  {}\n  coordinates   {}\n", name, info.title, info.meaning,
                                 fmt::join(info.state_names, ", "));
  for (const auto& [label, line] : structure_lines(info, ideal->structure(), family_kind_text(ideal->structure())))
    text += fmt::format("  {:<14}{}\n", label, line);
  text += info.parameters.empty()
              ? "  parameters    none\n"
              : "  parameters, with their standard values and ranges\n" + parameters_text(info.parameters, "    ");
  if (info.effects.empty()) return text + "  effects       none\n";
  text += "  effects\n";
  for (const systems::Effect& effect : info.effects)
    text += fmt::format("    {}: {}\n{}", effect.name, effect.meaning, parameters_text(effect.parameters, "      "));
  std::vector<std::string> combinations;
  for (const std::vector<std::string>& effects : systems::built_effects(name))
    if (!effects.empty()) combinations.push_back(fmt::format("[{}]", fmt::join(effects, ", ")));
  return text + fmt::format("  compiled with {}\n", fmt::join(combinations, ", "));
}

int run(const SystemsOptions& options, const Invocation& invocation) {
  if (!invocation.petsc_options.empty())
    throw core::InputError(
        fmt::format("systems: expected no PETSc options, got `{}`; it follows no family, so drop `--` and what follows",
                    fmt::join(invocation.petsc_options, " ")));
  std::string text;
  if (!options.name.empty()) {
    text = system_text(options.name);
  } else {
    for (const std::string& name : systems::system_names()) text += (text.empty() ? "" : "\n") + system_text(name);
  }
  print_result(text);
  return 0;
}

}  // namespace

Command make_systems_command(CLI::App& program) {
  const auto options = std::make_shared<SystemsOptions>();
  CLI::App* parser = program.add_subcommand("systems", "Systems, their parameters with units, and their effects");
  parser->add_option("name", options->name, "One system; none: all")->type_name("SYSTEM");
  add_plugin_option(*parser);
  add_examples(*parser, {"orbweaver systems double_pendulum"});
  return {parser, [options](const Invocation& invocation) { return run(*options, invocation); }};
}

}  // namespace orbweaver::drivers
