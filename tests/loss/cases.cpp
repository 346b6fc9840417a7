#include "loss/cases.hpp"

#include <map>
#include <stdexcept>

#include "loop/samples.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::test {

namespace {

std::vector<loss::Scalar> scalars_with(bool period) {
  if (period) return {loss::Scalar::period()};
  return {};
}

Case free_case(const std::string& system, int cutoff, bool period, std::vector<double> winding = {}) {
  auto made = systems::make_system(system);
  loop::Loop loop = random_loop(made->dimension(), cutoff, 61);
  if (!winding.empty()) loop.winding = std::move(winding);
  loop::Subspace all = loop::Subspace::unrestricted(loop.dimension, cutoff);
  return {std::move(made), std::move(loop), {std::move(all), scalars_with(period)}};
}

Case symmetric_case(const std::string& system, const loop::Isotropy& isotropy, const std::vector<double>& mean,
                    bool period, std::vector<int> signs = {}) {
  auto made = systems::make_system(system);
  const loop::Loop base = loop::constant_loop(mean, 4.2, 9);
  loop::Loop loop = random_loop_in(loop::Subspace(4, 9, isotropy), base, 62);
  loop::Subspace sector(4, 9, isotropy, signs);
  return {std::move(made), std::move(loop), {std::move(sector), scalars_with(period)}};
}

loop::Isotropy of_pendulum() {
  const systems::Structure& pendulum = test::structure_of("double_pendulum");
  return {element_of(pendulum, "S", 1, 2), element_of(pendulum, "R")};
}

Case mapped(Case sample, const loop::TimeMap& map) {
  sample.loop.time_map = map;
  return sample;
}

loop::Isotropy of_rotation() { return {element_of(test::structure_of("henon_heiles"), "C", 1, 3)}; }

}  // namespace

std::vector<std::string> case_names() {
  return {"pendulum_free_period",
          "pendulum_free",
          "pendulum_symmetric_period",
          "pendulum_symmetric",
          "pendulum_inverted_period",
          "pendulum_winding_period",
          "henon_free",
          "henon_rotation_period",
          "oscillator_period",
          "pendulum_pulse_period",
          "pendulum_map_period",
          "pendulum_symmetric_pulse_period",
          "pendulum_symmetric_map",
          "henon_rotation_map_period",
          "oscillator_map_period"};
}

std::vector<std::string> all_case_names() {
  std::vector<std::string> names = case_names();
  for (const char* sector : {"pendulum_breaking_mirror", "pendulum_breaking_reversor", "pendulum_breaking_both"})
    names.emplace_back(sector);
  return names;
}

Case make_case(const std::string& name) {
  const std::vector<double> origin(4, 0.0);
  if (name == "pendulum_free_period") return free_case("double_pendulum", 5, true);
  if (name == "pendulum_free") return free_case("double_pendulum", 5, false);
  if (name == "pendulum_symmetric_period") return symmetric_case("double_pendulum", of_pendulum(), origin, true);
  if (name == "pendulum_symmetric") return symmetric_case("double_pendulum", of_pendulum(), origin, false);
  if (name == "pendulum_inverted_period")
    return symmetric_case("double_pendulum", of_pendulum(), {0.0, std::numbers::pi, 0.0, 0.0}, true);
  if (name == "pendulum_winding_period") return free_case("double_pendulum", 5, true, {1.0, -2.0, 0.0, 0.0});
  if (name == "henon_free") return free_case("henon_heiles", 4, false);
  if (name == "henon_rotation_period") return symmetric_case("henon_heiles", of_rotation(), origin, true);
  if (name == "oscillator_period") return free_case("harmonic_oscillator", 3, true);
  if (name == "pendulum_breaking_mirror")
    return symmetric_case("double_pendulum", of_pendulum(), origin, false, {-1, 1});
  if (name == "pendulum_breaking_reversor")
    return symmetric_case("double_pendulum", of_pendulum(), origin, false, {1, -1});
  if (name == "pendulum_breaking_both")
    return symmetric_case("double_pendulum", of_pendulum(), origin, false, {-1, -1});
  if (name == "pendulum_pulse_period")
    return mapped(free_case("double_pendulum", 5, true, {1.0, 0.0, 0.0, 0.0}), {2.5, {}});
  if (name == "pendulum_map_period") return mapped(make_case("pendulum_free_period"), {0.7, {0.2, -0.3, 0.1, 0.1}});
  if (name == "pendulum_symmetric_pulse_period") return mapped(make_case("pendulum_symmetric_period"), {1.8, {}});
  if (name == "pendulum_symmetric_map")
    return mapped(make_case("pendulum_symmetric"), {1.5, {0.0, 0.0, 0.3, 0.0, 0.0, 0.0, -0.1, 0.0}});
  if (name == "henon_rotation_map_period")
    return mapped(make_case("henon_rotation_period"), {1.0, {0.0, 0.0, 0.0, 0.0, 0.3, -0.2}});
  if (name == "oscillator_map_period") return mapped(make_case("oscillator_period"), {0.5, {0.0, 0.2}});
  throw std::invalid_argument("no case " + name);
}

Eigen::VectorXd unit_direction(int size, std::uint64_t seed) {
  return vector_of(random_values(static_cast<std::size_t>(size), seed)).normalized();
}

loss::Linearization linearize(const Case& sample, const Eigen::VectorXd& u, loss::Linearization::Order order) {
  return {*sample.system, sample.unknowns.moved(sample.loop, view(u)), order};
}

loss::Linearization linearize(const Case& sample, loss::Linearization::Order order) {
  return {*sample.system, sample.loop, order};
}

}  // namespace orbweaver::test
