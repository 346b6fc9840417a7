#include "orbweaver/systems/undeclared_symmetries.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/undeclared_turns.hpp"
#include "support/driven_oscillator.hpp"
#include "support/magnetic_well.hpp"
#include "support/moved_system.hpp"

namespace orbweaver::systems::undeclared_symmetries_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::vector<std::vector<double>> origin{{0.0, 0.0, 0.0, 0.0}};

TEST(UndeclaredSymmetries, AreFound) {
  std::map<std::string, double> well{{"b", 0.0}, {"k2", 3.0}};
  EXPECT_THAT(undeclared_symmetries(*test::magnetic_well(well), origin),
              ElementsAre("the reversor (x, y, px, py) -> (x, y, -px, -py)"));
  for (const char* cubic : {"a1", "a2", "a3", "a4"}) well[cubic] = 0.0;
  EXPECT_THAT(
      undeclared_symmetries(*test::magnetic_well(well), origin),
      ElementsAre("the reversor (x, y, px, py) -> (x, y, -px, -py)", "the reversor (x, y, px, py) -> (-x, y, px, -py)",
                  "the reversor (x, y, px, py) -> (x, -y, -px, py)"));
  well["b"] = 1e-6;
  well["a1"] = 1e-6;
  EXPECT_THAT(undeclared_symmetries(*test::magnetic_well(well), origin),
              ElementsAre("the reversor (x, y, px, py) -> (x, -y, -px, py)"));
}

TEST(UndeclaredSymmetries, AreFoundAboutOtherPoints) {
  const Eigen::Vector4d offset(2.0, 0.0, -1.0, 0.5);
  const auto moved = test::translated_system(test::magnetic_well({{"b", 0.0}}), offset);
  EXPECT_THAT(undeclared_symmetries(*moved, {{5.0, 5.0, 5.0, 5.0}, {2.0, 0.0, -1.0, 0.5}}),
              ElementsAre("the reversor (x, y, px, py) -> (x, y, -2 - px, 1 - py)"));
}

// A pendulum that is pushed to both sides alike: half a period later it swings to the other one.
TEST(UndeclaredSymmetries, HaveHalfATurnOfADrivesPhase) {
  const auto pushed = [](double torque) {
    return systems::recorded<test::DrivenOscillator>(
        systems::bound_to(test::DrivenOscillator::info(),
                          {{"d", 0.1}, {"s", 1.0}, {"c", torque}, {"F", 0.3}, {"w", 0.6}}, {}, {.free = {"F"}}));
  };
  const std::vector<std::vector<double>> rest{{0.0, 0.0, 0.0}};
  EXPECT_THAT(undeclared_symmetries(*pushed(0.0), rest), ElementsAre("the symmetry (x, v, phi) -> (-x, -v, phi + pi)"));
  EXPECT_THAT(undeclared_symmetries(*pushed(1e-6), rest), IsEmpty());
}

TEST(UndeclaredSymmetries, AreThoseAtAllValuesOfAParameterThatMoves) {
  const std::map<std::string, double> well{{"b", 0.0}, {"k2", 3.0}};
  const auto moving = [&](const std::string& name) {
    return systems::recorded<test::MagneticWell>(
        systems::bound_to(test::MagneticWell::info(), well, {}, {.free = {name}}));
  };
  EXPECT_THAT(undeclared_symmetries(*moving("b"), origin), IsEmpty());
  EXPECT_THAT(undeclared_symmetries(*moving("k2"), origin),
              ElementsAre("the reversor (x, y, px, py) -> (x, y, -px, -py)"));
}

TEST(UndeclaredSymmetries, AreTurnsAboutAnAxis) {
  std::map<std::string, double> well{{"k1", 3.0}, {"k2", 3.0}, {"e", 0.0}, {"c", 1.0}};
  for (const char* cubic : {"a1", "a2", "a3", "a4"}) well[cubic] = 0.0;
  EXPECT_THAT(undeclared_turns(*test::magnetic_well(well), origin), ElementsAre("x", "y", "px", "py"));
  const Eigen::Vector4d offset(2.0, 0.0, -1.0, 0.5);
  const auto moved = test::translated_system(test::magnetic_well(well), offset);
  EXPECT_THAT(undeclared_turns(*moved, origin), IsEmpty());
  EXPECT_THAT(undeclared_turns(*moved, {{2.0, 0.0, -1.0, 0.5}}), ElementsAre("x", "y", "px", "py"));
  for (const char* name : {"k1", "a1", "c", "e"}) {
    std::map<std::string, double> uneven = well;
    uneven[name] += 1e-6;
    EXPECT_THAT(undeclared_turns(*test::magnetic_well(uneven), origin), IsEmpty()) << name;
  }
  well["q"] = 0.0;
  EXPECT_THAT(undeclared_turns(*test::magnetic_well(well), origin), IsEmpty()) << "linear: all orbits close or none";
  for (const char* name : {"double_pendulum", "henon_heiles", "pcr3bp", "swinging_spring"})
    EXPECT_THAT(undeclared_turns(*make_system(name), origin), IsEmpty()) << name;
}

// A spring that hardens as those of machines do in SI units: 1 away the field is the quartic's to all digits.
TEST(UndeclaredSymmetries, AreNotThoseOfOneStiffTermAlone) {
  std::map<std::string, double> well{{"b", 0.0}, {"k1", 1.0}, {"k2", 3.0}, {"q", 1e12}, {"c", 1.0}, {"e", 0.0}};
  for (const char* cubic : {"a2", "a3", "a4"}) well[cubic] = 0.0;
  well["a1"] = 1.0;
  EXPECT_THAT(undeclared_turns(*test::magnetic_well(well), origin), IsEmpty());
  EXPECT_THAT(undeclared_symmetries(*test::magnetic_well(well), origin),
              ElementsAre("the reversor (x, y, px, py) -> (x, y, -px, -py)",
                          "the reversor (x, y, px, py) -> (x, -y, -px, py)"));
}

TEST(UndeclaredSymmetries, AreNotWhatIsDeclared) {
  for (const char* name : {"double_pendulum", "henon_heiles", "pcr3bp", "swinging_spring"})
    EXPECT_THAT(undeclared_symmetries(*make_system(name), origin), IsEmpty()) << name;
  EXPECT_THAT(undeclared_symmetries(*make_system("lorenz"), {{0.0, 0.0, 0.0}}), IsEmpty());
}

}  // namespace
}  // namespace orbweaver::systems::undeclared_symmetries_test
