// What holds depends on parameter values and effects, and the system evaluates what its structure names.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "orbweaver/systems/registry.hpp"
#include "structure_error.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::structure_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A particle in the plane on two springs, H = (px^2 + py^2 + a x^2 + b y^2) / 2, with friction as an effect. Equal
/// springs have a mirror more, and conserve the angular momentum too.
class Springs {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 2;

  static ModelInfo info() {
    ModelInfo info;
    info.name = "springs";
    info.title = "Two springs";
    info.state_names = {"x", "y", "px", "py"};
    info.winding_names = {"", "", "", ""};
    info.parameters = {{"a", 1.0, 0.0, infinity, true, "1/s^2", "stiffness in x"},
                       {"b", 2.0, 0.0, infinity, true, "1/s^2", "stiffness in y"}};
    info.effects = {{"friction", "drag", {{"c", 0.25, 0.0, infinity, false, "1/s", "damping rate"}}}};
    return info;
  }

  static Structure structure(const Bound& bound) {
    const Eigen::Matrix4d reverse = Eigen::Vector4d(1, 1, -1, -1).asDiagonal();
    const Eigen::Matrix4d mirror = Eigen::Vector4d(-1, 1, -1, 1).asDiagonal();
    Eigen::Matrix4d swap = Eigen::Matrix4d::Zero();
    swap(0, 1) = swap(1, 0) = swap(2, 3) = swap(3, 2) = 1.0;
    Structure structure;
    structure.dimension = dimension;
    structure.guards = {{"distance to (1, 0)", "the point (1, 0)"}, {"speed", "rest"}};
    structure.equivariances = {{"S", mirror}};
    const bool equal = bound["a"] == bound["b"];
    if (equal) structure.equivariances.push_back({"X", swap});
    if (bound.has("friction")) return structure;
    structure.reversors = {{"R", reverse}};
    structure.conserved = {"energy"};
    if (equal) structure.conserved.emplace_back("angular momentum");
    structure.symplectic = true;
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound)
        : _a(bound["a"]), _b(bound["b"]), _friction(bound.has("friction") ? bound["c"] : P(0.0)) {}

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[2];
      f[1] = z[3];
      f[2] = -(z[0] * _a) - z[2] * _friction;
      f[3] = -(z[1] * _b) - z[3] * _friction;
    }

    template <int K, class S>
    S conserved(const S* z) const {
      if constexpr (K == 0)
        return (z[2] * z[2] + z[3] * z[3] + z[0] * z[0] * _a + z[1] * z[1] * _b) * 0.5;
      else
        return z[0] * z[3] - z[1] * z[2];
    }

    template <class S>
    S action_density(const S* z) const {
      return z[2] * z[2] + z[3] * z[3];
    }

    template <class S>
    S guard(int k, const S* z) const {
      using std::sqrt;
      return k == 0 ? sqrt((z[0] - 1.0) * (z[0] - 1.0) + z[1] * z[1]) : sqrt(z[2] * z[2] + z[3] * z[3]);
    }

   private:
    P _a;
    P _b;
    P _friction;
  };
};

/// The same, with the names of what is conserved left out from the `named`-th on.
template <int named>
class Forgetful : public Springs {
 public:
  static Structure structure(const Bound& bound) {
    Structure structure = Springs::structure(bound);
    structure.conserved.resize(std::min<std::size_t>(structure.conserved.size(), named));
    structure.symplectic = structure.symplectic && !structure.conserved.empty();
    return structure;
  }
};

std::shared_ptr<const System> springs(const std::map<std::string, double>& given,
                                      const std::vector<std::string>& effects = {}) {
  return recorded<Springs>(bound_to(Springs::info(), given, effects));
}

std::vector<std::string> names_of(const std::vector<Symmetry>& symmetries) {
  std::vector<std::string> names;
  for (const Symmetry& s : symmetries) names.push_back(s.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(Structure, DependsOnParameterValues) {
  const auto unequal = springs({});
  EXPECT_EQ(unequal->structure().conserved, Names{"energy"});
  EXPECT_EQ(names_of(unequal->structure().equivariances), Names{"S"});
  const auto equal = springs({{"a", 2.0}});
  EXPECT_EQ(equal->structure().conserved, (Names{"energy", "angular momentum"}));
  EXPECT_EQ(names_of(equal->structure().equivariances), (Names{"S", "X"}));
  EXPECT_EQ(unequal->info().name, equal->info().name);
}

TEST(Structure, DependsOnEffects) {
  const auto damped = springs({{"a", 2.0}, {"c", 0.5}}, {"friction"});
  EXPECT_FALSE(damped->structure().conservative());
  EXPECT_FALSE(damped->structure().symplectic);
  EXPECT_EQ(damped->structure().pairs(), 3);
  EXPECT_TRUE(damped->structure().reversors.empty());
  EXPECT_EQ(names_of(damped->structure().equivariances), (Names{"S", "X"}));
  EXPECT_EQ(damped->parameters().at("c"), 0.5);
  const std::vector<double> z{0.5, 0.25, 1.0, 3.0};
  std::vector<double> f(4);
  damped->field(1, z.data(), f.data());
  EXPECT_EQ(f[2], -1.5);
  EXPECT_THROW((void)damped->conserved(0, z), core::MisuseError);
}

TEST(Structure, EachConservedQuantityHasItsOwnValueAndGradient) {
  const auto system = springs({{"a", 2.0}});
  const std::vector<double> z{0.5, 0.25, 1.0, 3.0};
  EXPECT_EQ(system->conserved(0, z), 0.5 * (1.0 + 9.0 + 2.0 * 0.25 + 2.0 * 0.0625));
  EXPECT_EQ(system->conserved(1, z), 0.5 * 3.0 - 0.25);
  std::vector<double> gradient(4);
  system->conserved_gradient(0, z, gradient);
  EXPECT_EQ(gradient, (std::vector<double>{1.0, 0.5, 1.0, 3.0}));
  system->conserved_gradient(1, z, gradient);
  EXPECT_EQ(gradient, (std::vector<double>{3.0, -1.0, -0.25, 0.5}));
  EXPECT_THROW((void)system->conserved(2, z), core::MisuseError);
  EXPECT_THROW((void)springs({})->conserved(1, z), core::MisuseError);
}

TEST(Structure, HoldsForTheField) {
  std::mt19937 generator{7};
  for (const auto& system : {springs({}), springs({{"a", 2.0}}), springs({{"a", 2.0}}, {"friction"})}) {
    std::vector<std::vector<double>> states;
    for (int n = 0; n < 8; ++n) states.push_back(random_numbers(4, generator));
    const std::vector<IdentityError> errors = identity_errors(*system, states);
    EXPECT_GE(errors.size(), 2U);
    for (const IdentityError& found : errors) EXPECT_LE(found.error, 1e-14) << found.identity;
  }
}

TEST(Structure, GuardsAreFunctionsOfTheState) {
  const auto system = springs({});
  EXPECT_EQ(system->structure().guard_names(), (Names{"distance to (1, 0)", "speed"}));
  const std::vector<double> z{1.0, 0.5, 3.0, 4.0};
  EXPECT_EQ(system->guard(0, z), 0.5);
  EXPECT_EQ(system->guard(1, z), 5.0);
  EXPECT_THROW((void)system->guard(2, z), core::MisuseError);
  EXPECT_THROW((void)make_system("henon_heiles")->guard(0, z), core::MisuseError);
}

TEST(Structure, OnesThatDoNotFitTheirModelAreRefusedByTheItemThatDoesNot) {
  const Structure good = springs({})->structure();
  EXPECT_NO_THROW(check(good, Springs::info(), 4, 2));
  const Eigen::Matrix4d identity = Eigen::Matrix4d::Identity();
  const Eigen::MatrixXd flat = Eigen::MatrixXd::Identity(4, 3);
  using Change = std::function<void(Structure&)>;
  const std::vector<std::pair<std::string, Change>> wrong{
      {"structure.dimension is 5, and the model's dimension 4", [](Structure& s) { s.dimension = 5; }},
      {"structure.angles has 0, 'x', whose winding number has no name", [](Structure& s) { s.angles = {0}; }},
      {"structure.angles[0] is -1: expected the number of a coordinate, from 0 to 3",
       [](Structure& s) { s.angles = {-1}; }},
      {"structure.angles[0] is 4", [](Structure& s) { s.angles = {4}; }},
      {"structure.conserved names 3 quantities (energy, p, q), and the model has functions for 2",
       [](Structure& s) {
         s.conserved = {"energy", "p", "q"};
       }},
      {"structure.conserved[0] is 'p'",
       [](Structure& s) {
         s.conserved = {"p", "p"};
       }},
      {"'Q': its matrix is 2 x 2, and the state has 4 coordinates",
       [](Structure& s) {
         s.reversors.push_back({"Q", Eigen::Matrix2d::Identity()});
       }},
      {"structure.equivariances[0], 'Q': its matrix is 4 x 3",
       [&](Structure& s) {
         s.equivariances = {{"Q", flat}};
       }},
      {"structure.equivariances[0], 'Q': done often enough a symmetry is the identity",
       [&](Structure& s) {
         s.equivariances = {{"Q", 2.0 * identity}};
       }},
      {"structure.reversors[0], 'Q': done often enough",
       [&](Structure& s) {
         s.reversors = {{"Q", 0.0 * identity}};
       }},
      {"structure.equivariances[0], 'Q': it is the identity",
       [&](Structure& s) {
         s.equivariances = {{"Q", identity}};
       }},
      {"structure.reversors[1], 'Q': it is the same map as 'R'",
       [](Structure& s) {
         s.reversors.push_back({"Q", s.reversors.front().map});
       }},
      {"structure.reversors[0], 'S': the name is that of structure.equivariances[0], 'S'",
       [](Structure& s) { s.reversors.front().name = "S"; }},
      {"structure.reversors[0], '1': the name is that of the identity",
       [](Structure& s) { s.reversors.front().name = "1"; }},
      {"structure.reversors[0], '': expected a name", [](Structure& s) { s.reversors.front().name = ""; }},
      {"structure.symplectic is true, and so is structure.dissipative",
       [](Structure& s) { s.symplectic = s.dissipative = true; }},
      {"structure.symplectic is true, and structure.conserved is empty",
       [](Structure& s) {
         s.symplectic = true;
         s.conserved = {};
       }},
      {"structure.driven says that the last coordinate", [](Structure& s) {
         s.driven = true;
         s.angles = {};
       }}};
  for (const auto& [what, change] : wrong) {
    Structure bad = good;
    change(bad);
    EXPECT_THAT(([&] { check(bad, Springs::info(), 4, 2); }),
                testing::ThrowsMessage<StructureError>(testing::HasSubstr(what)))
        << what;
  }
  ModelInfo nameless = Springs::info();
  nameless.winding_names.pop_back();
  EXPECT_THAT(([&] { check(good, nameless, 4, 2); }),
              testing::ThrowsMessage<StructureError>(
                  testing::HasSubstr("info.winding_names has 3 names, and the state 4 coordinates")));
}

TEST(Structure, WhatTheFieldKeepsIsNamed) {
  const auto made = []<class Model>(const std::map<std::string, double>& given,
                                    const std::vector<std::string>& effects = {}) {
    return [=] { static_cast<void>(recorded<Model>(bound_to(Springs::info(), given, effects))); };
  };
  EXPECT_THAT((made.operator()<Forgetful<0>>({})),
              testing::ThrowsMessage<StructureError>(testing::AllOf(
                  testing::HasSubstr("structure.conserved does not name conserved<0>, which the field keeps"),
                  testing::HasSubstr(R"(structure.conserved = {"energy"})"))));
  EXPECT_NO_THROW((made.operator()<Forgetful<1>>({})())) << "springs that differ keep the energy alone";
  EXPECT_THAT((made.operator()<Forgetful<1>>({{"a", 2.0}})),
              testing::ThrowsMessage<StructureError>(testing::HasSubstr("does not name conserved<1>")));
  EXPECT_NO_THROW((made.operator()<Forgetful<0>>({{"c", 1e-12}}, {"friction"})())) << "the least friction ends it";
}

TEST(Structure, GuardsWantAFunction) {
  Structure structure = springs({})->structure();
  structure.guards = {{"r", "the centre"}};
  EXPECT_THAT([&] { check_without_guards(structure); },
              testing::ThrowsMessage<StructureError>(testing::HasSubstr("structure.guards names 'r'")));
}

TEST(Structure, AnEnergyWantsAnActionDensity) {
  Structure structure = springs({})->structure();
  EXPECT_THAT([&] { check_without_action_density(structure); },
              testing::ThrowsMessage<StructureError>(testing::HasSubstr("names 'energy', and the model has no action "
                                                                        "density")));
  structure.conserved.clear();
  EXPECT_NO_THROW(check_without_action_density(structure));
}

TEST(Bound, AParameterThatInfoDoesNotNameIsTold) {
  const Bound bound{{{"c", 1.0}, {"k", 2.0}}, {}};
  EXPECT_EQ(bound["k"], 2.0);
  EXPECT_THAT([&] { static_cast<void>(bound["kk"]); }, testing::ThrowsMessage<StructureError>(testing::HasSubstr(
                                                           "a parameter 'kk', which info.parameters does not "
                                                           "name; it names c, k")));
}

TEST(AffineMap, ComposesAndInverts) {
  const Eigen::Matrix2d turn = (Eigen::Matrix2d() << 0, -1, 1, 0).finished();
  const AffineMap about{turn, Eigen::Vector2d(5.0, 1.0)};  // a quarter turn about (2, 3)
  EXPECT_EQ(about(Eigen::Vector2d(2.0, 3.0)), Eigen::VectorXd(Eigen::Vector2d(2.0, 3.0)));
  const AffineMap half = about * about;
  EXPECT_EQ(half(Eigen::Vector2d(0.0, 0.0)), Eigen::VectorXd(Eigen::Vector2d(4.0, 6.0)));
  EXPECT_LT((about.inverse()(about(Eigen::Vector2d(0.3, 0.7))) - Eigen::Vector2d(0.3, 0.7)).norm(), 1e-15);
  EXPECT_TRUE((half * half).is_same(AffineMap::identity(2), {}));
  EXPECT_FALSE(half.is_linear());
  EXPECT_THROW(AffineMap(Eigen::MatrixXd::Identity(2, 2), Eigen::VectorXd::Zero(3)), StructureError);
}

TEST(AffineMap, IsTheSameModuloWholeTurnsOfAngles) {
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  const AffineMap turned{identity, Eigen::Vector2d(4.0 * std::acos(-1.0), 0.0)};
  EXPECT_TRUE(turned.is_same(identity, {0}));
  const AffineMap third{identity, Eigen::Vector2d(2.0, 0.0)};
  EXPECT_FALSE(third.is_same(identity, {0}));
  const AffineMap half{identity, Eigen::Vector2d(std::acos(-1.0), 0.0)};
  EXPECT_FALSE(half.is_same(identity, {0}));
  EXPECT_TRUE((half * half).is_same(identity, {0}));
}

}  // namespace
}  // namespace orbweaver::systems::structure_test
