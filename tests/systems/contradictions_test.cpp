// Models that contradict their structure are refused, each for the identity that it breaks.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/identities.hpp"
#include "orbweaver/systems/registry.hpp"
#include "support/delegating_system.hpp"
#include "support/stated_system.hpp"
#include "systems/samples.hpp"

namespace orbweaver::systems::contradictions_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Another system with another structure, and with something added to the field at a state.
class Altered final : public test::DelegatingSystem {
 public:
  using Addition = std::function<void(const std::vector<double>& z, double* f)>;

  Altered(std::shared_ptr<const System> system, const std::function<void(Structure&)>& alter, Addition addition = {})
      : DelegatingSystem(std::move(system)), _structure(whole().structure()), _addition(std::move(addition)) {
    if (alter) alter(_structure);
  }
  [[nodiscard]] const Structure& structure() const override { return _structure; }
  void field(std::size_t nodes, const double* z, double* f) const override {
    whole().field(nodes, z, f);
    if (_addition) add_at(z, f);
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    whole().field_jacobian(nodes, z, f, jacobian);
    if (!_addition) return;
    add_at(z, f);
    const auto d = static_cast<std::size_t>(dimension());
    constexpr double h = 1e-6;
    for (std::size_t l = 0; l < d; ++l)
      for (const double sign : {1.0, -1.0}) {
        std::vector<double> beside(z, z + d);
        std::vector<double> added(d, 0.0);
        beside[l] += sign * h;
        _addition(beside, added.data());
        for (std::size_t i = 0; i < d; ++i) jacobian[i * d + l] += sign * added[i] / (2.0 * h);
      }
  }

 private:
  void add_at(const double* z, double* f) const { _addition({z, z + dimension()}, f); }

  Structure _structure;
  Addition _addition;
};

// Newton's method leaves velocities of 1e-32, and derivatives that would be 0 are of that size.
const std::vector<std::vector<double>> pendulum_rests{{0, 0, 0, 0}, {0, std::numbers::pi, 8e-33, 8.6e-34}};
const std::vector<std::vector<double>> well{{0, 0, 0, 0}};

void expect_refusal(const System& system, const std::vector<std::vector<double>>& equilibria,
                    const std::vector<std::string>& parts) {
  for (const std::string& part : parts)
    EXPECT_THAT(([&] { require_identities(system, equilibria); }),
                ThrowsMessage<core::InputError>(AllOf(HasSubstr("contradicts its structure"), HasSubstr(part))));
}

TEST(Contradictions, ThereAreNoneInRegisteredSystems) {
  EXPECT_NO_THROW(require_identities(*make_system("double_pendulum"), pendulum_rests));
  // Its Jacobian's eigenvalues pair at equilibria only.
  EXPECT_NO_THROW(require_identities(*make_system("double_pendulum"), pendulum_rests, {{1.7, 0, 0, 1.1}}));
  EXPECT_NO_THROW(require_identities(*make_system("henon_heiles"), {{0, 0, 0, 0}, {0, 1, 0, 0}}));
  EXPECT_NO_THROW(require_identities(*make_system("swinging_spring"), {{0, -4.0 / 3.0, 0, 0}}));
  const double mu = 0.01215058560962404;
  EXPECT_NO_THROW(require_identities(*make_system("pcr3bp"), {{0.5 - mu, std::sqrt(0.75), 0, 0}}));
}

// Proportions and units far from 1 cost digits, not as many as the bound leaves.
TEST(Contradictions, ExtremeParametersAreNone) {
  for (const double factor : {1e-6, 1e-3, 1e3, 1e6})
    for (const std::string name : {"double_pendulum", "henon_heiles", "swinging_spring", "harmonic_oscillator"})
      for (const Parameter& parameter : model_info(name).parameters) {
        const auto system = make_system(name, {{parameter.name, factor * parameter.standard}});
        std::vector<double> rest(static_cast<std::size_t>(system->dimension()), 0.0);
        if (name == "swinging_spring") {
          const auto& p = system->parameters();
          rest[1] = -(p.at("length") + p.at("mass") * p.at("gravity") / p.at("stiffness"));
        }
        const double size = std::max(1.0, -*std::min_element(rest.begin(), rest.end()));
        for (const IdentityError& found :
             identity_errors(*system, states_around(system->structure(), {rest}, 20, size)))
          EXPECT_LE(found.error, 1e-12) << name << " " << parameter.name << " " << factor << ": " << found.identity;
        EXPECT_LE(pairing_error(*system, rest).error, 1e-12) << name << " " << parameter.name << " " << factor;
      }
}

TEST(Contradictions, AWrongSignInAForce) {
  const auto pull = [](const std::vector<double>& z, double* f) { f[2] += 2e-6 * z[0] * z[0]; };
  expect_refusal(Altered(make_system("henon_heiles"), {}, pull), well,
                 {"grad Q . f = 0 for the conserved quantity Q = energy", "got a relative difference of", "at x = "});
}

TEST(Contradictions, ASignMissingInAReversor) {
  const auto spoil = [](Structure& structure) { structure.reversors.front().map.matrix(3, 3) *= -1.0; };
  const auto system = make_system("double_pendulum");
  expect_refusal(Altered(system, spoil), pendulum_rests,
                 {"expected f(" + system->structure().reversors.front().name + " z) = -"});
}

TEST(Contradictions, AWrongMirror) {
  const auto mirror = [](Structure& structure) {
    Eigen::Matrix4d other = Eigen::Vector4d(1, -1, 1, -1).asDiagonal();
    structure.equivariances = {{"M", other}};
  };
  expect_refusal(Altered(make_system("henon_heiles"), mirror), well, {"expected f(M z) = M f(z)"});
}

TEST(Contradictions, ASymmetryThatTurnsTheEnergyOver) {
  // Two oscillators of opposite energies change places: the field allows that, and the energy changes its sign.
  class Opposite final : public test::StatedSystem {
   public:
    Opposite() : StatedSystem(described()) {}
    void field(std::size_t, const double* z, double* f) const override {
      f[0] = z[1];
      f[1] = -z[0];
      f[2] = -z[3];
      f[3] = z[2];
    }
    void field_jacobian(std::size_t, const double* z, double* f, double* jacobian) const override {
      field(1, z, f);
      std::fill_n(jacobian, 16, 0.0);
      jacobian[1] = jacobian[14] = 1.0;
      jacobian[4] = jacobian[11] = -1.0;
    }
    [[nodiscard]] double conserved(int, std::span<const double> z) const override {
      return 0.5 * (z[0] * z[0] + z[1] * z[1] - z[2] * z[2] - z[3] * z[3]);
    }
    void conserved_gradient(int, std::span<const double> z, std::span<double> gradient) const override {
      for (std::size_t i = 0; i < 4; ++i) gradient[i] = i < 2 ? z[i] : -z[i];
    }

   private:
    static Structure described() {
      Structure structure = test::structure_of(4, true, true);
      Eigen::Matrix4d swap = Eigen::Matrix4d::Zero();
      swap(0, 2) = swap(2, 0) = 1.0;
      swap(1, 3) = swap(3, 1) = -1.0;
      structure.equivariances = {{"X", swap}};
      return structure;
    }
  };
  expect_refusal(Opposite(), well, {"expected equal energy of X z and z"});
}

TEST(Contradictions, AnAngleThatIsNone) {
  const auto angle = [](Structure& structure) { structure.angles = {1}; };
  expect_refusal(Altered(make_system("henon_heiles"), angle), well, {"the period 2 pi in the angle y"});
}

TEST(Contradictions, FrictionThatIsCalledSymplectic) {
  const auto drag = [](const std::vector<double>& z, double* f) { f[2] -= 1e-3 * z[2]; };
  const auto ideal = [](Structure& structure) {
    structure.conserved.clear();
    structure.reversors.clear();
    structure.equivariances.clear();
  };
  expect_refusal(Altered(make_system("henon_heiles"), ideal, drag), well,
                 {"expected eigenvalues of the Jacobian in pairs +-lambda", "at x = 0, y = 0"});
  const auto dissipative = [&](Structure& structure) {
    ideal(structure);
    structure.symplectic = false;
  };
  EXPECT_NO_THROW(require_identities(Altered(make_system("henon_heiles"), dissipative, drag), well));
}

TEST(Contradictions, AGuardThatIsNotPositive) {
  class Guarded final : public test::DelegatingSystem {
   public:
    Guarded() : DelegatingSystem(make_system("swinging_spring")) {}
    [[nodiscard]] double guard(int, std::span<const double> z) const override { return z[1]; }
  };
  expect_refusal(Guarded(), {{0, -4.0 / 3.0, 0, 0}}, {"expected the guard r to be positive, got -1.33333"});
}

// A spring of 1000 km: the pull of its length is unseen in motions of a metre.
TEST(Contradictions, StatesAreOfTheSizeOfTheCoordinatesToo) {
  const auto spring = make_system("swinging_spring", {{"length", 1e6}, {"gravity", 1e6}});
  const auto pull = [](const std::vector<double>& z, double* f) { f[2] += 1e-12 * z[0] * z[0]; };
  const std::vector<std::vector<double>> rest{{0, -4e6 / 3.0, 0, 0}};
  EXPECT_NO_THROW(require_identities(*spring, rest));
  expect_refusal(Altered(spring, {}, pull), rest, {"got a relative difference of"});
}

// What is not declared contradicts nothing, but is asked for.
TEST(Contradictions, ASymplecticFormThatIsNotDeclaredShowsInPairs) {
  const auto undeclared = [](Structure& structure) { structure.symplectic = false; };
  const std::vector<std::vector<double>> rest{{0, 0, 0, 0}};
  const auto system = make_system("henon_heiles");
  EXPECT_TRUE(may_be_symplectic(Altered(system, undeclared), rest));
  EXPECT_FALSE(may_be_symplectic(*system, rest)) << "it is declared";
  EXPECT_FALSE(may_be_symplectic(Altered(system, undeclared), {})) << "nothing is known";
  const auto friction = [](const std::vector<double>& z, double* f) { f[2] -= 1e-6 * z[2]; };
  EXPECT_FALSE(may_be_symplectic(Altered(system, undeclared, friction), rest)) << "no pairs";
  EXPECT_FALSE(may_be_symplectic(*make_system("lorenz"), {{0, 0, 0}})) << "it conserves nothing";
  const auto without_energy = [](Structure& structure) {
    structure.symplectic = false;
    structure.conserved.clear();
  };
  EXPECT_TRUE(may_be_symplectic(Altered(system, without_energy), rest)) << "its energy is not named either";
  const auto reversible = [](const std::vector<double>& z, double* f) { f[2] += 1e-6 * z[0] * z[2] * z[2]; };
  EXPECT_FALSE(may_be_symplectic(Altered(system, without_energy, reversible), rest))
      << "pairs at rest, where no volume is kept elsewhere";
}

}  // namespace
}  // namespace orbweaver::systems::contradictions_test
