// Linear totals that systems without a symplectic form conserve: found, named, taken out.
#include "orbweaver/systems/linear_totals.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <Eigen/Dense>

#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/recorded_model.hpp"
#include "orbweaver/systems/reduced_system.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/described.hpp"

namespace orbweaver::systems::linear_totals_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pointwise;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Susceptible, infected and recovered, with births that make up for deaths: S + I + R is kept. `leak` is a death that
/// nothing makes up for.
class Epidemic {
 public:
  static constexpr int dimension = 3;
  static constexpr int quantities = 0;
  static ModelInfo info() {
    ModelInfo info = test::described("epidemic", "an epidemic", {"S", "I", "R"}, {"b", "leak"}, 0.0);
    info.parameters[0].standard = 0.3;
    return info;
  }
  static Structure structure(const Bound&) { return test::dissipative_structure(dimension); }
  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _b(bound["b"]), _leak(bound["leak"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      const S infected = z[0] * z[1] * _b;
      const S births = (z[1] + z[2]) * 0.02;
      f[0] = births - infected + z[2] * 0.1 - z[0] * _leak;
      f[1] = infected - z[1] * 0.2 - z[1] * 0.02;
      f[2] = z[1] * 0.2 - z[2] * 0.1 - z[2] * 0.02;
    }

   private:
    P _b, _leak;
  };
};

/// Ring of reactions A + B -> 2 B, B + C -> 2 C, C + A -> 2 A, and 2 D <-> E beside it, with rates that are eighteen
/// orders apart: A + B + C and D + 2 E are kept, the latter named by the structure where `told`.
template <bool told>
class Ring {
 public:
  static constexpr int dimension = 5;
  static constexpr int quantities = told ? 1 : 0;
  static ModelInfo info() { return test::described("ring", "a ring", {"A", "B", "C", "D", "E"}, {"k", "leak"}, 0.0); }
  static Structure structure(const Bound&) {
    Structure structure = test::dissipative_structure(dimension);
    if (told) structure.conserved = {"mass"};
    return structure;
  }
  template <class P>
  class With {
   public:
    explicit With(const BoundTo<P>& bound) : _k(bound["k"]), _leak(bound["leak"]) {}
    template <class S>
    void field(const S* z, S* f) const {
      const S one = z[0] * z[1] * 1e9, two = z[1] * z[2] * (_k + 1.0), three = z[2] * z[0] * 1e-9;
      const S pair = z[3] * z[3] * 2.0 - z[4] * z[0];
      f[0] = three - one;
      f[1] = one - two - z[1] * _leak;
      f[2] = two - three;
      f[3] = pair * -2.0;
      f[4] = pair;
    }
    template <int K, class S>
    S conserved(const S* z) const {
      return z[3] + z[4] * 2.0 + 7.0;
    }
    template <class S>
    S action_density(const S* z) const {
      return z[0] * 0.0;
    }

   private:
    P _k, _leak;
  };
};

template <class Model>
std::shared_ptr<const System> whole(const std::map<std::string, double>& parameters = {}) {
  return recorded<Model>(bound_to(Model::info(), parameters, {}));
}

std::vector<double> numbers(const VectorXd& vector) { return {vector.begin(), vector.end()}; }

TEST(LinearTotals, AreFound) {
  const std::vector<LinearTotal> people = linear_totals(*whole<Epidemic>());
  ASSERT_EQ(people.size(), 1U);
  EXPECT_EQ(people[0].name, "total_S");
  EXPECT_THAT(numbers(people[0].weights), ElementsAre(1.0, 1.0, 1.0));
  const std::vector<LinearTotal> atoms = linear_totals(*whole<Ring<false>>());
  ASSERT_EQ(atoms.size(), 2U);
  EXPECT_THAT(numbers(atoms[0].weights), ElementsAre(1.0, 1.0, 1.0, 0.0, 0.0));
  EXPECT_THAT(numbers(atoms[1].weights), ElementsAre(0.0, 0.0, 0.0, 1.0, 2.0));
  EXPECT_EQ(sum_text({"A", "B", "C", "D", "E"}, atoms[1].weights), "D + 2 E");
  const std::vector<LinearTotal> declared = linear_totals(*whole<Ring<true>>());
  ASSERT_EQ(declared.size(), 2U);
  EXPECT_EQ(declared[0].name, "mass");
  EXPECT_EQ(declared[0].quantity, 0);
  EXPECT_EQ(declared[1].name, "total_A");
}

TEST(LinearTotals, ASlowLeakBreaks) {
  EXPECT_THAT(linear_totals(*whole<Epidemic>({{"leak", 1e-16}})), IsEmpty());
  const std::vector<LinearTotal> left = linear_totals(*whole<Ring<false>>({{"leak", 1e-9}}));
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].name, "total_D");
}

TEST(LinearTotals, OtherSystemsHaveNone) {
  for (const std::string name : {"lorenz", "van_der_pol", "henon_heiles", "double_pendulum", "harmonic_oscillator"})
    EXPECT_THAT(linear_totals(*make_system(name)), IsEmpty()) << name;
}

std::shared_ptr<const System> held(const std::shared_ptr<const System>& system, const std::vector<double>& place,
                                   const std::map<std::string, double>& values = {}) {
  return without_totals(system, linear_totals(*system), {.values = values, .place = place, .moving = {}});
}

TEST(LinearTotals, AreHeldAtWhatTheStateHas) {
  const std::vector<double> state{2.0, 3e8, 0.5, 4.0, 1e-3};
  for (const auto& ring : {whole<Ring<false>>(), whole<Ring<true>>()}) {
    const auto system = held(ring, state);
    EXPECT_EQ(system->dimension(), 3);
    EXPECT_TRUE(system->structure().dissipative);
    EXPECT_THAT(system->structure().conserved, IsEmpty());
    // The large ones follow: a small one would be the difference of large ones.
    EXPECT_THAT(system->info().state_names, ElementsAre("A", "C", "E"));
    EXPECT_EQ(system->parameters().at("total_A"), 3e8 + 2.5);
    EXPECT_THAT(system->info().meaning, HasSubstr("total_A = A + B + C"));
    EXPECT_THAT(whole_state(*system, reduced_state(*system, state)), Pointwise(DoubleNear(1e-15), state));
  }
  EXPECT_EQ(held(whole<Ring<true>>(), state)->parameters().at("mass"), 4.0 + 2e-3 + 7.0);
  EXPECT_EQ(held(whole<Epidemic>(), {1.0, 2.0, 3.0}, {{"total_S", 5.0}})->parameters().at("total_S"), 5.0);
}

TEST(LinearTotals, TheRestMovesAsTheWhole) {
  const std::vector<double> state{2.0, 3.0, 0.5, 4.0, 1.0};
  for (const auto& ring : {whole<Ring<false>>(), whole<Ring<true>>()}) {
    const auto system = held(ring, state);
    const std::vector<double> y = reduced_state(*system, state);
    VectorXd f(5), g(3);
    ring->field(1, state.data(), f.data());
    system->field(1, y.data(), g.data());
    for (int i = 0; i < 3; ++i) {
      const auto& all = ring->info().state_names;
      const auto at = std::find(all.begin(), all.end(), system->info().state_names[static_cast<std::size_t>(i)]);
      EXPECT_NEAR(g(i), f(at - all.begin()), 1e-15 * f.norm());
    }
    RowMajor jacobian(3, 3);
    system->field_jacobian(1, y.data(), g.data(), jacobian.data());
    constexpr double step = 1e-5;
    for (int l = 0; l < 3; ++l) {
      std::vector<double> up = y, down = y;
      up[static_cast<std::size_t>(l)] += step;
      down[static_cast<std::size_t>(l)] -= step;
      VectorXd a(3), b(3);
      system->field(1, up.data(), a.data());
      system->field(1, down.data(), b.data());
      EXPECT_NEAR((jacobian.col(l) - (a - b) / (2.0 * step)).norm(), 0.0, 1e-9 * jacobian.norm());
    }
    for (const std::string name : {"total_A", "k"}) {
      const double value = system->parameters().at(name);
      VectorXd slope(3), a(3), b(3);
      system->parameter_derivatives(name, 1, y.data(), slope.data());
      system->with_parameters({{name, value + step}})->field(1, y.data(), a.data());
      system->with_parameters({{name, value - step}})->field(1, y.data(), b.data());
      EXPECT_GT(slope.norm(), 0.0);
      EXPECT_NEAR((slope - (a - b) / (2.0 * step)).norm(), 0.0, 1e-9 * a.norm()) << name;
    }
  }
}

}  // namespace
}  // namespace orbweaver::systems::linear_totals_test
