#include "orbweaver/systems/model/checks.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"

namespace orbweaver::systems {

namespace {

/// The identity's name, in isotropies.
constexpr const char* identity_name = "1";

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

std::vector<Parameter> allowed_parameters(const ModelInfo& info, const std::vector<std::string>& effects) {
  std::vector<Parameter> allowed = info.parameters;
  for (const std::string& name : effects) {
    const Effect* effect = find_named(info.effects, name);
    if (effect == nullptr)
      throw core::InputError(
          fmt::format("system '{}' has no effect '{}'; its effects are: {}", info.name, name, names_of(info.effects)));
    if (std::count(effects.begin(), effects.end(), name) > 1)
      throw core::InputError(
          fmt::format("effect '{}' of system '{}' is asked for twice; name it once", name, info.name));
    allowed.insert(allowed.end(), effect->parameters.begin(), effect->parameters.end());
  }
  return allowed;
}

[[noreturn]] void refuse_parameter(const ModelInfo& info, const std::vector<Parameter>& allowed,
                                   const std::string& name) {
  for (const Effect& effect : info.effects)
    if (find_named(effect.parameters, name) != nullptr)
      throw core::InputError(
          fmt::format("parameter '{}' of system '{}' belongs to the effect '{}', which is not asked for; "
                      "add it to the effects or leave the parameter out",
                      name, info.name, effect.name));
  throw core::InputError(
      fmt::format("system '{}' has no parameter '{}'; its parameters are: {}", info.name, name, names_of(allowed)));
}

void check_value(const ModelInfo& info, const Parameter& parameter, double value) {
  const bool above = parameter.lower_open ? value > parameter.lower : value >= parameter.lower;
  if (std::isfinite(value) && above && value <= parameter.upper) return;
  throw core::InputError(fmt::format("parameter '{}' ({}) of system '{}' must be a finite number with {}; {} came",
                                     parameter.name, parameter.meaning, info.name, range_text(parameter), value));
}

}  // namespace

void check(const Structure& structure, const ModelInfo& info, int dimension, int quantities) {
  const auto d = static_cast<std::size_t>(dimension);
  core::require(structure.dimension == dimension && info.state_names.size() == d && info.winding_names.size() == d,
                "a model, its structure and its names have as many coordinates");
  core::require(static_cast<int>(structure.conserved.size()) <= quantities,
                "a model needs a function for every conserved quantity of its structure");
  for (const int i : structure.angles) {
    core::require(i >= 0 && i < dimension, "an angle is the number of a coordinate");
    if (info.winding_names[static_cast<std::size_t>(i)].empty())
      throw core::MisuseError(
          fmt::format("structure.angles has {}, '{}', whose winding number has no name in info.winding_names: give "
                      "one, or leave it out of the angles",
                      i, info.state_names[static_cast<std::size_t>(i)]));
  }
  core::require(!structure.driven || structure.is_angle(d - 1), "a drive's phase is the last coordinate and an angle");
  std::set<std::string> names{identity_name};
  for (const auto* symmetries : {&structure.equivariances, &structure.reversors})
    for (const Symmetry& s : *symmetries) {
      core::require(s.map.dimension() == dimension, "a symmetry acts on as many coordinates as its model has");
      core::require(!s.name.empty() && names.insert(s.name).second,
                    "symmetries have names, each its own, and none is \"1\", the name of the identity");
    }
}

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

Bound bound_to(const ModelInfo& info, const std::map<std::string, double>& given,
               const std::vector<std::string>& effects, const FamilyScalars& scalars) {
  const std::vector<Parameter> allowed = allowed_parameters(info, effects);
  Bound bound{{}, effects, scalars};
  for (const Parameter& parameter : allowed) bound.parameters[parameter.name] = parameter.standard;
  for (const auto& [name, value] : given) {
    const Parameter* parameter = find_named(allowed, name);
    if (parameter == nullptr) refuse_parameter(info, allowed, name);
    check_value(info, *parameter, value);
    bound.parameters[name] = value;
  }
  for (const std::string& name : scalars.free)
    if (find_named(allowed, name) == nullptr) refuse_parameter(info, allowed, name);
  return bound;
}

}  // namespace orbweaver::systems
