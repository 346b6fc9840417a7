#include "orbweaver/systems/registry.hpp"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "checks.hpp"
#include "orbweaver/core/error.hpp"
#include "registered.hpp"

namespace orbweaver::systems {

struct RegistryLine {
  const ModelInfo& (*info)();
  const std::vector<std::string>& (*effects)();
  std::shared_ptr<const System> (*make)(const Bound& bound);
};

template <class Model>
constexpr RegistryLine line{&Registered<Model>::info, &Registered<Model>::effects, &Registered<Model>::make};

// Models that have effects, which are defined in files of their own.
template <class... Effects>
class DoublePendulum;
template <class... Effects>
class Duffing;
template <class... Effects>
class Pcr3bp;
template <class... Effects>
class SwingingSpring;
template <int coordinates>
class Damping;
template <int coordinates>
class Drive;

// One line a system and combination of its effects, the ideal one first; `class` declares what is defined in a file of
// its own. Each combination is instantiated in the model's source or in combinations/.
constexpr std::array registry{
    line<DoublePendulum<>>,
    line<DoublePendulum<class RodInertia>>,
    line<DoublePendulum<class TorsionSprings>>,
    line<DoublePendulum<class JointDamping>>,
    line<DoublePendulum<class PivotDrive>>,
    line<DoublePendulum<class JointTorque>>,
    line<DoublePendulum<JointDamping, PivotDrive>>,
    line<DoublePendulum<JointDamping, JointTorque>>,
    line<DoublePendulum<RodInertia, TorsionSprings, JointDamping, PivotDrive, JointTorque>>,
    line<Duffing<>>,
    line<Duffing<Damping<1>>>,
    line<Duffing<Drive<1>>>,
    line<Duffing<Damping<1>, Drive<1>>>,
    line<class HarmonicOscillator>,
    line<class HenonHeiles>,
    line<class Lorenz>,
    line<Pcr3bp<>>,
    line<Pcr3bp<class Radiation>>,
    line<Pcr3bp<class Oblateness>>,
    line<Pcr3bp<Radiation, Oblateness>>,
    line<SwingingSpring<>>,
    line<SwingingSpring<Damping<2>>>,
    line<SwingingSpring<Drive<2>>>,
    line<SwingingSpring<Damping<2>, Drive<2>>>,
    line<class VanDerPol>,
};

namespace {

const RegistryLine& find_line(const std::string& name) {
  const auto found = std::find_if(registry.begin(), registry.end(),
                                  [&](const RegistryLine& candidate) { return candidate.info().name == name; });
  if (found == registry.end())
    throw core::InputError(fmt::format("there is no system '{}'; the systems are: {}", name, joined(system_names())));
  return *found;
}

[[noreturn]] void refuse_combination(const std::string& name, const std::vector<std::string>& effects) {
  std::vector<std::string> texts;
  for (const std::vector<std::string>& built : built_effects(name)) texts.push_back(fmt::format("[{}]", joined(built)));
  throw core::InputError(fmt::format(
      "system '{}' is not compiled with the effects [{}] together; it is with one of {}: choose one of these, or add "
      "the combination as docs/architecture.md says, \"Where to add\"",
      name, joined(effects), joined(texts)));
}

}  // namespace

std::vector<std::string> system_names() {
  std::vector<std::string> names;
  for (const RegistryLine& candidate : registry)
    if (candidate.effects().empty()) names.push_back(candidate.info().name);
  return names;
}

const ModelInfo& model_info(const std::string& name) { return find_line(name).info(); }

std::vector<std::vector<std::string>> built_effects(const std::string& name) {
  const ModelInfo& ideal = model_info(name);
  std::vector<std::vector<std::string>> combinations;
  for (const RegistryLine& candidate : registry)
    if (candidate.info().name == ideal.name) combinations.push_back(candidate.effects());
  return combinations;
}

std::shared_ptr<const System> make_system(const std::string& name, const std::map<std::string, double>& parameters,
                                          const std::vector<std::string>& effects, const FamilyScalars& scalars) {
  const Bound bound = bound_to(model_info(name), parameters, effects, scalars);
  const std::set<std::string> asked(effects.begin(), effects.end());
  for (const RegistryLine& candidate : registry) {
    if (candidate.info().name != name) continue;
    const std::vector<std::string>& has = candidate.effects();
    if (std::set(has.begin(), has.end()) == asked) return candidate.make(bound);
  }
  refuse_combination(name, effects);
}

}  // namespace orbweaver::systems
