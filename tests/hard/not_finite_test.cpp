// NaN and infinities of the field or its derivatives, at one node: whoever meets them says so, and one that passes
// costs a step and nothing else.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "continuation/families.hpp"
#include "corrector/fixture.hpp"
#include "hard/hard_case.hpp"
#include "orbweaver/certificate/certificate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "orbweaver/starts/linear_modes.hpp"
#include "support/delegating_system.hpp"

namespace not_finite_test {
namespace {

using namespace orbweaver;

/// The double pendulum, but the last number of a node's field, or of its Jacobian, is `bad`: of the middle node, from
/// the call `from` on (0: the first), or in that call only.
class Tainted final : public test::DelegatingSystem {
 public:
  enum class Where { field, jacobian };
  Tainted(Where where, double bad, long from, bool once = false)
      : DelegatingSystem(test::pendulum()), _where(where), _bad(bad), _from(from), _once(once) {}

  void field(std::size_t nodes, const double* z, double* f) const override {
    whole().field(nodes, z, f);
    if (_where == Where::field && is_due()) f[3 * nodes + nodes / 2] = _bad;
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    whole().field_jacobian(nodes, z, f, jacobian);
    if (!is_due()) return;
    (_where == Where::field ? f[3 * nodes + nodes / 2] : jacobian[14 * nodes + nodes / 2]) = _bad;
  }
  [[nodiscard]] long calls() const { return _calls; }

 private:
  [[nodiscard]] bool is_due() const {
    const long call = _calls++;
    return _once ? call == _from : call >= _from;
  }
  Where _where;
  double _bad;
  long _from;
  bool _once;
  mutable long _calls = 0;
};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr std::array bad_numbers{not_a_number, infinity, -infinity};
constexpr std::array methods{corrector::Method::automatic, corrector::Method::newton_krylov, corrector::Method::nls,
                             corrector::Method::ntr, corrector::Method::brgn};

std::string named(Tainted::Where where) {
  return fmt::format("NaN, inf and -inf of one node's {}", where == Tainted::Where::field ? "field" : "Jacobian");
}

TEST(NotFiniteNode, IsNoOrbitWhateverTheMethod) {
  const test::Problem problem(test::in_phase(), 0.3, 22);
  for (const auto where : {Tainted::Where::field, Tainted::Where::jacobian}) {
    test::HardCase row(named(where), "no method may accept the loop");
    std::size_t said = 0;
    for (const double bad : bad_numbers)
      for (const auto method : methods) {
        const corrector::Result result = corrector::correct(Tainted(where, bad, 0), problem.guess, problem.unknowns,
                                                            problem.slice(), {.method = method}, problem.normal);
        said += result.outcome == corrector::Outcome::not_finite ? 1 : 0;
      }
    constexpr std::size_t all = bad_numbers.size() * methods.size();
    row.is(said == all, fmt::format("{} times: not finite", all), fmt::format("{}", said));
  }
}

/// How many of the numbers make `action` throw Error.
template <class Error, class Action>
std::size_t thrown(const Action& action) {
  std::size_t count = 0;
  for (const double bad : bad_numbers) {
    try {
      action(bad);
    } catch (const Error&) {
      ++count;
    }
  }
  return count;
}

TEST(NotFiniteNode, IsSaidByWhoIntegrates) {
  const loop::Loop orbit = test::orbit_at(test::family_to_twelve(test::in_phase()), 9.0).loop;
  const loop::Isotropy isotropy = test::pendulum_isotropy(*test::pendulum());
  const auto expect_thrown = [](test::HardCase row, std::size_t count) {
    row.is(count == bad_numbers.size(), "3 errors", fmt::format("{}", count));
  };
  for (const auto where : {Tainted::Where::field, Tainted::Where::jacobian})
    expect_thrown({named(where), "it has no multipliers"}, thrown<core::NotFiniteError>([&](double bad) {
                    (void)spectrum::floquet(Tainted(where, bad, 0), orbit, isotropy);
                  }));
  expect_thrown({named(Tainted::Where::field), "it has no certificate"}, thrown<core::NumericalError>([&](double bad) {
                  (void)certificate::certify(Tainted(Tainted::Where::field, bad, 0), orbit);
                }));
  expect_thrown({named(Tainted::Where::jacobian), "it has no small oscillations"},
                thrown<core::NotFiniteError>([&](double bad) {
                  (void)starts::linear_modes(Tainted(Tainted::Where::jacobian, bad, 0), std::vector<double>(4, 0.0));
                }));
}

// Whenever it comes, the family is the same.
TEST(NotFiniteNode, OnceDoesNotChangeAFamily) {
  continuation::Options options;
  options.period_limit = 9.0;
  const auto count = std::make_shared<const Tainted>(Tainted::Where::field, 0.0, 1L << 60);
  const test::Trace plain = test::trace_of(count, test::start_of(test::in_phase()), options);
  const long calls = count->calls();
  for (const double bad : {not_a_number, infinity}) {
    test::HardCase row(fmt::format("{} once, in each of 23 calls of {}", bad, calls),
                       "energy at T = 9, 30 digits by mpmath");
    double worst = 0.0;
    std::string end;
    for (int n = 0; n < 23; ++n) {
      const auto system = std::make_shared<const Tainted>(Tainted::Where::field, bad, calls * n / 23, true);
      const test::Trace trace = test::trace_of(system, test::start_of(test::in_phase()), options);
      if (trace.ending.reason != continuation::EndReason::period_limit) {
        end = trace.ending.text();
        worst = test::worse(worst, trace.ending.failed() ? 0.0 : infinity);
        continue;
      }
      worst = test::worse(worst, std::abs(trace.last().energy + 0.764030789927984606850110349553));
    }
    row.within(worst, 1e-11);
    test::HardCase(fmt::format("{} once, in each of 23 calls of {}", bad, calls), "a shorter step goes on")
        .is(end.empty(), "23 of 23 families reach T = 9", end.empty() ? "23" : end);
  }
}

}  // namespace
}  // namespace not_finite_test
