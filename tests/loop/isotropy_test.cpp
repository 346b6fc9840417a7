#include "orbweaver/loop/symmetry/isotropy.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loop::isotropy_test {
namespace {

using test::element_of;

constexpr double tolerance = 1e-9;
constexpr double pi = std::numbers::pi;

const systems::Structure& pendulum() { return test::structure_of("double_pendulum"); }
const systems::Structure& galaxy() { return test::structure_of("henon_heiles"); }

// A random loop about `mean` that has exactly the given symmetries.
Loop loop_with(const Isotropy& isotropy, const std::vector<double>& mean = {0.0, 0.0, 0.0, 0.0}) {
  return test::random_loop_in(Subspace(4, 8, isotropy), constant_loop(mean, 5.0, 8), 41);
}

std::string found(const systems::Structure& system, const Loop& loop, int max_denominator = 4) {
  return to_text(find_isotropy(system, loop, tolerance, max_denominator));
}

TEST(Isotropy, ReadsEquivariancesFirst) {
  EXPECT_EQ(to_text({}), "");
  EXPECT_EQ(to_text({element_of(pendulum(), "R"), element_of(pendulum(), "S", 1, 2)}), "S@1/2 R@0");
  EXPECT_EQ(to_text({element_of(galaxy(), "C", 2, 3)}), "C@2/3");
}

TEST(Isotropy, OfATaskIsRefusedUnlessItIsOneOfTheSystem) {
  const systems::Structure& system = test::structure_of("double_pendulum");
  const Isotropy good = with_declared_matrices({{"S", false, {}, 1, 2}}, system);
  EXPECT_EQ(good.at(0).map.matrix, element_of(system, "S").map.matrix);
  EXPECT_THROW((void)with_declared_matrices({{"Q", false, {}, 1, 2}}, system), core::EnvironmentError);
  EXPECT_THROW((void)with_declared_matrices({{"S", true, {}, 1, 2}}, system), core::EnvironmentError);
  EXPECT_THROW((void)with_declared_matrices({{"S", false, {}, 0, 0}}, system), core::EnvironmentError);
}

TEST(Isotropy, IsFoundWithoutProducts) {
  const SymmetryElement s = element_of(pendulum(), "S", 1, 2);
  const SymmetryElement r = element_of(pendulum(), "R");
  const SymmetryElement rs = element_of(pendulum(), "RS");
  EXPECT_EQ(found(pendulum(), loop_with({})), "");
  EXPECT_EQ(found(pendulum(), loop_with({s})), "S@1/2");
  EXPECT_EQ(found(pendulum(), loop_with({r})), "R@0");
  EXPECT_EQ(found(pendulum(), loop_with({rs})), "RS@0");
  EXPECT_EQ(found(pendulum(), loop_with({s, r})), "S@1/2 R@0") << "RS@1/2 is a product";
}

TEST(Isotropy, SeesTheTimeShift) {
  const Loop loop = loop_with({element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")});
  EXPECT_EQ(found(pendulum(), time_shifted(loop, 0.25)), "S@1/2 R@1/2");
  EXPECT_EQ(found(pendulum(), time_shifted(loop, 0.1)), "S@1/2") << "the reversor's phase is 1/5 then, beyond fourths";
  EXPECT_EQ(found(pendulum(), time_shifted(loop, 0.1), 5), "S@1/2 R@4/5");
}

TEST(Isotropy, RespectsTheLargestDenominator) {
  const Loop loop = loop_with({element_of(galaxy(), "C", 1, 3)});
  EXPECT_EQ(found(galaxy(), loop, 2), "");
  EXPECT_EQ(found(galaxy(), loop, 3), "C@1/3");
  EXPECT_EQ(found(galaxy(), loop_with({element_of(galaxy(), "C", 2, 3)})), "C@2/3");
}

TEST(Isotropy, OfARotationWithItsReversor) {
  EXPECT_EQ(found(galaxy(), loop_with({element_of(galaxy(), "C", 1, 3), element_of(galaxy(), "RS")})), "C@1/3 RS@0");
  EXPECT_EQ(found(galaxy(), loop_with({element_of(galaxy(), "S", 1, 2), element_of(galaxy(), "R")})), "S@1/2 R@0");
}

TEST(Isotropy, ActsModuloTheLatticeOfAngles) {
  const Isotropy both{element_of(pendulum(), "S", 1, 2), element_of(pendulum(), "R")};
  for (const std::vector<double>& equilibrium :
       {std::vector<double>{0.0, pi, 0.0, 0.0}, {pi, 0.0, 0.0, 0.0}, {pi, pi, 0.0, 0.0}, {-pi, 4.0 * pi, 0.0, 0.0}})
    EXPECT_EQ(found(pendulum(), loop_with(both, equilibrium)), "S@1/2 R@0");
  EXPECT_EQ(found(pendulum(), loop_with(both, {0.5 * pi, 0.0, 0.0, 0.0})), "R@0") << "no lattice point between the two";
  EXPECT_EQ(found(pendulum(), loop_with(both, {0.0, 0.0, 2.0 * pi, 0.0})), "RS@1/2") << "a velocity has no lattice";
}

// Nothing but the equilibrium has S@0, so that R@0 restricts nothing further and is left out.
TEST(Isotropy, OfConstantLoopsHoldsWithoutShift) {
  const Loop equilibrium = constant_loop(std::vector<double>{0.0, pi, 0.0, 0.0}, 3.0, 4);
  EXPECT_EQ(found(pendulum(), equilibrium), "S@0");
  EXPECT_EQ(symmetry_defect(equilibrium, element_of(pendulum(), "R"), pendulum().angles), 0.0);
}

TEST(Isotropy, OfRotationsLeavesOutWhatTurnsThemRound) {
  Loop rotation = loop_with({element_of(pendulum(), "RS")});
  rotation.winding = {1.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(found(pendulum(), rotation), "RS@0");
  rotation.cosine(0, 0) = pi;
  EXPECT_EQ(found(pendulum(), rotation), "RS@0");
  Loop brake = loop_with({element_of(pendulum(), "R")});
  brake.winding = {0.0, -1.0, 0.0, 0.0};
  EXPECT_EQ(found(pendulum(), brake), "") << "R maps a rotation to one the other way round";
  EXPECT_EQ(symmetry_defect(brake, element_of(pendulum(), "R"), pendulum().angles),
            std::numeric_limits<double>::infinity());
}

// Shifted in time, a rotation's mean moves with the winding.
TEST(Isotropy, OfRotationsFollowsTheShift) {
  Loop rotation = loop_with({element_of(pendulum(), "RS")});
  rotation.winding = {1.0, 0.0, 0.0, 0.0};
  EXPECT_EQ(found(pendulum(), time_shifted(rotation, 0.125)), "RS@3/4");
}

TEST(Isotropy, DefectIsTheMeanDistanceFromTheImage) {
  const SymmetryElement s = element_of(pendulum(), "S", 1, 2);
  Loop loop = loop_with({s, element_of(pendulum(), "R")});
  EXPECT_LT(symmetry_defect(loop, s, pendulum().angles), 1e-14);
  constexpr double epsilon = 1e-3;
  loop.cosine(2, 0) += epsilon;
  // The image carries -epsilon cos 2s: a difference of 2 epsilon cos 2s, whose mean square is 2 epsilon^2.
  EXPECT_NEAR(symmetry_defect(loop, s, pendulum().angles), std::sqrt(2.0) * epsilon, 1e-14);
  EXPECT_LT(symmetry_defect(loop, element_of(pendulum(), "R"), pendulum().angles), 1e-14)
      << "a cosine of an angle keeps R";
  loop.sine(1, 1) += epsilon;
  EXPECT_NEAR(symmetry_defect(loop, element_of(pendulum(), "R"), pendulum().angles), std::sqrt(2.0) * epsilon, 1e-14);
  EXPECT_EQ(to_text(find_isotropy(pendulum(), loop, 1e-4)), "");
  EXPECT_EQ(to_text(find_isotropy(pendulum(), loop, 1e-2)), "S@1/2 R@0") << "within a coarser tolerance";
}

TEST(Isotropy, TransformedLoopIsTheElementsImage) {
  const Loop loop = test::random_loop(4, 6, 42, 3.0);
  const SymmetryElement c = element_of(galaxy(), "C", 1, 3);
  const SymmetryElement r = element_of(galaxy(), "RSC", 1, 4);
  const Loop turned = transformed(loop, c);
  const Loop reversed = transformed(loop, r);
  for (const double t : {0.0, 0.4, 2.2}) {
    const auto image = [t](const Loop& w, const Eigen::MatrixXd& m) {
      const std::vector<double> z = state_at(w, t);
      return Eigen::VectorXd(m * Eigen::Map<const Eigen::VectorXd>(z.data(), 4));
    };
    const std::vector<double> later = state_at(loop, t + 1.0);
    const std::vector<double> back = state_at(loop, 0.75 - t);
    EXPECT_LT((image(turned, c.map.matrix) - Eigen::Map<const Eigen::VectorXd>(later.data(), 4)).norm(), 1e-13);
    EXPECT_LT((image(reversed, r.map.matrix) - Eigen::Map<const Eigen::VectorXd>(back.data(), 4)).norm(), 1e-13);
  }
  EXPECT_THROW(static_cast<void>(transformed(test::random_loop(2, 3, 1), c)), core::MisuseError);
}

}  // namespace
}  // namespace orbweaver::loop::isotropy_test
