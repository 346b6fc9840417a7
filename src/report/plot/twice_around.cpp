#include "plot/twice_around.hpp"

#include <limits>

#include "family_row.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"

namespace orbweaver::report {

std::vector<double> eigenvalues_twice_around(const archive::Archive& atlas, std::size_t family) {
  const auto system = survey::scaled_system_of(atlas);
  const int d = system->dimension();
  // The doubled loop half its period later is itself; what leaves it is not.
  const loop::Isotropy once{{"once around", false, systems::AffineMap::identity(d), 1, 2}};
  const std::vector<int> flipped{-1};
  std::vector<double> values;
  const auto [first, count] = orbits_of(atlas, family);
  for (std::size_t orbit = first; orbit < first + count; ++orbit) {
    const loop::Loop twice = loop::repeated(loop::evenly_in_time(survey::stored_loop(atlas, orbit, *system)), 2);
    // Neither the family's own direction nor the time shift is flipped: nothing has to be excluded.
    const loop::Tangent none{std::vector<double>(twice.modes.size(), 0.0), {}};
    double value = std::numeric_limits<double>::quiet_NaN();
    try {
      const auto triplets = continuation::sector_triplets(*system, twice, once, flipped, none, {});
      if (!triplets.empty()) value = 2.0 * triplets.front().singular_value * triplets.front().singular_value;
    } catch (const core::NumericalError&) {  // no value there
    }
    values.push_back(value);
  }
  return values;
}

}  // namespace orbweaver::report
