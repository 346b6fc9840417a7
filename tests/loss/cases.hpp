#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "orbweaver/loss/unknowns.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::test {

/// A loop, far from any orbit, with unknowns to move it by.
struct Case {
  std::shared_ptr<const systems::System> system;
  loop::Loop loop;
  loss::Unknowns unknowns;
};

/// Systems, subspaces, windings, with and without the period: each loop lies in the subspace it is moved in.
[[nodiscard]] std::vector<std::string> case_names();
/// `case_names` and sectors that break the loop's symmetry.
[[nodiscard]] std::vector<std::string> all_case_names();
[[nodiscard]] Case make_case(const std::string& name);

/// A random direction of unit length in the unknowns.
[[nodiscard]] Eigen::VectorXd unit_direction(int size, std::uint64_t seed);

/// The linearization at loop + u.
[[nodiscard]] loss::Linearization linearize(const Case& sample, const Eigen::VectorXd& u,
                                            loss::Linearization::Order order);
[[nodiscard]] loss::Linearization linearize(const Case& sample, loss::Linearization::Order order);

[[nodiscard]] inline std::span<const double> view(const Eigen::VectorXd& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
[[nodiscard]] inline Eigen::VectorXd vector_of(const std::vector<double>& v) {
  return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
}

}  // namespace orbweaver::test
