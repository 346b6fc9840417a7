// A crossing between orbits of very large indices.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "support/dual_derivatives.hpp"
#include "orbweaver/bifurcation/crossing.hpp"
#include "support/stated_system.hpp"

namespace steep_index_test {
namespace {

using namespace orbweaver;
using bifurcation::Event;
using bifurcation::Sector;
using bifurcation::TestFunction;

constexpr double coupling = 10.0;

/// H = (p_x^2 + p_y^2 + x^2 + coupling x y^2)/2: beside x = A cos t, y = 0 it is Mathieu's equation
/// y'' + coupling A cos(t) y = 0.
class Mathieu final : public test::StatedSystem {
 public:
  Mathieu() : StatedSystem(test::structure_of(4, true, true)) {}
  void field(std::size_t nodes, const double* z, double* f) const override { evaluate(nodes, z, f, nullptr); }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    evaluate(nodes, z, f, jacobian);
  }
  [[nodiscard]] double conserved(int, std::span<const double> z) const override {
    return 0.5 * (z[2] * z[2] + z[3] * z[3] + z[0] * z[0] + coupling * z[0] * z[1] * z[1]);
  }
  void conserved_gradient(int, std::span<const double> z, std::span<double> gradient) const override {
    gradient[0] = z[0] + 0.5 * coupling * z[1] * z[1];
    gradient[1] = coupling * z[0] * z[1];
    gradient[2] = z[2];
    gradient[3] = z[3];
  }

 private:
  struct Field {
    template <class S>
    void operator()(const S* z, S* f) const {
      f[0] = z[2];
      f[1] = z[3];
      f[2] = (z[0] + z[1] * z[1] * (0.5 * coupling)) * -1.0;
      f[3] = z[0] * z[1] * -coupling;
    }
  };

  static void evaluate(std::size_t nodes, const double* z, double* f, double* jacobian) {
    for (std::size_t n = 0; n < nodes; ++n) {
      const std::array<double, 4> at{z[n], z[nodes + n], z[2 * nodes + n], z[3 * nodes + n]};
      const auto found = ad::field_jacobian<4>(Field{}, at.data());
      for (std::size_t i = 0; i < 4; ++i) f[i * nodes + n] = found.value[i];
      for (std::size_t i = 0; jacobian != nullptr && i < 16; ++i) jacobian[i * nodes + n] = found.jacobian[i];
    }
  }
};

loop::Loop swing(double amplitude) {
  loop::Loop loop = loop::constant_loop(std::vector<double>(4, 0.0), 2.0 * std::numbers::pi, 63);
  loop.cosine(1, 0) = amplitude;
  loop.sine(1, 2) = -amplitude;
  return loop;
}

// From -1.4e7 to 3e7 the test function is a step, which halving finds in 29 to 36 orbits. The index is smooth.
TEST(SteepIndex, CrossingsBetweenLargeIndicesAreFoundByTheIndex) {
  const auto system = std::make_shared<Mathieu>();
  continuation::FamilyCurve curve(system, {}, {});
  curve.add(0.0, swing(5.0));
  curve.add(0.4, swing(5.4));
  for (const Sector& sector : {Sector{1, 0}, Sector{2, 1}, Sector{3, 1}, Sector{4, 1}}) {
    SCOPED_TRACE(sector.q);
    int orbits = 0;
    curve.before_each([&] { ++orbits; });
    bifurcation::NotLocated why;
    const Event event{.function = {TestFunction::Kind::sector, sector}};
    const auto found = bifurcation::locate(*system, curve, event, 0.0, 0.4, why);
    ASSERT_TRUE(found) << to_text(why);
    EXPECT_LT(orbits, 20);
    // Mathieu's equation by Runge-Kutta: the index is 0 at coupling A = 51.9022, where it rises by 1.03e7 a unit.
    EXPECT_NEAR(coupling * found->point.loop.cosine(1, 0), 51.9022, 1e-3);
    const bifurcation::Reading deviation = bifurcation::index_deviation(system->structure(), found->stability, sector);
    EXPECT_LT(std::abs(deviation.value), std::max(0.1, bifurcation::error_margin * deviation.error));
  }
}

TEST(SteepIndex, OverLargeIndicesHaveTheSameSigns) {
  const systems::Structure structure = test::structure_of(4, true, true);
  const TestFunction function{TestFunction::Kind::sector, {1, 0}};
  double before = -1.0;
  for (const double index : {-1e13, -1e9, -1.0, 1.9, 2.1, 3.0, 1e9, 1e13}) {
    spectrum::Stability stability;
    stability.fundamental = {index};
    stability.fundamental_error = {0.0};
    const double value = bifurcation::value_over(function, structure, stability, 1e13);
    EXPECT_EQ(std::signbit(value), std::signbit(index - 2.0)) << index;
    EXPECT_GT(value, before) << "the function itself is -1 or 1 from 1e9 on, to rounding";
    before = value;
    EXPECT_EQ(bifurcation::value_over(function, structure, stability, 1.0),
              bifurcation::evaluate(function, structure, stability).value);
  }
}

}  // namespace
}  // namespace steep_index_test
