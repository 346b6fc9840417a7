#include "family_means.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "curve_index.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/survey/atlas/stored_orbits.hpp"

namespace orbweaver::survey {

namespace {

/// Half of the box along a coordinate that winds, whose mean hangs on where the orbit begins. Finite, for products with
/// zeros of matrices.
constexpr double anywhere = 1e300;

}  // namespace

const FamilyMeans::Box& FamilyMeans::box_of(int family) const {
  std::optional<Box>& box = _boxes[static_cast<std::size_t>(family)];
  if (!box) box = measured(_tree.families[static_cast<std::size_t>(family)]);
  return *box;
}

FamilyMeans::Box FamilyMeans::measured(const TreeFamily& family) const {
  const auto d = static_cast<Eigen::Index>(_system.dimension());
  Eigen::VectorXd from = Eigen::VectorXd::Constant(d, anywhere);
  Eigen::VectorXd to = -from;
  Eigen::VectorXd last;
  Eigen::VectorXd beyond = Eigen::VectorXd::Zero(d);
  double margin = 0.0;
  double step = 0.0;
  for (std::size_t n = 0; n < family.orbits(); ++n) {
    const loop::Loop orbit = stored_loop(_tree.atlas, family.first_orbit + n, _system);
    const std::vector<double> state = loop::mean_state(orbit);
    const Eigen::VectorXd mean = Eigen::Map<const Eigen::VectorXd>(state.data(), d);
    from = from.cwiseMin(mean);
    to = to.cwiseMax(mean);
    margin = std::max(margin, continuation::same_within(orbit));
    if (n > 0) step = std::max(step, (mean - last).cwiseAbs().maxCoeff());
    last = mean;
    for (Eigen::Index i = 0; i < d; ++i)
      if (orbit.winding[static_cast<std::size_t>(i)] != 0.0) beyond(i) = anywhere;
  }
  return {0.5 * (from + to), 0.5 * (to - from) + beyond.array().max(margin + beyond_segment * step).matrix()};
}

bool FamilyMeans::may_meet(int family, int other) const {
  const Box& a = box_of(family);
  const Box& b = box_of(other);
  const systems::Structure& structure = _system.structure();
  return std::any_of(_symmetries.elements().begin(), _symmetries.elements().end(), [&](const auto& element) {
    const Eigen::VectorXd away = element.map(a.centre) - b.centre;
    const Eigen::VectorXd reach = element.map.matrix.cwiseAbs() * a.half + b.half;
    for (Eigen::Index i = 0; i < away.size(); ++i) {
      const bool is_angle = structure.is_angle(static_cast<std::size_t>(i));
      const double apart = is_angle ? std::remainder(away(i), 2.0 * std::numbers::pi) : away(i);
      if (!(std::abs(apart) <= reach(i))) return false;
    }
    return true;
  });
}

}  // namespace orbweaver::survey
