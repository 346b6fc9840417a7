#include "orbweaver/systems/registry.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "checks.hpp"
#include "orbweaver/core/error.hpp"
#include "registered.hpp"

namespace orbweaver::systems {

struct RegistryLine {
  const ModelInfo& (*info)();
  std::shared_ptr<const System> (*make)(const Bound& bound);
};

template <class Model>
constexpr RegistryLine line{&Registered<Model>::info, &Registered<Model>::make};

// One line a system; `class` declares the model, which is defined in its own file.
constexpr std::array registry{
    line<class DoublePendulum>,
    line<class HarmonicOscillator>,
    line<class HenonHeiles>,
    line<class Pcr3bp>,
    line<class SwingingSpring>,
};

namespace {

const RegistryLine& find_line(const std::string& name) {
  const auto found = std::find_if(registry.begin(), registry.end(),
                                  [&](const RegistryLine& candidate) { return candidate.info().name == name; });
  if (found == registry.end())
    throw core::InputError(fmt::format("there is no system '{}'; the systems are: {}", name, joined(system_names())));
  return *found;
}

}  // namespace

std::vector<std::string> system_names() {
  std::vector<std::string> names;
  for (const RegistryLine& candidate : registry) names.push_back(candidate.info().name);
  return names;
}

const ModelInfo& model_info(const std::string& name) { return find_line(name).info(); }

std::shared_ptr<const System> make_system(const std::string& name, const std::map<std::string, double>& parameters,
                                          const std::vector<std::string>& effects, const FamilyKind& kind) {
  const RegistryLine& found = find_line(name);
  return found.make(bound_to(found.info(), parameters, effects, kind));
}

}  // namespace orbweaver::systems
