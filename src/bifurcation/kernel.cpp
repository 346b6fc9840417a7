#include "orbweaver/bifurcation/kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/bifurcation/directions.hpp"
#include "orbweaver/continuation/off_branch.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/spectrum/floquet_vector.hpp"

namespace orbweaver::bifurcation {

namespace {

using continuation::OffBranchTriplet;

Eigen::MatrixXd power_of(const Eigen::MatrixXd& matrix, int exponent) {
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols());
  for (int n = 0; n < exponent; ++n) power = matrix * power;
  return power;
}

/// Involutions of the repeated orbit under which the kernel splits: half a turn of the whole loop, and a reversor.
struct Split {
  loop::Isotropy involutions;
  std::vector<std::vector<int>> signs;  ///< the sectors that the kernel can lie in
};

Split split_of(const loop::SymmetryGroup& group, const Sector& sector, int multiplicity) {
  const int turns = group.order() * multiplicity;  // least shifts in the repeated loop
  Split split;
  split.signs.emplace_back();
  if (turns % 2 == 0) {
    split.involutions.push_back({"half turn", false, power_of(group.generator().matrix, turns / 2), 1, 2});
    // The least shift turns the kernel by 2 pi j/q.
    const double angle = 2.0 * std::numbers::pi * sector.j * (turns / 2) / sector.q;
    split.signs.front().push_back(std::cos(angle) > 0.0 ? 1 : -1);
  }
  if (const loop::SymmetryElement* reversor = group.reversor_at_start()) {
    split.involutions.push_back(*reversor);
    std::vector<int> other = split.signs.front();
    split.signs.front().push_back(1);
    other.push_back(-1);
    split.signs.push_back(std::move(other));
  }
  return split;
}

/// Accuracy of the vectors: starts are corrected from them, and values come out to its square. The solves inside are to
/// be better than that.
constexpr double of_vectors = 1e-6;
constexpr double of_solves = 1e-7;
/// The vector beside the kernel, which shows the gap, may need more harmonics than the kernel: beside a driven
/// oscillator's branch point twice as many were seen to do. A power of two.
constexpr int most_harmonics_times = 4;
/// Below it singular values of a loop's Jacobian are rounding.
constexpr double rounding = 1e-11;

/// The orbit with the harmonics that the kernel's vectors need, which are solutions of the flow linearised about it.
loop::Loop holding_kernel(const systems::System& system, loop::Loop orbit, const loop::Isotropy& isotropy,
                          const Sector& sector, int order, int expected, const KernelOptions& options) {
  spectrum::FloquetVectorOptions vectors;
  vectors.order = order;
  vectors.angle = 2.0 * std::numbers::pi * sector.j / sector.q;
  vectors.count = sector.q <= 2 ? expected : expected / 2;
  vectors.most = options.most_harmonics;
  vectors.team = options.team;
  const int needed = spectrum::floquet_vector_cutoff(system, orbit, isotropy, vectors);
  if (needed > options.most_harmonics)
    throw UndecidedError(
        fmt::format("what leaves there needs {} harmonics a period, more than {}", needed, options.most_harmonics));
  if (needed <= orbit.cutoff) return orbit;
  return loop::with_cutoff(orbit, loop::allowed_cutoff_at_least(needed));
}

/// The place of the largest ratio between neighbours among the first `most` + 1 values.
int dimension_of(const std::vector<double>& values, int most, double largest) {
  int dimension = 0;
  double widest = 0.0;
  for (int n = 1; n <= most && n <= static_cast<int>(values.size()); ++n) {
    const double inside = values[static_cast<std::size_t>(n - 1)];
    if (inside > largest) break;
    const double outside = n < static_cast<int>(values.size()) ? values[static_cast<std::size_t>(n)] : 1.0;
    const double gap = outside / std::max(inside, rounding);
    if (gap > widest) {
      widest = gap;
      dimension = n;
    }
  }
  return dimension;
}

}  // namespace

double Kernel::largest() const {
  return vectors.empty() ? std::numeric_limits<double>::quiet_NaN() : singular_values[vectors.size() - 1];
}

double Kernel::next() const {
  return singular_values.size() > vectors.size() ? singular_values[vectors.size()]
                                                 : std::numeric_limits<double>::quiet_NaN();
}

namespace {

/// The kernel of the orbit with so many times the harmonics that it and the kernel need.
Kernel kernel_with(int times, const systems::System& system, const continuation::CurvePoint& point,
                   const loop::Isotropy& isotropy, const Sector& sector, int expected, const KernelOptions& settings) {
  const loop::SymmetryGroup group(system.structure(), isotropy);
  const int multiplicity = sector.multiplicity(group.order());
  Kernel kernel;
  const auto holding = [&](loop::Loop orbit) {
    const loop::Loop held =
        holding_kernel(system, std::move(orbit), isotropy, sector, group.order(), expected, settings);
    return times == 1 ? held : loop::with_cutoff(held, loop::allowed_cutoff_at_least(times * held.cutoff));
  };
  if (settings.even_in_time || multiplicity > 1) {
    const loop::Loop even = holding(loop::evenly_in_time(point.loop));
    kernel.base = loop::repeated(even, multiplicity);
    kernel.family = loop::repeated(even, loop::with_time_map(point.loop, point.tangent, {}, even.cutoff), multiplicity);
  } else {
    kernel.base = holding(point.loop);
    kernel.family = loop::with_cutoff(point.tangent, kernel.base.cutoff, kernel.base.dimension);
  }
  const Split split = split_of(group, sector, multiplicity);
  spectrum::TripletOptions options;
  options.count = split.signs.size() > 1 && expected > 1 ? expected / 2 + 1 : expected + 1;
  options.nearly_flat = options.count - 1;
  options.tolerance = of_vectors;
  options.inner_tolerance = of_solves;
  options.team = settings.team;
  options.multiple = split.signs.size() == 1 && expected > 1;
  std::vector<OffBranchTriplet> all;
  for (const std::vector<int>& signs : split.signs)
    for (OffBranchTriplet& t :
         continuation::sector_triplets(system, kernel.base, split.involutions, signs, kernel.family, options))
      all.push_back(std::move(t));
  std::stable_sort(all.begin(), all.end(), [](const OffBranchTriplet& a, const OffBranchTriplet& b) {
    return a.singular_value < b.singular_value;
  });
  for (const OffBranchTriplet& t : all) kernel.singular_values.push_back(t.singular_value);
  const int dimension = dimension_of(kernel.singular_values, expected, settings.largest);
  for (int n = 0; n < dimension; ++n) {
    loop::Tangent v{std::move(all[static_cast<std::size_t>(n)].direction.modes), {}};
    v.normalize();
    kernel.vectors.push_back(std::move(v));
  }
  return kernel;
}

}  // namespace

Kernel kernel_of(const systems::System& system, const continuation::CurvePoint& point, const loop::Isotropy& isotropy,
                 const Sector& sector, int expected, const KernelOptions& settings) {
  for (int times = 1;; times *= 2) {
    try {
      return kernel_with(times, system, point, isotropy, sector, expected, settings);
    } catch (const UndecidedError&) {
      throw;
    } catch (const core::NumericalError&) {
      if (times == most_harmonics_times || 2 * times * point.loop.cutoff > settings.most_harmonics) throw;
    }
  }
}

}  // namespace orbweaver::bifurcation
