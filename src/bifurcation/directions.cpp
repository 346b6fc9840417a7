#include "orbweaver/bifurcation/directions.hpp"

#include <algorithm>
#include <complex>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "kernel_actions.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "searched_directions.hpp"
#include "symmetric_directions.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr int largest_kernel = 8;

// A direction less its part along the time shift, which orbits that are found have none of.
loop::Tangent across_time(const loop::Loop& base, loop::Tangent direction) {
  core::require(direction.modes.size() == base.modes.size(),
                "the family's direction needs the size of the base's modes");
  const loss::Unknowns all{loop::Subspace(base.dimension, base.cutoff, {}), {}};
  const std::vector<double> shift = all.tangent_of(all.time_shift_direction(base)).modes;
  double along = 0.0;
  double square = 0.0;
  for (std::size_t n = 0; n < shift.size(); ++n) {
    along += shift[n] * direction.modes[n];
    square += shift[n] * shift[n];
  }
  if (square == 0.0) return direction;
  for (std::size_t n = 0; n < shift.size(); ++n) direction.modes[n] -= along / square * shift[n];
  return direction;
}

}  // namespace

loop::Tangent way_to_side(const loop::Tangent& tangent, const loop::Tangent& opposite, int side) {
  if (side > 0) return tangent;
  loop::Tangent out = opposite.empty() ? tangent : opposite;
  if (opposite.empty()) out *= -1.0;
  return out;
}

Directions directions(const systems::System& system, const loop::Loop& base, const loop::Isotropy& isotropy,
                      const std::vector<loop::Tangent>& kernel, const DirectionOptions& given) {
  loop::validate(base);
  core::require(base.time_map.is_identity(), "directions need a base loop that runs evenly in time");
  core::require(!kernel.empty() && kernel.size() <= largest_kernel, "directions need a kernel of dimension 1 to 8");
  const systems::Structure& structure = system.structure();
  DirectionOptions options = given;
  if (!options.family.empty()) options.family = across_time(base, options.family);
  const KernelActions group(structure, base, kernel, options);
  for (const loop::SymmetryElement& g : isotropy)
    if (std::none_of(group.actions().begin(), group.actions().end(),
                     [&](const Action& a) { return a.element.name == g.name; }))
      throw core::NumericalError(
          fmt::format("the base loop of a kernel does not have the symmetry {} of its orbit to "
                      "{:.2g}, with any phase that its other symmetries allow",
                      g.name, options.symmetry_tolerance));
  SymmetricDirections symmetric = symmetric_directions(system, group, base, options);
  // A single oscillation, a single vector, and a plane with rotations and reflections have no others.
  const bool are_all = kernel.size() == 1 || (kernel.size() == 2 && group.constant()) ||
                       (kernel.size() == 2 && !symmetric.lines.empty() && group.rotations() > 2);
  if (are_all) return {std::move(symmetric.found)};
  Directions out = searched_directions(system, group, base, symmetric.lines, options);
  out.found.insert(out.found.begin(), std::make_move_iterator(symmetric.found.begin()),
                   std::make_move_iterator(symmetric.found.end()));
  return out;
}

Directions equilibrium_directions(const systems::System& system, std::span<const double> point,
                                  const starts::SharedPeriod& shared, int cutoff, const DirectionOptions& options) {
  const loop::Loop base = loop::constant_loop(point, shared.period, cutoff);
  core::require(shared.kernel.rows() == base.dimension, "oscillations need the dimension of the equilibrium");
  core::require(
      shared.harmonics.size() == static_cast<std::size_t>(shared.kernel.cols()) &&
          std::all_of(shared.harmonics.begin(), shared.harmonics.end(), [&](int k) { return k >= 1 && k <= cutoff; }),
      "oscillations need a harmonic each, of the loops' cutoff at most");
  std::vector<loop::Tangent> vectors;
  for (Eigen::Index c = 0; c < shared.kernel.cols(); ++c)
    for (const std::complex<double> phase : {std::complex<double>(1.0, 0.0), std::complex<double>(0.0, 1.0)}) {
      const int harmonic = shared.harmonics[static_cast<std::size_t>(c)];
      loop::Loop v = base;
      std::fill(v.modes.begin(), v.modes.end(), 0.0);
      for (int i = 0; i < v.dimension; ++i) {
        v.cosine(harmonic, i) = (phase * shared.kernel(i, c)).real();
        v.sine(harmonic, i) = -(phase * shared.kernel(i, c)).imag();
      }
      vectors.push_back({v.modes, {}});
    }
  return directions(system, base, {}, vectors, options);
}

}  // namespace orbweaver::bifurcation
