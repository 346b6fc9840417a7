#include "floquet_group.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::spectrum {

namespace {

/// Of matrices, phases and unit gradients that are equal to some roundings.
constexpr double same = 1e-9;
/// Of gradients at an orbit's state and its image, relative to them: the state is on the orbit to 1e-10, while a map
/// that changes a sign is off by 2.
constexpr double same_gradient = 1e-6;
/// Values of s at which time maps are compared: seven over a period, at no regular fraction of it, which tells maps of
/// different symmetry apart unless all of them agree.
constexpr double first_place = 0.3;
constexpr double last_place = 6.0;
constexpr double between_places = 0.9;

/// Floquet multipliers need the gradients of conserved quantities carried along: no element that changes a sign.
bool keeps_conserved(const systems::System& system, const std::vector<double>& state, const systems::AffineMap& map) {
  const Eigen::VectorXd z = Eigen::Map<const Eigen::VectorXd>(state.data(), static_cast<Eigen::Index>(state.size()));
  const Eigen::VectorXd image = map(z);
  Eigen::VectorXd here(z.size());
  Eigen::VectorXd there(z.size());
  const std::size_t d = state.size();
  for (int k = 0; k < static_cast<int>(system.structure().conserved.size()); ++k) {
    system.conserved_gradient(k, state, {here.data(), d});
    system.conserved_gradient(k, {image.data(), d}, {there.data(), d});
    if (!((map.matrix.transpose() * there - here).norm() <= same_gradient * here.norm())) return false;
  }
  return true;
}

/// Whether nodes equidistant in s stay such nodes under the element: the time map must share its symmetry.
bool keeps_nodes(const loop::TimeMap& map, const loop::SymmetryElement& element) {
  if (map.is_identity()) return true;
  const double shift = 2.0 * std::numbers::pi * element.shift_numerator / element.shift_denominator;
  const double sign = element.reversing ? -1.0 : 1.0;
  for (double s = first_place; s < last_place; s += between_places)
    if (std::abs(map.phase(shift + sign * s) - shift - sign * map.phase(s)) > same) return false;
  return true;
}

Eigen::MatrixXd power(const Eigen::MatrixXd& matrix, int exponent) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols());
  for (int n = 0; n < exponent; ++n) result = matrix * result;
  return result;
}

}  // namespace

FundamentalGroup fundamental_group(const systems::System& system, const loop::Loop& loop,
                                   const loop::Isotropy& isotropy) {
  const std::vector<double> state = loop::state_at(loop, 0.0);
  const loop::SymmetryGroup group =
      loop::SymmetryGroup(system.structure(), isotropy).subgroup([&](const loop::SymmetryElement& element) {
        return keeps_nodes(loop.time_map, element) &&
               (element.reversing || keeps_conserved(system, state, element.map));
      });
  FundamentalGroup result;
  result.order = group.order();
  result.generator = group.generator().matrix;
  result.inverse = result.generator.inverse();
  result.around = power(result.generator, result.order);
  if (group.reversor() != nullptr) result.reversor = *group.reversor();
  result.grid_factor = std::lcm(result.order, result.reversor ? result.reversor->shift_denominator : 1);
  return result;
}

}  // namespace orbweaver::spectrum
