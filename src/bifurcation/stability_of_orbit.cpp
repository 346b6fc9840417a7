#include "orbweaver/bifurcation/stability_of_orbit.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/bifurcation/crossing.hpp"
#include "orbweaver/bifurcation/sector.hpp"
#include "orbweaver/continuation/left_open.hpp"

namespace orbweaver::bifurcation {

spectrum::Stability stability_of(const systems::System& system, const loop::Loop& orbit, const loop::Isotropy& isotropy,
                                 core::Team* team) {
  spectrum::FloquetOptions options;
  options.team = team;
  spectrum::Stability stability = spectrum::floquet(system, orbit, isotropy, options);
  const double one = Sector{}.value(system.structure().symplectic);
  const auto is_near_one = [&](const auto& value) { return std::abs(value - one) <= zero_at_birth; };
  if (std::none_of(stability.fundamental.begin(), stability.fundamental.end(), is_near_one)) return stability;
  const continuation::LeftOpen open = continuation::left_open_by_rounding(system, orbit, isotropy);
  if (!open.beside) return stability;
  const spectrum::Stability there = spectrum::floquet(system, *open.beside, isotropy, options);
  for (std::size_t n = 0; n < stability.fundamental.size(); ++n)
    if (is_near_one(stability.fundamental[n]))
      stability.fundamental_error[n] += open.times * std::abs(there.fundamental[n] - stability.fundamental[n]);
  return stability;
}

}  // namespace orbweaver::bifurcation
