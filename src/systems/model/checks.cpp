#include "orbweaver/systems/model/checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/text.hpp"
#include "orbweaver/numerics/random.hpp"
#include "structure_error.hpp"

namespace orbweaver::systems {

namespace {

/// The identity's name, in isotropies.
constexpr const char* identity_name = "1";
/// Entries of matrices that turn by a part of a circle are wrong by rounding; what is no symmetry is off by much more.
constexpr double rounding_of_maps = 1e-9;
/// Half the digits: of a gradient's product with the field, against the sum of its terms' sizes.
constexpr double rounding_of_products = 1.5e-8;
constexpr std::uint64_t seed_of_states = 20261125;

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

void check_names(const char* list, const std::vector<std::string>& names, int dimension, const char* what_to_do) {
  if (static_cast<int>(names.size()) != dimension)
    throw StructureError(
        fmt::format("{} has {} names, and the state {} coordinates: {}", list, names.size(), dimension, what_to_do));
}

void check_sizes(const Structure& structure, const ModelInfo& info, int dimension) {
  check_names("info.state_names", info.state_names, dimension, "name each coordinate");
  check_names("info.winding_names", info.winding_names, dimension,
              "name the winding number of each angle, and give the other coordinates \"\"");
  if (structure.dimension != dimension)
    throw StructureError(
        fmt::format("structure.dimension is {}, and the model's dimension {}: write structure.dimension = dimension",
                    structure.dimension, dimension));
}

void check_conserved(const Structure& structure, int quantities) {
  const std::vector<std::string>& names = structure.conserved;
  if (static_cast<int>(names.size()) > quantities)
    throw StructureError(fmt::format(
        "structure.conserved names {} quantities ({}), and the model has functions for {}: set `quantities` "
        "to their number, with a conserved<K> for each, or leave names out",
        names.size(), joined(names), quantities));
  for (std::size_t n = 0; n < names.size(); ++n)
    if (names[n].empty() || std::count(names.begin(), names.end(), names[n]) > 1)
      throw StructureError(
          fmt::format("structure.conserved[{}] is '{}': give each quantity a name of its own", n, names[n]));
}

void check_angles(const Structure& structure, const ModelInfo& info) {
  for (std::size_t n = 0; n < structure.angles.size(); ++n) {
    const int i = structure.angles[n];
    if (i < 0 || i >= structure.dimension)
      throw StructureError(fmt::format("structure.angles[{}] is {}: expected the number of a coordinate, from 0 to {}",
                                       n, i, structure.dimension - 1));
    if (info.winding_names[static_cast<std::size_t>(i)].empty())
      throw StructureError(
          fmt::format("structure.angles has {}, '{}', whose winding number has no name in info.winding_names: give "
                      "one, or leave it out of the angles",
                      i, info.state_names[static_cast<std::size_t>(i)]));
  }
  if (structure.driven && !structure.is_angle(static_cast<std::size_t>(structure.dimension) - 1))
    throw StructureError(
        fmt::format("structure.driven says that the last coordinate, '{}', is the phase of a drive: expected it among "
                    "structure.angles",
                    info.state_names.back()));
}

/// `places`: of the names that are taken, with which item has each.
void check_symmetries(const Structure& structure, bool reversing, std::map<std::string, std::string>& places) {
  const std::vector<Symmetry>& symmetries = reversing ? structure.reversors : structure.equivariances;
  const char* list = reversing ? "reversors" : "equivariances";
  const int dimension = structure.dimension;
  const std::vector<int>& angles = structure.angles;
  for (std::size_t n = 0; n < symmetries.size(); ++n) {
    const auto& [name, map] = symmetries[n];
    const std::string item = fmt::format("structure.{}[{}], '{}'", list, n, name);
    if (name.empty())
      throw StructureError(fmt::format("{}: expected a name, by which isotropies and families are told", item));
    if (const auto [taken, is_new] = places.emplace(name, item); !is_new)
      throw StructureError(
          fmt::format("{}: the name is that of {}; give each symmetry a name of its own", item, taken->second));
    if (map.matrix.rows() != dimension || map.matrix.cols() != dimension)
      throw StructureError(
          fmt::format("{}: its matrix is {} x {}, and the state has {} coordinates: give one of {} x {}", item,
                      map.matrix.rows(), map.matrix.cols(), dimension, dimension, dimension));
    if (map.offset.size() != dimension)
      throw StructureError(fmt::format("{}: its offset has {} entries, and the state {} coordinates", item,
                                       map.offset.size(), dimension));
    const double volume = std::abs(map.matrix.determinant());
    if (!map.offset.allFinite() || !(std::abs(volume - 1.0) < rounding_of_maps))
      throw StructureError(
          fmt::format("{}: done often enough a symmetry is the identity, so that the determinant of its matrix is 1 or "
                      "-1; its modulus is {:.12g}: mend the matrix",
                      item, volume));
    if (!reversing && map.is_same(AffineMap::identity(dimension), angles))
      throw StructureError(fmt::format("{}: it is the identity, which every system has: leave it out", item));
    for (std::size_t other = 0; other < n; ++other)
      if (map.is_same(symmetries[other].map, angles))
        throw StructureError(
            fmt::format("{}: it is the same map as '{}': leave one of them out", item, symmetries[other].name));
  }
}

void check_symplectic(const Structure& structure) {
  if (!structure.symplectic) return;
  const auto refuse = [](const std::string& why) {
    throw StructureError(fmt::format("structure.symplectic is true, {}", why));
  };
  if (structure.dissipative)
    refuse("and so is structure.dissipative: a symplectic flow keeps volumes; set one of them");
  if (!structure.driven && structure.dimension % 2 != 0)
    refuse(
        fmt::format("and the state has {} coordinates: a symplectic form needs an even number of them, beside the "
                    "phase of a drive (structure.driven)",
                    structure.dimension));
  if (!structure.driven && structure.conserved.empty())
    refuse(
        "and structure.conserved is empty: a Hamiltonian field that does not depend on time conserves its energy; "
        "name it there, or set symplectic to false");
}

}  // namespace

void require_description(const ModelInfo& info) {
  constexpr std::size_t longest = 200;
  constexpr std::size_t most_bytes =
      60'000;  // of the 65,535 of an attribute in HDF5's header, the rest for its description
  const auto require = [&](const char* what, const std::string& text, bool may_be_empty = false) {
    if (text.size() > longest || core::printable(text) != text || (text.empty() && !may_be_empty))
      throw core::InputError(fmt::format("its {} `{}`: expected one line of text with 1 to {} characters", what,
                                         core::shortened(core::printable(text), longest), longest));
  };
  const auto require_apart = [&](const char* what, const std::vector<std::string>& names) {
    std::size_t width = sizeof(double);
    for (const std::string& name : names) width = std::max(width, name.size());
    if (names.size() * width > most_bytes)
      throw core::InputError(fmt::format("its {} {} are more than an archive's head holds: expected at most {}",
                                         names.size(), what, most_bytes / width));
    std::set<std::string> known;
    for (const std::string& name : names)
      if (!known.insert(name).second)
        throw core::InputError(fmt::format("two of its {} are named `{}`: expected a name for each", what, name));
  };
  const auto require_parameters = [&](const std::vector<Parameter>& parameters) {
    for (const Parameter& parameter : parameters) {
      require("name of a parameter", parameter.name);
      if (!std::isfinite(parameter.standard))
        throw core::InputError(fmt::format("its parameter `{}` has the standard value {}: expected a finite number",
                                           parameter.name, parameter.standard));
      require("unit of a parameter", parameter.unit, true);
      require("meaning of a parameter", parameter.meaning, true);
    }
  };
  require("name", info.name);
  require("title", info.title, true);
  require("meaning", info.meaning, true);
  for (const std::string& name : info.state_names) require("name of a coordinate", name);
  for (const std::string& name : info.winding_names) require("name of a winding number", name, true);
  require_apart("coordinates", info.state_names);
  require_parameters(info.parameters);
  std::vector<std::string> parameters;
  for (const Parameter& parameter : info.parameters) parameters.push_back(parameter.name);
  require_apart("parameters", parameters);
  for (const Effect& effect : info.effects) {
    require("name of an effect", effect.name);
    require_parameters(effect.parameters);
  }
}

void check(const Structure& structure, const ModelInfo& info, int dimension, int quantities) {
  check_sizes(structure, info, dimension);
  check_conserved(structure, quantities);
  check_angles(structure, info);
  std::map<std::string, std::string> places{{identity_name, "the identity"}};
  check_symmetries(structure, false, places);
  check_symmetries(structure, true, places);
  check_symplectic(structure);
}

void check_without_guards(const Structure& structure) {
  if (!structure.guards.empty())
    throw StructureError(
        fmt::format("structure.guards names '{}', and the model has no function for it: give it `double guard(int k, "
                    "const double* z) const`, or leave the guard out",
                    structure.guards.front().name));
}

void check_without_action_density(const Structure& structure) {
  if (structure.conservative())
    throw StructureError(fmt::format(
        "structure.conserved names '{}', and the model has no action density: give it `template <class S> S "
        "action_density(const S* z) const`, p dq/dt, by which the energy is checked, or NaN where there is "
        "none",
        structure.conserved.front()));
}

namespace {

/// Whether the field keeps the function, as it does no other than a conserved quantity: coordinates have sizes of many
/// decades, so that each of the field's terms is the largest somewhere. A function that is constant tells nothing.
bool keeps(int dimension, int k, const FunctionAt& at) {
  constexpr int states = 64;
  constexpr int enough = 8;  // of them at which all is finite
  constexpr double decades = 12.0;
  numerics::Random random(seed_of_states);
  const auto d = static_cast<std::size_t>(dimension);
  std::vector<double> z(d), f(d), gradient(d);
  int finite = 0;
  bool varies = false;
  for (int n = 0; n < states; ++n) {
    for (double& value : z) value = std::copysign(std::pow(10.0, decades * random()), random());
    at(k, z.data(), f.data(), gradient.data());
    double change = 0.0;
    double size = 0.0;
    for (std::size_t i = 0; i < d; ++i) {
      change += gradient[i] * f[i];
      size += std::abs(gradient[i] * f[i]);
    }
    if (!std::isfinite(size)) continue;
    if (std::abs(change) > rounding_of_products * size) return false;
    ++finite;
    varies = varies || size > 0.0;
  }
  return varies && finite >= enough;
}

}  // namespace

void check_unnamed(const Structure& structure, int quantities, const FunctionAt& at) {
  if (structure.dissipative || structure.driven) return;
  for (int k = static_cast<int>(structure.conserved.size()); k < quantities; ++k) {
    if (!keeps(structure.dimension, k, at)) continue;
    throw StructureError(fmt::format(
        "structure.conserved does not name conserved<{}>, which the field keeps: name it there{}, or set `quantities` "
        "to {}; or set structure.dissipative to true if it is kept at these values of the parameters only",
        k,
        k == 0 ? R"(, structure.conserved = {"energy"}, and set structure.symplectic to true if the system is )"
                 "Hamiltonian"
               : "",
        k));
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
