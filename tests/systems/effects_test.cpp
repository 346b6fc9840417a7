// Combinations of effects against a Lagrangian written anew, and what each does to the structure.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "orbweaver/systems/field_cost.hpp"
#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/delegating_system.hpp"
#include "support/dual_derivatives.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::effects_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Parameters = std::map<std::string, double>;

double value_of(const Parameters& parameters, const std::string& name) {
  const auto found = parameters.find(name);
  return found == parameters.end() ? 0.0 : found->second;
}

constexpr double degrees = std::numbers::pi / 180.0;

/// Accelerations of N coordinates from L(q, v, phase), phase' = frequency, and forces that no Lagrangian gives:
/// L_vv a = L_q + forces - L_vq v - L_v,phase frequency, all derivatives taken of L itself.
template <int N, class Lagrangian>
Eigen::VectorXd accelerations(const Lagrangian& lagrangian, const std::vector<double>& state, double frequency,
                              const Eigen::VectorXd& forces) {
  constexpr int D = 2 * N + 1;
  std::array<double, D> z{};
  std::copy(state.begin(), state.end(), z.begin());
  const auto as_field = [&]<class S>(const S* at, S* f) {
    f[0] = lagrangian(at);
    for (int i = 1; i < D; ++i) f[i] = S(0.0);
  };
  std::array<double, D> weights{};
  weights[0] = 1.0;
  const auto gradient = ad::value_gradient<D>(lagrangian, z.data()).gradient;
  const auto hessian = ad::second_derivatives<D>(as_field, z.data(), weights.data());
  const auto second = [&](int i, int l) { return hessian[static_cast<std::size_t>(i * D + l)]; };
  Eigen::MatrixXd mass(N, N);
  Eigen::VectorXd force = forces;
  for (int i = 0; i < N; ++i) {
    force(i) += gradient[static_cast<std::size_t>(i)] - second(N + i, 2 * N) * frequency;
    for (int l = 0; l < N; ++l) {
      mass(i, l) = second(N + i, N + l);
      force(i) -= second(N + i, l) * z[static_cast<std::size_t>(N + l)];
    }
  }
  return mass.fullPivLu().solve(force);
}

/// Bobs and rods in the frame at rest: a rod is two points at Gauss's places, which is exact for what is quadratic
/// along it. The pivot moves with the phase.
struct PendulumLagrangian {
  Parameters p;

  template <class S>
  S operator()(const S* z) const {
    using std::cos;
    using std::sin;
    const double l1 = p.at("l1");
    const double l2 = p.at("l2");
    const double direction = value_of(p, "pivot_direction") * degrees;
    const double amplitude = value_of(p, "pivot_amplitude");
    const S away = amplitude * cos(z[4]);
    const S speed = -amplitude * value_of(p, "drive_frequency") * sin(z[4]);
    S sum(0.0);
    // A point at the parts s1 of the inner and s2 of the outer rod.
    const auto add = [&](double mass, double s1, double s2) {
      const S vx = speed * std::sin(direction) + s1 * l1 * cos(z[0]) * z[2] + s2 * l2 * cos(z[1]) * z[3];
      const S vy = speed * std::cos(direction) + s1 * l1 * sin(z[0]) * z[2] + s2 * l2 * sin(z[1]) * z[3];
      const S height = away * std::cos(direction) - s1 * l1 * cos(z[0]) - s2 * l2 * cos(z[1]);
      sum += 0.5 * mass * (vx * vx + vy * vy) - p.at("g") * mass * height;
    };
    add(p.at("m1"), 1.0, 0.0);
    add(p.at("m2"), 1.0, 1.0);
    for (const double sign : {1.0, -1.0}) {
      const double place = 0.5 + sign * 0.5 / std::sqrt(3.0);
      add(0.5 * value_of(p, "rod1"), place, 0.0);
      add(0.5 * value_of(p, "rod2"), 1.0, place);
    }
    const S first = z[0] - value_of(p, "rest1");
    const S second = z[1] - z[0] - value_of(p, "rest2");
    return sum - 0.5 * value_of(p, "spring1") * first * first - 0.5 * value_of(p, "spring2") * second * second;
  }

  /// Of the motors and the friction: the work of a torque at a joint is done on the joint's own angle.
  [[nodiscard]] Eigen::VectorXd forces(const std::vector<double>& z) const {
    const double wave = z.size() > 4 ? std::cos(z[4]) : 0.0;
    const double pivot = value_of(p, "torque1") + value_of(p, "torque1_amplitude") * wave - value_of(p, "c1") * z[2];
    const double joint =
        value_of(p, "torque2") + value_of(p, "torque2_amplitude") * wave - value_of(p, "c2") * (z[3] - z[2]);
    return Eigen::Vector2d(pivot - joint, joint);
  }
};

/// Velocities in the frame at rest, whose turning is that of two bodies on circles under their own attraction.
/// In the plane (N = 2) or in space.
template <int N>
struct RestrictedLagrangian {
  Parameters p;

  [[nodiscard]] double turning() const {
    // Centre to centre: m r n^2 = d/dr of -1/r (1 + (A1 + A2)/(2 r^2)) at r = 1.
    const auto potential = [&]<class S>(const S* r) {
      const S inverse = 1.0 / r[0];
      return -inverse - 0.5 * (value_of(p, "A1") + value_of(p, "A2")) * inverse * inverse * inverse;
    };
    const double one = 1.0;
    return std::sqrt(ad::value_gradient<1>(potential, &one).gradient[0]);
  }

  template <class S>
  S operator()(const S* z) const {
    using std::pow;
    const double n = turning();
    const double mu = p.at("mu");
    const S vx = z[N] - n * z[1];
    const S vy = z[N + 1] + n * z[0];
    const S height = N == 3 ? z[2] : S(0.0);
    const S vz = N == 3 ? z[2 * N - 1] : S(0.0);
    const auto depth = [&](double mass, double place, double flatness, double dark) {
      const S x = z[0] - place;
      const S square = x * x + z[1] * z[1] + height * height;
      const S legendre = 0.5 * (3.0 * height * height / square - 1.0);  // of the sine of the latitude
      return mass * (dark * pow(square, -0.5) - flatness * legendre * pow(square, -1.5));
    };
    return 0.5 * (vx * vx + vy * vy + vz * vz) +
           depth(1.0 - mu, -mu, value_of(p, "A1"), 1.0 - value_of(p, "radiation")) +
           depth(mu, 1.0 - mu, value_of(p, "A2"), 1.0);
  }
  [[nodiscard]] Eigen::VectorXd forces(const std::vector<double>&) const { return Eigen::VectorXd::Zero(N); }
};

struct SpringLagrangian {
  Parameters p;

  template <class S>
  S operator()(const S* z) const {
    using std::cos;
    using std::sqrt;
    const S stretch = sqrt(z[0] * z[0] + z[1] * z[1]) - p.at("length");
    const double direction = value_of(p, "drive_direction") * degrees;
    const S along = std::sin(direction) * z[0] + std::cos(direction) * z[1];
    return 0.5 * p.at("mass") * (z[2] * z[2] + z[3] * z[3]) - 0.5 * p.at("stiffness") * stretch * stretch -
           p.at("mass") * p.at("gravity") * z[1] + value_of(p, "drive_amplitude") * cos(z[4]) * along;
  }
  [[nodiscard]] Eigen::VectorXd forces(const std::vector<double>& z) const {
    return -value_of(p, "damping") * Eigen::Vector2d(z[2], z[3]);
  }
};

struct DuffingLagrangian {
  Parameters p;

  template <class S>
  S operator()(const S* z) const {
    using std::cos;
    const S square = z[0] * z[0];
    return 0.5 * z[1] * z[1] - 0.5 * p.at("alpha") * square - 0.25 * p.at("beta") * square * square +
           value_of(p, "drive_amplitude") * cos(z[2]) * z[0];
  }
  [[nodiscard]] Eigen::VectorXd forces(const std::vector<double>& z) const {
    return Eigen::VectorXd::Constant(1, -value_of(p, "damping") * z[1]);
  }
};

template <int N, class Lagrangian>
void expect_equations_of(const std::string& name) {
  std::mt19937 generator(31);
  for (const std::vector<std::string>& effects : combinations_of(name)) {
    SCOPED_TRACE((Built{name, effects}.title()));
    for (int sample = 0; sample < 50; ++sample) {
      const auto parameters = random_parameters(model_info(name), generator, effects);
      const auto system = make_system(name, parameters, effects);
      const auto z = random_state(*system, generator);
      const Lagrangian lagrangian{parameters};
      const double frequency = value_of(parameters, "drive_frequency");
      const Eigen::VectorXd expected = accelerations<N>(lagrangian, z, frequency, lagrangian.forces(z));
      std::vector<double> f(z.size());
      system->field(1, z.data(), f.data());
      for (std::size_t i = 0; i < N; ++i) {
        EXPECT_EQ(f[i], z[N + i]);
        EXPECT_NEAR(f[N + i], expected(static_cast<Eigen::Index>(i)), 1e-12 * (1.0 + expected.norm()));
      }
      if (system->structure().driven) {
        EXPECT_EQ(f.back(), frequency);
      }
    }
  }
}

TEST(Effects, OfThePendulumFollowFromItsLagrangian) { expect_equations_of<2, PendulumLagrangian>("double_pendulum"); }
TEST(Effects, OfTheRestrictedProblemFollowFromItsLagrangian) {
  expect_equations_of<2, RestrictedLagrangian<2>>("pcr3bp");
}
TEST(Effects, OfTheRestrictedProblemInSpaceFollowFromItsLagrangian) {
  expect_equations_of<3, RestrictedLagrangian<3>>("cr3bp");
}
TEST(Effects, OfTheSpringFollowFromItsLagrangian) { expect_equations_of<2, SpringLagrangian>("swinging_spring"); }
TEST(Effects, OfDuffingsOscillatorFollowFromItsLagrangian) { expect_equations_of<1, DuffingLagrangian>("duffing"); }

/// Energies too, where one is conserved: p . v - L.
TEST(Effects, EnergiesFollowFromTheLagrangian) {
  std::mt19937 generator(32);
  const auto expect_energy = [&]<int N, class Lagrangian>(std::integral_constant<int, N>, const std::string& name,
                                                          const Lagrangian&) {
    for (const std::vector<std::string>& effects : combinations_of(name)) {
      const auto parameters = random_parameters(model_info(name), generator, effects);
      const auto system = make_system(name, parameters, effects);
      if (!system->structure().conservative()) continue;
      SCOPED_TRACE((Built{name, effects}.title()));
      auto z = random_state(*system, generator);
      z.push_back(0.0);
      const auto [value, gradient] = ad::value_gradient<2 * N + 1>(Lagrangian{parameters}, z.data());
      double action = 0.0;
      for (std::size_t i = N; i < 2 * N; ++i) action += gradient[i] * z[i];
      const double scale = 1.0 + std::abs(value) + std::abs(action);
      EXPECT_NEAR(system->action_density({z.data(), 2 * N}), action, 1e-13 * scale);
      EXPECT_NEAR(system->conserved(0, {z.data(), 2 * N}), action - value, 1e-13 * scale);
    }
  };
  constexpr std::integral_constant<int, 2> in_plane;
  constexpr std::integral_constant<int, 3> in_space;
  expect_energy(in_plane, "double_pendulum", PendulumLagrangian{});
  expect_energy(in_plane, "pcr3bp", RestrictedLagrangian<2>{});
  expect_energy(in_space, "cr3bp", RestrictedLagrangian<3>{});
}

// What makes an effect strong; the others (frequencies, directions, rest angles) say how it acts.
const std::vector<std::string> strengths{"rod1",
                                         "rod2",
                                         "spring1",
                                         "spring2",
                                         "c1",
                                         "c2",
                                         "torque1",
                                         "torque1_amplitude",
                                         "torque2",
                                         "torque2_amplitude",
                                         "damping",
                                         "A1",
                                         "pivot_amplitude",
                                         "A2",
                                         "radiation",
                                         "drive_amplitude"};

TEST(Effects, OfNoStrengthLeaveTheIdealField) {
  std::mt19937 generator(33);
  for (const Built& built : all_built()) {
    if (built.effects.empty()) continue;
    SCOPED_TRACE(built.title());
    const ModelInfo& info = model_info(built.name);
    for (int sample = 0; sample < 20; ++sample) {
      const auto ideal_parameters = random_parameters(info, generator);
      auto parameters = ideal_parameters;
      for (const std::string& name : strengths)
        for (const Effect& effect : info.effects)
          if (std::count(built.effects.begin(), built.effects.end(), effect.name) > 0)
            for (const Parameter& parameter : effect.parameters)
              if (parameter.name == name) parameters[name] = 0.0;
      const auto ideal = make_system(built.name, ideal_parameters);
      const auto system = built.with(parameters);
      auto z = random_state(*system, generator);
      std::vector<double> f(z.size());
      std::vector<double> expected(z.size());
      system->field(1, z.data(), f.data());
      ideal->field(1, z.data(), expected.data());
      double size = 1.0;
      for (const double rate : expected) size = std::max(size, std::abs(rate));
      for (int i = 0; i < ideal->dimension(); ++i)
        EXPECT_NEAR(f[static_cast<std::size_t>(i)], expected[static_cast<std::size_t>(i)], 2e-14 * size);
    }
  }
}

std::vector<std::string> names_of(const std::vector<Symmetry>& symmetries) {
  std::vector<std::string> names;
  for (const Symmetry& s : symmetries) names.push_back(s.name);
  return names;
}

double phase_shift(const Symmetry& s) { return s.map.offset(s.map.dimension() - 1); }

TEST(EffectsStructure, ConservativeOnesKeepWhatTheyCan) {
  const auto rods = make_system("double_pendulum", {}, {"rod_inertia"})->structure();
  EXPECT_EQ(rods.family_kind(), FamilyKind::conservative);
  EXPECT_THAT(names_of(rods.equivariances), ElementsAre("S"));
  EXPECT_THAT(names_of(rods.reversors), ElementsAre("R", "RS"));
  EXPECT_THAT(rods.angles, ElementsAre(0, 1));
  const auto straight = make_system("double_pendulum", {}, {"torsion_springs"})->structure();
  EXPECT_THAT(straight.angles, IsEmpty());
  EXPECT_THAT(names_of(straight.equivariances), ElementsAre("S"));
  const auto bent = make_system("double_pendulum", {{"rest2", 0.5}}, {"torsion_springs"})->structure();
  EXPECT_THAT(bent.equivariances, IsEmpty());
  EXPECT_THAT(names_of(bent.reversors), ElementsAre("R"));
  EXPECT_TRUE(bent.symplectic);
}

TEST(EffectsStructure, DampingLeavesNoFamilies) {
  const auto system = make_system("double_pendulum", {}, {"damping"})->structure();
  EXPECT_EQ(system.family_kind(), FamilyKind::none);
  EXPECT_THAT(system.conserved, IsEmpty());
  EXPECT_THAT(system.reversors, IsEmpty());
  EXPECT_THAT(names_of(system.equivariances), ElementsAre("S"));
  EXPECT_FALSE(system.symplectic);
  EXPECT_TRUE(system.dissipative);
  EXPECT_EQ(system.pairs(), 3);
  EXPECT_EQ(make_system("van_der_pol")->structure().family_kind(), FamilyKind::dissipative);
}

TEST(EffectsStructure, ADriveKeepsPairs) {
  const auto system = make_system("double_pendulum", {}, {"pivot_drive"})->structure();
  EXPECT_EQ(system.family_kind(), FamilyKind::driven_undamped);
  EXPECT_EQ(system.dimension, 5);
  EXPECT_EQ(system.pairs(), 2);
  EXPECT_THAT(system.angles, ElementsAre(0, 1, 4));
  EXPECT_THAT(system.conserved, IsEmpty());
  const auto damped = make_system("double_pendulum", {}, {"damping", "pivot_drive"})->structure();
  EXPECT_EQ(damped.family_kind(), FamilyKind::driven_damped);
  EXPECT_EQ(damped.pairs(), 4);
  EXPECT_EQ(make_system("duffing", {}, {"drive"})->structure().pairs(), 1);
}

TEST(EffectsStructure, SymmetriesGoWithThePhase) {
  constexpr double half = std::numbers::pi;
  const auto shaken = [](double direction) {
    return make_system("double_pendulum", {{"pivot_direction", direction}}, {"pivot_drive"})->structure();
  };
  const Structure upright = shaken(0.0);
  ASSERT_THAT(names_of(upright.equivariances), ElementsAre("S"));
  EXPECT_EQ(phase_shift(upright.equivariances.front()), 0.0);
  ASSERT_THAT(names_of(upright.reversors), ElementsAre("R", "RS"));
  EXPECT_EQ(upright.reversors.front().map.matrix(4, 4), -1.0);
  const Structure sideways = shaken(90.0);
  ASSERT_THAT(names_of(sideways.equivariances), ElementsAre("S"));
  EXPECT_EQ(phase_shift(sideways.equivariances.front()), half);
  EXPECT_EQ(phase_shift(sideways.reversors[0]), 0.0);
  EXPECT_EQ(phase_shift(sideways.reversors[1]), half);
  const Structure oblique = shaken(30.0);
  EXPECT_THAT(oblique.equivariances, IsEmpty());
  EXPECT_THAT(names_of(oblique.reversors), ElementsAre("R"));
  const auto turned = [](const Parameters& parameters) {
    return make_system("double_pendulum", parameters, {"joint_torque"})->structure();
  };
  ASSERT_THAT(names_of(turned({}).equivariances), ElementsAre("S"));
  EXPECT_EQ(phase_shift(turned({}).equivariances.front()), half);
  EXPECT_THAT(turned({{"torque2", 0.1}}).equivariances, IsEmpty());
  const std::vector<std::string> all{"rod_inertia", "torsion_springs", "damping", "pivot_drive", "joint_torque"};
  EXPECT_THAT(make_system("double_pendulum", {}, all)->structure().equivariances, IsEmpty());
  EXPECT_THAT(names_of(make_system("double_pendulum", {{"pivot_direction", 90.0}}, all)->structure().equivariances),
              ElementsAre("S"));
}

TEST(EffectsStructure, BodiesChangePlacesWhereTheyAreAlike) {
  const auto names = [](Parameters parameters, const std::vector<std::string>& effects) {
    parameters["mu"] = 0.5;
    return names_of(make_system("pcr3bp", parameters, effects)->structure().reversors);
  };
  EXPECT_THAT(names({}, {}), ElementsAre("R", "RS"));
  EXPECT_THAT(names({}, {"radiation"}), ElementsAre("R"));
  EXPECT_THAT(names({{"A1", 0.01}, {"A2", 0.02}}, {"oblateness"}), ElementsAre("R"));
  EXPECT_THAT(names({{"A1", 0.01}, {"A2", 0.01}}, {"oblateness"}), ElementsAre("R", "RS"));
}

// Where a symmetry holds for single values only, at these values.
TEST(EffectsStructure, HoldsForTheFieldAtSpecialValues) {
  std::mt19937 generator(34);
  const auto expect_held = [&](const std::string& name, const Parameters& parameters,
                               const std::vector<std::string>& effects) {
    const auto system = make_system(name, parameters, effects);
    std::vector<std::vector<double>> states;
    for (int n = 0; n < 20; ++n) states.push_back(random_state(*system, generator));
    const auto errors = identity_errors(*system, states);
    EXPECT_FALSE(errors.empty());
    for (const IdentityError& found : errors) EXPECT_LE(found.error, 1e-13) << name << ": " << found.identity;
  };
  for (const double direction : {0.0, 30.0, 90.0, -45.0}) {
    expect_held("double_pendulum", {{"pivot_direction", direction}}, {"pivot_drive"});
    expect_held("double_pendulum", {{"pivot_direction", direction}}, {"damping", "pivot_drive"});
    expect_held("swinging_spring", {{"drive_direction", direction}}, {"drive"});
    expect_held("double_pendulum", {{"pivot_direction", direction}},
                {"rod_inertia", "torsion_springs", "damping", "pivot_drive", "joint_torque"});
  }
  expect_held("double_pendulum", {}, {"joint_torque"});
  expect_held("double_pendulum", {{"torque1", 0.3}}, {"joint_torque"});
  expect_held("pcr3bp", {{"mu", 0.5}}, {"oblateness"});
  expect_held("pcr3bp", {{"mu", 0.5}}, {"radiation"});
}

TEST(FieldCost, IsATime) {
  const FieldCost cost = field_cost(*make_system("double_pendulum"), {0.0, 0.0, 0.0, 0.0});
  EXPECT_GT(cost.field, 0.1);
  EXPECT_GT(cost.field_and_jacobian, cost.field);
  EXPECT_LT(cost.field_and_jacobian, 1e5);
}

/// Takes a millisecond for its field, as systems of many coordinates do.
class Slow final : public test::DelegatingSystem {
 public:
  using DelegatingSystem::DelegatingSystem;
  void field(std::size_t nodes, const double* z, double* f) const override {
    ++calls;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    DelegatingSystem::field(nodes, z, f);
  }
  mutable int calls = 0;
};

TEST(FieldCost, OfASlowFieldIsToldWithoutALongWait) {
  const Slow slow(make_system("double_pendulum"));
  EXPECT_GT(field_cost(slow, {0.0, 0.0, 0.0, 0.0}).field, 1e3);
  EXPECT_LT(slow.calls, 100);
}

}  // namespace
}  // namespace orbweaver::systems::effects_test
