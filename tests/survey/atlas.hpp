#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "archive/sample.hpp"
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/survey/run/survey.hpp"
#include "orbweaver/systems/registry.hpp"
#include "survey/scenes.hpp"

namespace orbweaver::test {

inline survey::Summary run(const core::Communicator& comm, const scene::Scene& scene, const std::string& name) {
  const auto folder = fresh_folder(name + std::to_string(comm.size()), comm.get());
  const auto system = scene::bound_system(scene.system);
  return survey::run_survey(comm, scene, system, folder, {});
}

/// An archive with look-ups by name.
class Atlas : public archive::Archive {
 public:
  using archive::Archive::Archive;

  [[nodiscard]] std::size_t row_of(const std::string& family) const {
    const auto& names = families().texts("name");
    const auto at = std::find(names.begin(), names.end(), family);
    if (at == names.end()) throw std::runtime_error("no family " + family);
    return static_cast<std::size_t>(at - names.begin());
  }
  [[nodiscard]] std::vector<double> column(const char* name, const std::string& family) const {
    const auto first = orbits().reals(name).begin() + families().integers("first_orbit")[row_of(family)];
    return {first, first + families().integers("orbit_count")[row_of(family)]};
  }
  [[nodiscard]] const std::string& end_of(const std::string& family) const {
    return families().texts("end_reason")[row_of(family)];
  }
  /// Of that family, kind and period to 1e-3.
  [[nodiscard]] std::optional<std::size_t> crossing(const std::string& family, const std::string& kind,
                                                    double period) const {
    for (std::size_t row = 0; row < crossings().rows(); ++row)
      if (crossings().integers("family")[row] == static_cast<std::int64_t>(row_of(family)) &&
          crossings().texts("kind")[row] == kind && std::abs(crossings().reals("period")[row] - period) < 1e-3)
        return row;
    return std::nullopt;
  }
  [[nodiscard]] std::vector<std::string> born_at(std::size_t crossing) const {
    std::vector<std::string> names;
    for (std::size_t row = 0; row < families().rows(); ++row)
      if (families().integers("crossing")[row] == static_cast<std::int64_t>(crossing))
        names.push_back(families().texts("name")[row]);
    return names;
  }
};

}  // namespace orbweaver::test
