// The families of a well whose frequencies are nearly in the ratio 1:3.
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "continuation/families.hpp"
#include "support/dual_derivatives.hpp"
#include "orbweaver/bifurcation/family_jump.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "support/stated_system.hpp"

namespace near_resonance_test {
namespace {

using namespace orbweaver;
using continuation::Options;
using continuation::Orbit;

/// A particle in a well without symmetries, whose reversor is not declared: the orbits turn nowhere.
class Well final : public test::StatedSystem {
 public:
  Well() : StatedSystem(test::structure_of(4, true, true)) {}
  void field(std::size_t nodes, const double* z, double* f) const override { evaluate(nodes, z, f, nullptr); }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    evaluate(nodes, z, f, jacobian);
  }
  void second_derivatives(std::size_t nodes, const double* z, const double* weights, double* out) const override {
    for (std::size_t n = 0; n < nodes; ++n) {
      const auto found = ad::second_derivatives<4>(Field{}, at(nodes, n, z).data(), at(nodes, n, weights).data());
      for (std::size_t i = 0; i < 16; ++i) out[i * nodes + n] = found[i];
    }
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    const double x = z[0];
    const double y = z[1];
    return 0.5 * (z[2] * z[2] + z[3] * z[3] + x * x + stiff * y * y) + a1 * x * x * x / 3.0 + a2 * x * x * y +
           a3 * x * y * y + a4 * y * y * y / 3.0 + 0.25 * q * (x * x * x * x + y * y * y * y + 2.0 * c * x * x * y * y);
  }
  void conserved_gradient(int, std::span<const double> z, std::span<double> gradient) const override {
    std::vector<double> f(4);
    field(1, z.data(), f.data());
    gradient[0] = -f[2];
    gradient[1] = -f[3];
    gradient[2] = z[2];
    gradient[3] = z[3];
  }

 private:
  static constexpr double stiff = 9.0009;
  static constexpr double a1 = -0.0272;
  static constexpr double a2 = 0.43;
  static constexpr double a3 = -0.4352;
  static constexpr double a4 = -0.183;
  static constexpr double q = 0.42;
  static constexpr double c = 1.19;

  struct Field {
    template <class S>
    void operator()(const S* z, S* f) const {
      const S x = z[0];
      const S y = z[1];
      f[0] = z[2];
      f[1] = z[3];
      f[2] = (x + x * x * a1 + x * y * (2.0 * a2) + y * y * a3 + (x * x * x + x * y * y * c) * q) * -1.0;
      f[3] = (y * stiff + x * x * a2 + x * y * (2.0 * a3) + y * y * a4 + (y * y * y + x * x * y * c) * q) * -1.0;
    }
  };

  static std::array<double, 4> at(std::size_t nodes, std::size_t n, const double* values) {
    return {values[n], values[nodes + n], values[2 * nodes + n], values[3 * nodes + n]};
  }

  static void evaluate(std::size_t nodes, const double* z, double* f, double* jacobian) {
    for (std::size_t n = 0; n < nodes; ++n) {
      const auto found = ad::field_jacobian<4>(Field{}, at(nodes, n, z).data());
      for (std::size_t i = 0; i < 4; ++i) f[i * nodes + n] = found.value[i];
      for (std::size_t i = 0; jacobian != nullptr && i < 16; ++i) jacobian[i * nodes + n] = found.jacobian[i];
    }
  }
};

/// The slow oscillation from the equilibrium on, through three turns of the fast one and beyond.
struct SlowFamily {
  std::shared_ptr<const systems::System> system = std::make_shared<Well>();
  Options options{};
  std::vector<Orbit> orbits{};

  SlowFamily() {
    continuation::Start start;
    start.base = loop::constant_loop(std::vector<double>(4, 0.0), 2.0 * std::numbers::pi, 10);
    start.direction.modes.assign(start.base.modes.size(), 0.0);
    start.direction.modes[4] = 1.0;
    start.direction.modes[10] = -1.0;
    Options held = options;
    held.largest_step = 0.002;
    held.jumped = [this](const Orbit& from, const Orbit& to) { return jumped(from, to); };
    (void)continuation::trace(system, start, held, [this](const Orbit& orbit) {
      orbits.push_back(orbit);
      return orbit.energy < 0.01;
    });
  }

  [[nodiscard]] bool jumped(const Orbit& from, const Orbit& to) const {
    const spectrum::Stability before = spectrum::floquet(*system, from.loop, {});
    const spectrum::Stability after = spectrum::floquet(*system, to.loop, {});
    return bifurcation::has_jumped(system, {}, options, {from, before}, {to, after});
  }

  /// Where the energy is highest between the two ways.
  [[nodiscard]] std::size_t highest() const {
    std::size_t n = 0;
    while (n + 1 < orbits.size() && orbits[n + 1].energy > orbits[n].energy) ++n;
    return n;
  }
};

// Up to E = 0.00152 and down again to a fold at E = 0.000236, near which the way up, half a period of the fast
// oscillation later, passes at a distance of a seventh of the step that is asked. Between the two orbits the index
// passes 2 and the energy turns, as at the fold.
TEST(NearResonance, AStepOverAWideGapBesideAFoldIsTakenBack) {
  const SlowFamily family;
  ASSERT_GT(family.orbits.back().energy, 0.01);
  const std::size_t top = family.highest();
  ASSERT_NEAR(family.orbits[top].energy, 0.0015, 1e-4);
  int pairs = 0;
  for (std::size_t n = 0; n < top; ++n)
    for (std::size_t m = top; family.orbits[m].energy > 0.0004; ++m) {
      const Orbit& up = family.orbits[n];
      Orbit down = family.orbits[m];
      if (up.energy > 0.0004 || down.energy > 0.0009) continue;
      const auto& structure = family.system->structure();
      down.loop = loop::aligned(down.loop, loop::align(structure, down.loop, up.loop));
      EXPECT_TRUE(family.jumped(down, up)) << down.energy << " and " << up.energy;
      ++pairs;
    }
  EXPECT_GT(pairs, 4);
}

}  // namespace
}  // namespace near_resonance_test
