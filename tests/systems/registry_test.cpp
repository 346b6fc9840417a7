#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/model/checks.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::registry_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A model with ranges of every kind.
ModelInfo driven_pendulum() {
  ModelInfo info;
  info.name = "driven_pendulum";
  info.state_names = {"th", "w"};
  info.parameters = {{"l", 1.0, 0.0, infinity, true, "m", "length"},
                     {"detuning", 0.0, -1.0, 1.0, false, "1", "offset"}};
  info.effects = {{"friction", "drag at the pivot", {{"c", 0.1, 0.0, 2.0, false, "1/s", "damping rate"}}},
                  {"drive", "a periodic torque", {{"a", 0.5, 0.0, infinity, false, "N m", "amplitude"}}}};
  return info;
}

TEST(Registry, KnowsItsSystemsByTheirNames) {
  const std::vector<std::string> names = system_names();
  EXPECT_THAT(names, testing::IsSupersetOf({"double_pendulum", "harmonic_oscillator", "henon_heiles", "pcr3bp"}));
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string& name : names) {
    EXPECT_EQ(model_info(name).name, name);
    EXPECT_EQ(make_system(name)->info().state_names, model_info(name).state_names);
  }
}

TEST(Registry, WhatSystemsSayIsConsistent) {
  for (const Built& built : all_built()) {
    SCOPED_TRACE(built.title());
    const auto system = built.with();
    const ModelInfo& info = system->info();
    const Structure& structure = system->structure();
    EXPECT_FALSE(info.title.empty());
    EXPECT_FALSE(info.meaning.empty());
    for (const Effect& effect : info.effects) {
      EXPECT_FALSE(effect.meaning.empty());
      EXPECT_FALSE(effect.parameters.empty());
    }
    EXPECT_GT(structure.dimension, 0);
    EXPECT_EQ(std::set<std::string>(info.state_names.begin(), info.state_names.end()).size(), info.state_names.size());
    EXPECT_EQ(info.state_names.size(), static_cast<std::size_t>(structure.dimension));
    EXPECT_EQ(structure.angles.size(), system->winding_names().size());
    for (const int angle : structure.angles) EXPECT_LT(angle, structure.dimension);
    for (const Parameter& parameter : info.parameters) {
      EXPECT_LE(parameter.lower, parameter.standard);
      EXPECT_LE(parameter.standard, parameter.upper);
      EXPECT_FALSE(parameter.meaning.empty());
      EXPECT_FALSE(parameter.unit.empty());
    }
    const auto identity = AffineMap::identity(structure.dimension);
    for (const Symmetry& s : structure.equivariances) {
      EXPECT_EQ(s.map.matrix.rows(), structure.dimension) << s.name;
      EXPECT_EQ(s.map.matrix.cols(), structure.dimension) << s.name;
      EXPECT_EQ(s.map.offset.size(), structure.dimension) << s.name;
      EXPECT_FALSE(s.map.is_same(identity, structure.angles)) << s.name << " is the identity";
    }
    for (const Symmetry& r : structure.reversors)
      EXPECT_TRUE((r.map * r.map).is_same(identity, structure.angles)) << r.name << " is no involution";
  }
}

TEST(Registry, EquivariancesFormAGroupWithTheIdentity) {
  for (const Built& built : all_built()) {
    const auto system = built.with();
    const Structure& structure = system->structure();
    std::vector<AffineMap> group{AffineMap::identity(structure.dimension)};
    for (const Symmetry& s : structure.equivariances) group.push_back(s.map);
    for (const auto& a : group)
      for (const auto& b : group) {
        const auto matches = std::count_if(group.begin(), group.end(), [&](const AffineMap& member) {
          return member.is_same(a * b, structure.angles);
        });
        EXPECT_EQ(matches, 1) << built.title();
      }
  }
}

TEST(Registry, HenonHeilesHasTheTriangleGroup) {
  const auto system = make_system("henon_heiles");
  const Structure& structure = system->structure();
  EXPECT_EQ(structure.equivariances.size(), 5U);
  EXPECT_EQ(structure.reversors.size(), 4U);
}

TEST(Registry, StandardValuesAreFilledIn) {
  const auto system = make_system("double_pendulum", {{"m2", 3.5}, {"g", 9.81}});
  const std::map<std::string, double> expected{{"m1", 1.0}, {"m2", 3.5}, {"l1", 1.0}, {"l2", 1.0}, {"g", 9.81}};
  EXPECT_EQ(system->parameters(), expected);
  EXPECT_EQ(system->info().state_names, (std::vector<std::string>{"th1", "th2", "w1", "w2"}));
  EXPECT_EQ(system->structure().angles, (std::vector<int>{0, 1}));
  EXPECT_EQ(system->dimension(), 4);
  EXPECT_EQ(system->structure().pairs(), 1);
}

TEST(Registry, ParametersReachTheField) {
  const std::vector<double> z{0.5, 0.25};
  std::vector<double> f(2);
  make_system("harmonic_oscillator", {{"omega", 3.0}})->field(1, z.data(), f.data());
  EXPECT_EQ(f[0], 0.25);
  EXPECT_EQ(f[1], -4.5);
}

TEST(Registry, UnknownSystemIsRefused) {
  const auto expected = ThrowsMessage<core::InputError>(
      AllOf(HasSubstr("'tripple_pendulum'"), HasSubstr("the systems are: " + joined(system_names()))));
  EXPECT_THAT([] { (void)make_system("tripple_pendulum"); }, expected);
  EXPECT_THAT([] { (void)model_info("tripple_pendulum"); }, expected);
}

TEST(Registry, UnknownParameterIsRefused) {
  EXPECT_THAT(([] {
                (void)make_system("double_pendulum", {{"m3", 1.0}});
              }),
              ThrowsMessage<core::InputError>(
                  AllOf(HasSubstr("double_pendulum"), HasSubstr("'m3'"), HasSubstr("m1, m2, l1, l2, g"))));
  EXPECT_THAT(([] {
                (void)make_system("henon_heiles", {{"lambda", 1.0}});
              }),
              ThrowsMessage<core::InputError>(HasSubstr("its parameters are: none")));
}

TEST(Registry, UnknownEffectIsRefused) {
  EXPECT_THAT(([] { (void)make_system("double_pendulum", {}, {"friction"}); }),
              ThrowsMessage<core::InputError>(AllOf(
                  HasSubstr("double_pendulum"), HasSubstr("'friction'"),
                  HasSubstr("its effects are: rod_inertia, torsion_springs, damping, pivot_drive, joint_torque"))));
  EXPECT_THAT([] { (void)make_system("lorenz", {}, {"drive"}); },
              ThrowsMessage<core::InputError>(HasSubstr("its effects are: none")));
  EXPECT_THAT(([] { (void)bound_to(driven_pendulum(), {}, {"frction"}); }),
              ThrowsMessage<core::InputError>(AllOf(HasSubstr("'frction'"), HasSubstr("friction, drive"))));
}

TEST(Registry, AnyEffectsGoTogether) {
  const auto system = make_system("double_pendulum", {}, {"torsion_springs", "damping"});
  EXPECT_TRUE(system->structure().angles.empty());
  EXPECT_TRUE(system->structure().decays);
}

TEST(Registry, EffectsComeInAnyOrder) {
  const auto one = make_system("duffing", {}, {"drive", "damping"});
  const auto other = make_system("duffing", {}, {"damping", "drive"});
  EXPECT_EQ(one->info().title, other->info().title);
  EXPECT_EQ(one->info().title, "Duffing oscillator with damping, drive");
  EXPECT_EQ(one->info().state_names, (std::vector<std::string>{"x", "v", "phase"}));
}

TEST(Registry, ValuesOutOfRangeAreRefused) {
  for (const double value : {0.0, -1.0, infinity, -infinity, std::nan("")}) {
    for (const std::string name : {"m1", "m2", "l1", "l2", "g"}) {
      EXPECT_THAT(([&] {
                    (void)make_system("double_pendulum", {{name, value}});
                  }),
                  ThrowsMessage<core::InputError>(AllOf(HasSubstr("'" + name + "'"), HasSubstr("0 < " + name),
                                                        HasSubstr(std::isnan(value) ? "nan came" : "came"))));
    }
  }
  EXPECT_THAT(([] {
                (void)make_system("double_pendulum", {{"m1", -1.5}});
              }),
              ThrowsMessage<core::InputError>(HasSubstr("mass of the inner bob")));
  EXPECT_THAT(([] {
                (void)make_system("double_pendulum", {{"m1", -1.5}});
              }),
              ThrowsMessage<core::InputError>(HasSubstr("0 < m1 kg; -1.5 came")));
}

TEST(Registry, ClosedAndOpenBoundsAreToldApart) {
  EXPECT_EQ(bound_to(driven_pendulum(), {{"detuning", -1.0}}, {})["detuning"], -1.0);
  EXPECT_EQ(bound_to(driven_pendulum(), {{"detuning", 1.0}}, {})["detuning"], 1.0);
  EXPECT_THAT(([] {
                (void)bound_to(driven_pendulum(), {{"detuning", 1.0000001}}, {});
              }),
              ThrowsMessage<core::InputError>(HasSubstr("-1 <= detuning <= 1;")));
}

TEST(Registry, EffectsBringTheirParameters) {
  const auto bound = bound_to(driven_pendulum(), {{"c", 0.25}}, {"friction"});
  EXPECT_EQ(bound.effects, std::vector<std::string>{"friction"});
  EXPECT_EQ(bound.parameters, (std::map<std::string, double>{{"l", 1.0}, {"detuning", 0.0}, {"c", 0.25}}));
  EXPECT_THAT(
      ([] {
        (void)bound_to(driven_pendulum(), {{"c", 0.25}}, {"drive"});
      }),
      ThrowsMessage<core::InputError>(AllOf(HasSubstr("'c'"), HasSubstr("effect 'friction', which is not asked for"))));
  EXPECT_THAT(([] {
                (void)bound_to(driven_pendulum(), {{"c", 2.5}}, {"friction"});
              }),
              ThrowsMessage<core::InputError>(HasSubstr("0 <= c <= 2 1/s; 2.5 came")));
  EXPECT_THAT(([] {
                (void)bound_to(driven_pendulum(), {}, {"drive", "drive"});
              }),
              ThrowsMessage<core::InputError>(HasSubstr("asked for twice")));
}

}  // namespace
}  // namespace orbweaver::systems::registry_test
