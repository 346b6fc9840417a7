#include "checks.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::systems {

namespace {

template <class Named>
std::string names_of(const std::vector<Named>& list) {
  std::vector<std::string> names;
  for (const Named& item : list) names.push_back(item.name);
  return joined(names);
}

template <class Named>
const Named* find_named(const std::vector<Named>& list, const std::string& name) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Named& item) { return item.name == name; });
  return found == list.end() ? nullptr : &*found;
}

std::vector<Parameter> allowed_parameters(const Description& description, const std::vector<std::string>& effects) {
  std::vector<Parameter> allowed = description.parameters;
  for (const std::string& name : effects) {
    const Effect* effect = find_named(description.effects, name);
    if (effect == nullptr)
      throw core::InputError(fmt::format("system '{}' has no effect '{}'; its effects are: {}", description.name, name,
                                         names_of(description.effects)));
    if (std::count(effects.begin(), effects.end(), name) > 1)
      throw core::InputError(
          fmt::format("effect '{}' of system '{}' is asked for twice; name it once", name, description.name));
    allowed.insert(allowed.end(), effect->parameters.begin(), effect->parameters.end());
  }
  return allowed;
}

[[noreturn]] void refuse_parameter(const Description& description, const std::vector<Parameter>& allowed,
                                   const std::string& name) {
  for (const Effect& effect : description.effects)
    if (find_named(effect.parameters, name) != nullptr)
      throw core::InputError(
          fmt::format("parameter '{}' of system '{}' belongs to the effect '{}', which is not asked for; "
                      "add it to the effects or leave the parameter out",
                      name, description.name, effect.name));
  throw core::InputError(fmt::format("system '{}' has no parameter '{}'; its parameters are: {}", description.name,
                                     name, names_of(allowed)));
}

void check_value(const Description& description, const Parameter& parameter, double value) {
  const bool above = parameter.lower_open ? value > parameter.lower : value >= parameter.lower;
  if (std::isfinite(value) && above && value <= parameter.upper) return;
  throw core::InputError(fmt::format("parameter '{}' ({}) of system '{}' must be a finite number with {}; {} came",
                                     parameter.name, parameter.meaning, description.name, range_text(parameter),
                                     value));
}

}  // namespace

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += text.empty() ? name : ", " + name;
  return text.empty() ? "none" : text;
}

std::string range_text(const Parameter& parameter) {
  const std::string unit = parameter.unit == "1" ? "" : " " + parameter.unit;
  std::string text = parameter.name;
  if (std::isfinite(parameter.lower))
    text = fmt::format("{} {} {}", parameter.lower, parameter.lower_open ? "<" : "<=", text);
  if (std::isfinite(parameter.upper)) text = fmt::format("{} <= {}", text, parameter.upper);
  return text + unit;
}

std::map<std::string, double> bind_parameters(const Description& description,
                                              const std::map<std::string, double>& given,
                                              const std::vector<std::string>& effects) {
  const std::vector<Parameter> allowed = allowed_parameters(description, effects);
  std::map<std::string, double> bound;
  for (const Parameter& parameter : allowed) bound[parameter.name] = parameter.standard;
  for (const auto& [name, value] : given) {
    const Parameter* parameter = find_named(allowed, name);
    if (parameter == nullptr) refuse_parameter(description, allowed, name);
    check_value(description, *parameter, value);
    bound[name] = value;
  }
  return bound;
}

}  // namespace orbweaver::systems
