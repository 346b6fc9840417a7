#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/document/document.hpp"
#include "orbweaver/systems/text/system_of.hpp"

namespace orbweaver::test {

[[nodiscard]] inline systems::ModelText read_model_text(const std::string& text) {
  const document::Source source("model.yaml", {});
  return systems::read_model(document::Field(source, document::parse_document(text, "model.yaml", true), "", 1));
}

/// The system that a text stands for, with standard values where none are given.
[[nodiscard]] inline std::shared_ptr<const systems::System> text_system(
    const std::string& text, const std::vector<std::string>& effects = {},
    const std::map<std::string, double>& values = {}, const systems::FamilyScalars& scalars = {}) {
  const systems::BuiltModel built = systems::build_model(read_model_text(text), values, effects);
  systems::Bound bound{{}, effects, scalars};
  for (const systems::Parameter& parameter : built.info.parameters)
    bound.parameters[parameter.name] = parameter.standard;
  for (const systems::Effect& effect : built.info.effects)
    for (const systems::Parameter& parameter : effect.parameters) bound.parameters[parameter.name] = parameter.standard;
  for (const auto& [name, value] : values) bound.parameters[name] = value;
  return systems::system_of(built, bound);
}

}  // namespace orbweaver::test
