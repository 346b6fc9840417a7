#include "orbweaver/loop/symmetry/conjugacy.hpp"

#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/systems/system.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loop::conjugacy_test {
namespace {

const systems::Structure& pendulum() { return test::structure_of("double_pendulum"); }
const systems::Structure& galaxy() { return test::structure_of("henon_heiles"); }

bool conjugate(const systems::Structure& system, const std::string& a, const std::string& b) {
  return are_conjugate(system, isotropy_of(system, a), isotropy_of(system, b));
}

TEST(IsotropyText, IsReadAsItIsWritten) {
  for (const std::string text : {"", "R@0", "S@1/2 R@0", "RS@0"})
    EXPECT_EQ(to_text(isotropy_of(pendulum(), text)), text);
  for (const std::string text : {"C@2/3", "C@1/3 R@0"}) EXPECT_EQ(to_text(isotropy_of(galaxy(), text)), text);
  for (const std::string text : {"S", "S@", "S@1/", "S@1/0", "S@1/2x", "Q@0", "S@x"})
    EXPECT_THROW(static_cast<void>(isotropy_of(pendulum(), text)), core::InputError) << text;
}

TEST(Conjugacy, IsOfTheWholeGroup) {
  EXPECT_TRUE(conjugate(pendulum(), "", ""));
  EXPECT_FALSE(conjugate(pendulum(), "", "R@0"));
  EXPECT_TRUE(conjugate(pendulum(), "S@1/2 R@0", "S@1/2 RS@1/2"));  // other generators
  EXPECT_FALSE(conjugate(pendulum(), "S@1/2", "S@0"));
}

TEST(Conjugacy, AllowsAnotherPhase) {
  EXPECT_TRUE(conjugate(pendulum(), "R@0", "R@1/2"));
  EXPECT_FALSE(conjugate(pendulum(), "R@0", "RS@0"));
  EXPECT_TRUE(conjugate(pendulum(), "S@1/2 R@0", "S@1/2 RS@0"));  // started a quarter later
  EXPECT_FALSE(conjugate(pendulum(), "S@0 R@0", "S@1/2 R@0"));
}

TEST(Conjugacy, AllowsASymmetryOfTheSystem) {
  EXPECT_TRUE(conjugate(galaxy(), "C@1/3", "C@2/3"));  // a reflection, or time running backwards
  const systems::Structure& system = galaxy();
  for (const systems::Symmetry& s : system.equivariances)
    for (const systems::Symmetry& other : system.equivariances) {
      const bool alike = (s.map.matrix.determinant() > 0.0) == (other.map.matrix.determinant() > 0.0) &&
                         std::abs(s.map.matrix.trace() - other.map.matrix.trace()) < 1e-9;
      EXPECT_EQ(conjugate(system, s.name + "@0", other.name + "@0"), alike) << s.name << ' ' << other.name;
    }
}

}  // namespace
}  // namespace orbweaver::loop::conjugacy_test
