#include "orbweaver/systems/scaled_system.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/quad_system.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::systems::scaled_system_test {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;

/// The pendulum with lengths in units 4 times, times in units 8 times, masses in units 2^-5 times as large, told in
/// scales that undo this.
const std::map<std::string, double> other_units{
    {"m1", 0x1p-5}, {"m2", 0x1p-5}, {"l1", 4.0}, {"l2", 4.0}, {"g", 0x1p-4}};
const Scales undone{8.0, {1.0, 1.0, 0.125, 0.125}, {0x1p-5 * 16.0 / 64.0}, {}};

struct BothPendulums {
  std::shared_ptr<const System> plain = make_system("double_pendulum");
  std::shared_ptr<const System> told = scaled(make_system("double_pendulum", other_units), undone);
  std::vector<double> states{0.3, -1.2, 2.9, 0.1, 0.7, -0.4, 1.9, -0.2, 0.6, 0.9, -0.5, 1.1};  // 3 nodes
};

TEST(ScaledSystem, HasTheBitsOfTheSystemInItsOwnUnits) {
  const BothPendulums both;
  constexpr std::size_t nodes = 3;
  std::vector<double> f(12), g(12), a(48), b(48);
  both.plain->field_jacobian(nodes, both.states.data(), f.data(), a.data());
  both.told->field_jacobian(nodes, both.states.data(), g.data(), b.data());
  EXPECT_THAT(g, ElementsAreArray(f));
  EXPECT_THAT(b, ElementsAreArray(a));
  both.told->field(nodes, both.states.data(), g.data());
  EXPECT_THAT(g, ElementsAreArray(f));
  both.plain->second_derivatives(nodes, both.states.data(), f.data(), a.data());
  both.told->second_derivatives(nodes, both.states.data(), f.data(), b.data());
  EXPECT_THAT(b, ElementsAreArray(a));
  both.plain->conserved_gradients(0, nodes, both.states.data(), f.data());
  both.told->conserved_gradients(0, nodes, both.states.data(), g.data());
  EXPECT_THAT(g, ElementsAreArray(f));
  const std::vector<double> state{0.3, -1.2, 0.7, 0.9};
  EXPECT_EQ(both.told->conserved(0, state), both.plain->conserved(0, state));
  EXPECT_EQ(both.told->action_density(state), both.plain->action_density(state));
  std::vector<double> gradient(4), other(4);
  both.plain->conserved_gradient(0, state, gradient);
  both.told->conserved_gradient(0, state, other);
  EXPECT_THAT(other, ElementsAreArray(gradient));
}

TEST(ScaledSystem, HasQuadruplePrecisionToo) {
  const BothPendulums both;
  numerics::QuadVector z(4);
  z << 0.3, -1.2, 0.7, 0.9;
  numerics::QuadVector f, g;
  numerics::QuadMatrix a, b;
  dynamic_cast<const QuadSystem&>(*both.plain).linearize(z, f, a);
  dynamic_cast<const QuadSystem&>(*both.told).linearize(z, g, b);
  EXPECT_TRUE(f == g);
  EXPECT_TRUE(a == b);
}

TEST(ScaledSystem, MovesParametersInTheSystemsUnits) {
  const BothPendulums both;
  std::vector<double> by_plain(4), by_told(4);
  const std::vector<double> state{0.3, -1.2, 0.7, 0.9};
  both.plain->parameter_derivatives("g", 1, state.data(), by_plain.data());
  both.told->parameter_derivatives("g", 1, state.data(), by_told.data());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(by_told[i], by_plain[i] * 16.0);  // g = 1 is told as 1/16
  const auto stronger = both.told->with_parameters({{"g", 0x1p-3}});
  EXPECT_EQ(stronger->scales(), undone);
  std::vector<double> f(4), g(4);
  both.plain->with_parameters({{"g", 2.0}})->field(1, state.data(), f.data());
  stronger->field(1, state.data(), g.data());
  EXPECT_THAT(g, ElementsAreArray(f));
}

TEST(ScaledSystem, IsTheSystemWhereScalesAreOne) {
  const auto plain = make_system("double_pendulum");
  EXPECT_EQ(scaled(plain, {}), plain);
  EXPECT_EQ(scaled(plain, {1.0, {1.0, 1.0, 1.0, 1.0}, {1.0}, {}}), plain);
  EXPECT_TRUE(plain->scales().are_one());
}

TEST(ScaledSystem, KeepsGuardsInTheSystemsUnits) {
  const auto spring = scaled(make_system("swinging_spring"), {2.0, {0.5, 0.5, 0.25, 0.25}, {0.25}, {}});
  EXPECT_EQ(spring->guard(0, std::vector<double>{6.0, 8.0, 0.0, 0.0}), 5.0);
}

TEST(ScaledSystem, APhaseHasTheScaleOne) {
  const auto plain = make_system("swinging_spring", {{"drive_direction", 90.0}}, {"drive"});
  EXPECT_THROW(static_cast<void>(scaled(plain, {2.0, {1.0, 1.0, 1.0, 1.0, 2.0}, {}, {}})), core::MisuseError);
  const auto told = scaled(plain, {2.0, {0.5, 0.5, 0.25, 0.25, 1.0}, {}, {}});
  const auto offset = told->structure().equivariances.front().map.offset;
  EXPECT_EQ(offset(4), plain->structure().equivariances.front().map.offset(4));
  EXPECT_NE(offset(4), 0.0);
  const std::vector<double> state{0.6, -2.4, 0.7, 0.9, 0.4};
  const std::vector<double> in_units{0.3, -1.2, 0.175, 0.225, 0.4};
  std::vector<double> f(5), g(5);
  plain->field(1, in_units.data(), f.data());
  told->field(1, state.data(), g.data());
  const std::vector<double> rates{4.0, 4.0, 8.0, 8.0, 2.0};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(g[i], rates[i] * f[i]);
}

TEST(ScaledSystem, RefusesScalesThatMeanNothing) {
  const auto pendulum = make_system("double_pendulum");
  const Scales of_an_angle{1.0, {2.0, 1.0, 1.0, 1.0}, {1.0}, {}};
  EXPECT_THROW(static_cast<void>(scaled(pendulum, of_an_angle)), core::MisuseError);
  EXPECT_THROW(static_cast<void>(scaled(pendulum, {1.0, {1.0, 1.0}, {}, {}})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(scaled(pendulum, {0.0, {}, {}, {}})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(scaled(pendulum, {1.0, {}, {1.0, 1.0}, {}})), core::MisuseError);
  EXPECT_THROW(static_cast<void>(scaled(scaled(pendulum, undone), undone)), core::MisuseError);
  const auto star = make_system("henon_heiles");  // turns mix x with y
  EXPECT_THROW(static_cast<void>(scaled(star, {1.0, {1.0, 2.0, 1.0, 1.0}, {}, {}})), core::MisuseError);
  EXPECT_THAT(mixed_coordinates(star->structure()), ElementsAre(0, 0, 2, 2));
  EXPECT_THAT(mixed_coordinates(pendulum->structure()), ElementsAre(0, 1, 2, 3));
}

}  // namespace
}  // namespace orbweaver::systems::scaled_system_test
