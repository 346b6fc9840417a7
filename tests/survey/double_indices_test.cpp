// A well and a ring with the symmetry of a triangle: along the axis, and where all three are alike, both indices are
// equal.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/well_in_space.hpp"
#include "survey/same_tree.hpp"
#include "survey/surveyed_well.hpp"

namespace double_indices_test {
namespace {

using namespace orbweaver;

/// V = sum of v(x_i) + v(x_i - x_j)/10, v(x) = x^2/2 - x^4/24.
class Ring {
 public:
  static constexpr int dimension = 6;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("ring", "a ring of three oscillators", {"x", "y", "z", "px", "py", "pz"});
  }

  static systems::Structure structure(const systems::Bound&) {
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d turn = Eigen::PermutationMatrix<3>(Eigen::Vector3i(1, 2, 0)).toDenseMatrix().cast<double>();
    const Eigen::Matrix3d swap = Eigen::PermutationMatrix<3>(Eigen::Vector3i(1, 0, 2)).toDenseMatrix().cast<double>();
    const auto of_states = [](const Eigen::Matrix3d& places, double momenta) {
      Eigen::MatrixXd map = Eigen::MatrixXd::Zero(dimension, dimension);
      map.topLeftCorner<3, 3>() = places;
      map.bottomRightCorner<3, 3>() = momenta * places;
      return map;
    };
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    structure.reversors = {{"R", of_states(one, -1.0)}};
    for (const auto& [name, places] :
         std::vector<std::pair<std::string, Eigen::Matrix3d>>{{"S", -one},
                                                              {"C", turn},
                                                              {"CC", turn * turn},
                                                              {"X", swap},
                                                              {"XC", swap * turn},
                                                              {"XCC", swap * turn * turn},
                                                              {"SC", -turn},
                                                              {"SCC", -turn * turn},
                                                              {"SX", -swap},
                                                              {"SXC", -swap * turn},
                                                              {"SXCC", -swap * turn * turn}}) {
      structure.equivariances.push_back({name, of_states(places, 1.0)});
      structure.reversors.push_back({"R" + name, of_states(places, -1.0)});
    }
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>&) {}

    template <class S>
    void field(const S* s, S* f) const {
      const auto force = [](const S& x) { return x * x * x * (1.0 / 6.0) - x; };
      for (int i = 0; i < 3; ++i) {
        const S& x = s[i];
        f[i] = s[3 + i];
        f[3 + i] = force(x) + (force(x - s[(i + 1) % 3]) + force(x - s[(i + 2) % 3])) * 0.1;
      }
    }

    template <int, class S>
    S conserved(const S* s) const {
      const auto potential = [](const S& x) { return x * x * 0.5 - x * x * x * x * (1.0 / 24.0); };
      S sum = action_density(s) * 0.5;
      for (int i = 0; i < 3; ++i) sum = sum + potential(s[i]) + potential(s[i] - s[(i + 1) % 3]) * 0.1;
      return sum;
    }

    template <class S>
    S action_density(const S* s) const {
      return s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    }
  };
};

std::vector<std::string> with(std::vector<std::string> settings, const std::string& one) {
  if (!one.empty()) settings.push_back(one);
  return settings;
}

test::Atlas survey_of(const std::map<std::string, double>& coefficients, const std::vector<std::string>& settings) {
  std::vector<std::string> all{"survey.subharmonics=2"};
  all.insert(all.end(), settings.begin(), settings.end());
  return test::survey_of(test::well_in_space<test::WellInSpace<false, test::InSpace::triangle>>(coefficients), all);
}

// Of the family along x the index of y'' = -(1 + 2 b x + 2 g x^2) y passes 2 from E = 0.29765 to 0.31213: with both
// pairs at once, so that no function changes its sign, and within one of the program's own steps.
TEST(DoubleIndices, PassTogether) {
  const double a = 0.4;
  const double b = 0.2;
  const double g = 0.05;
  const std::map<std::string, double> well{{"c200", 0.245}, {"c020", 0.5}, {"c002", 0.5}, {"c012", a}, {"c030", -a / 3},
                                           {"c120", b},     {"c102", b},   {"c220", g},   {"c202", g}, {"c400", 0.25}};
  const std::vector<std::string> settings{"survey.depth=0", "limits.period=12", "limits.energy=[0, 0.5]"};
  const test::Atlas atlas = survey_of(well, settings);
  std::vector<double> energies;
  for (std::size_t row = 0; row < atlas.crossings().rows(); ++row) {
    if (atlas.crossings().integers("kernel_dimension")[row] != 2) continue;
    EXPECT_EQ(atlas.crossings().texts("kind")[row], "branch-point");
    EXPECT_EQ(atlas.crossings().integers("family")[row], 0);
    energies.push_back(atlas.crossings().reals("energy")[row]);
  }
  std::sort(energies.begin(), energies.end());
  ASSERT_EQ(energies.size(), 2U);
  EXPECT_NEAR(energies[0], 0.297654411, 1e-9);
  EXPECT_NEAR(energies[1], 0.3121337, 1e-8);
  for (const std::string other : {"continuation.step=0.1", "continuation.step=0.03", "continuation.start=0.02"}) {
    SCOPED_TRACE(other);
    test::expect_same_tree(atlas, survey_of(well, with(settings, other)));
  }
}

// A ring of three pendulums to fourth order, mode 1 being the three alike. Where rounding left both indices real, the
// planes of the two pairs were compared from orbit to orbit, which are rounding's: steps were halved until none was
// left.
TEST(DoubleIndices, HoldNoFamilyUp) {
  const auto system = systems::recorded<Ring>(systems::bound_to(Ring::info(), {}, {}));
  for (const std::string start : {"", "continuation.start=0.003", "continuation.start=0.05"}) {
    SCOPED_TRACE(start);
    const test::Atlas atlas = test::survey_of(
        system,
        with({"survey.depth=0", "survey.subharmonics=2", "limits.period=16", "limits.energy=[0, 1]", "limits.steps=60"},
             start));
    for (const std::string& end : atlas.families().texts("end_reason")) EXPECT_TRUE(end.starts_with("energy")) << end;
  }
}

}  // namespace
}  // namespace double_indices_test
