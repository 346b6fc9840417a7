#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "loop/samples.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/linearization.hpp"
#include "support/stated_system.hpp"

namespace orbweaver::loss::not_finite_test {
namespace {

using ::testing::HasSubstr;
using Order = Linearization::Order;

constexpr double limit = 0.9;

// dq/dt = p, dp/dt = -q; where q > limit one of the functions gives `bad` instead.
class Fenced final : public test::StatedSystem {
 public:
  enum class Where { field, jacobian, second };
  Fenced(Where where, double bad) : StatedSystem(test::structure_of(2), "fenced"), _where(where), _bad(bad) {}

  void field(std::size_t nodes, const double* z, double* f) const override {
    for (std::size_t j = 0; j < nodes; ++j) {
      f[j] = z[nodes + j];
      f[nodes + j] = _where == Where::field && z[j] > limit ? _bad : -z[j];
    }
  }

  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    field(nodes, z, f);
    for (std::size_t j = 0; j < nodes; ++j) {
      jacobian[j] = jacobian[3 * nodes + j] = 0.0;
      jacobian[nodes + j] = 1.0;
      jacobian[2 * nodes + j] = _where == Where::jacobian && z[j] > limit ? _bad : -1.0;
    }
  }

  void second_derivatives(std::size_t nodes, const double* z, const double*, double* contracted) const override {
    for (std::size_t m = 0; m < 4; ++m)
      for (std::size_t j = 0; j < nodes; ++j)
        contracted[m * nodes + j] = _where == Where::second && z[j] > limit ? _bad : 0.0;
  }

 private:
  Where _where;
  double _bad;
};

loop::Loop circle(double radius) {
  loop::Loop loop = loop::constant_loop(std::vector<double>{0.0, 0.0}, 7.0, 7);
  loop.sine(1, 0) = radius;
  loop.cosine(1, 1) = radius;
  return loop;
}

std::string message_of(const systems::System& system, const loop::Loop& loop, Order order) {
  try {
    const Linearization here(system, loop, order);
  } catch (const core::NotFiniteError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

// The first node of N = 30 at which sin s > 0.9 is the sixth.
constexpr int first_bad = 6;

TEST(NotFinite, FieldIsReportedWithItsPlace) {
  const Fenced fenced(Fenced::Where::field, std::numeric_limits<double>::quiet_NaN());
  const double s = test::two_pi * first_bad / 30;
  ASSERT_LT(std::sin(test::two_pi * (first_bad - 1) / 30), limit);
  ASSERT_GT(std::sin(s), limit);
  for (const Order order : {Order::residual, Order::jacobian, Order::second}) {
    const std::string message = message_of(fenced, circle(1.0), order);
    EXPECT_THAT(message, HasSubstr("the vector field of fenced is not finite (nan)"));
    EXPECT_THAT(message, HasSubstr(fmt::format("at t = {:.6g} ", 7.0 * first_bad / 30)));
    EXPECT_THAT(message, HasSubstr("T = 7,"));
    EXPECT_THAT(message, HasSubstr(fmt::format("state ({:.6g}, {:.6g})", std::sin(s), std::cos(s))));
    EXPECT_THAT(message, HasSubstr("start from another guess or take smaller steps"));
  }
}

TEST(NotFinite, InfinityCountsToo) {
  const Fenced fenced(Fenced::Where::field, -std::numeric_limits<double>::infinity());
  EXPECT_THAT(message_of(fenced, circle(1.0), Order::residual), HasSubstr("not finite (-inf)"));
}

TEST(NotFinite, DerivativesAreCheckedWhereTheyAreUsed) {
  const Fenced jacobian(Fenced::Where::jacobian, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NO_THROW(Linearization(jacobian, circle(1.0), Order::residual));
  EXPECT_THAT(message_of(jacobian, circle(1.0), Order::jacobian), HasSubstr("the Jacobian of fenced"));
  EXPECT_THAT(message_of(jacobian, circle(1.0), Order::jacobian),
              HasSubstr(fmt::format("t = {:.6g} ", 7.0 * first_bad / 30)));
  const Fenced second(Fenced::Where::second, std::numeric_limits<double>::infinity());
  EXPECT_NO_THROW(Linearization(second, circle(1.0), Order::jacobian));
  EXPECT_THAT(message_of(second, circle(1.0), Order::second), HasSubstr("the second derivative of fenced"));
}

TEST(NotFinite, LoopsInsideTheFenceAreFine) {
  const Fenced fenced(Fenced::Where::field, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NO_THROW(Linearization(fenced, circle(0.8), Order::second));
}

TEST(NotFinite, IsANumericalError) {
  const Fenced fenced(Fenced::Where::field, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(Linearization(fenced, circle(1.0), Order::residual), core::NumericalError);
}

}  // namespace
}  // namespace orbweaver::loss::not_finite_test
