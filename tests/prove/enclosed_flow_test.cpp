#include "enclosed_flow.hpp"

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include <gmock/gmock.h>

#include "orbweaver/model/recorded.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/systems/registry.hpp"

namespace orbweaver::prove::enclosed_flow_test {
namespace {

using model::Recorded;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// x' = f(x) with one coordinate: f and f' are given.
systems::Formulas formulas_of(const std::function<Recorded(Recorded)>& f,
                              const std::function<Recorded(Recorded)>& slope) {
  model::Recording recording;
  systems::Formulas formulas;
  formulas.dimension = 1;
  const Recorded x = recording.input(0);
  formulas.field = {f(x).node()};
  formulas.variations = {(slope(x) * recording.input(1)).node()};
  formulas.graph = recording.graph();
  return formulas;
}

systems::Formulas formulas_of_system(const std::string& name, const std::map<std::string, double>& parameters) {
  return dynamic_cast<const systems::FormulaSystem&>(*systems::make_system(name, parameters)).formulas();
}

/// An equation in one coordinate that is solved in closed form.
struct Solved {
  const char* name;
  std::function<Recorded(Recorded)> f;
  std::function<Recorded(Recorded)> slope;
  std::function<Ball(const Ball&, const Ball&)> at;  ///< of the start and the time
  std::function<Ball(const Ball&, const Ball&)> derivative;
};

const std::vector<Solved>& solved() {
  const auto one = [] { return Ball(1.0); };
  const auto two = [] { return Ball(2.0); };
  static const std::vector<Solved> equations{
      {"x^2", [](Recorded x) { return x * x; }, [](Recorded x) { return x * 2.0; },
       [one](const Ball& x, const Ball& t) { return x / (one() - x * t); },
       [one](const Ball& x, const Ball& t) { return one() / ((one() - x * t) * (one() - x * t)); }},
      {"1/x", [](Recorded x) { return 1.0 / x; }, [](Recorded x) { return -1.0 / (x * x); },
       [two](const Ball& x, const Ball& t) { return sqrt(x * x + two() * t); },
       [two](const Ball& x, const Ball& t) { return x / sqrt(x * x + two() * t); }},
      {"sqrt x", [](Recorded x) { return sqrt(x); }, [](Recorded x) { return 0.5 / sqrt(x); },
       [two](const Ball& x, const Ball& t) { return (sqrt(x) + t / two()) * (sqrt(x) + t / two()); },
       [two](const Ball& x, const Ball& t) { return (sqrt(x) + t / two()) / sqrt(x); }},
      {"exp x", [](Recorded x) { return exp(x); }, [](Recorded x) { return exp(x); },
       [](const Ball& x, const Ball& t) { return -log(exp(-x) - t); },
       [](const Ball& x, const Ball& t) { return exp(-x) / (exp(-x) - t); }},
      {"sin x", [](Recorded x) { return sin(x); }, [](Recorded x) { return cos(x); },
       [two](const Ball& x, const Ball& t) { return two() * atan(sin(x / two()) / cos(x / two()) * exp(t)); },
       [two, one](const Ball& x, const Ball& t) {
         const Ball c = cos(x / two());
         const Ball s = sin(x / two());
         return exp(t) / (c * c + s * s * exp(two() * t)) * one();
       }},
      {"x log x", [](Recorded x) { return x * log(x); }, [](Recorded x) { return log(x) + 1.0; },
       [](const Ball& x, const Ball& t) { return exp(log(x) * exp(t)); },
       [](const Ball& x, const Ball& t) { return exp(log(x) * exp(t)) * exp(t) / x; }},
      {"x^-0.5", [](Recorded x) { return pow(x, -0.5); }, [](Recorded x) { return pow(x, -1.5) * -0.5; },
       [](const Ball& x, const Ball& t) { return pow(pow(x, Ball(1.5)) + Ball(1.5) * t, Ball(2.0) / Ball(3.0)); },
       [](const Ball& x, const Ball& t) {
         return sqrt(x) * pow(pow(x, Ball(1.5)) + Ball(1.5) * t, Ball(-1.0) / Ball(3.0));
       }}};
  return equations;
}

// From a point and from a box, with few digits, so that what the series leave out is large, and with many.
TEST(EnclosedFlow, HoldsSolutionsInClosedForm) {
  for (const Solved& equation : solved())
    for (const double digits : {1.0, 3.0, 12.0, 40.0}) {
      const WorkingBits working(260);
      EnclosedFlow flow(formulas_of(equation.f, equation.slope), {}, digits);
      const Ball time = Ball::of_decimal("0.3");  // e^x ends at 0.47
      for (const double width : {0.0, 0.02}) {
        const BallVector box{Ball(0.75).widened(Ball(width))};
        const EnclosedFlow::Image image = flow.advance(box, time);
        for (const double place : {-1.0, -0.3, 0.0, 1.0}) {
          const Ball start(0.75 + place * width);
          EXPECT_TRUE(image.state[0].contains(equation.at(start, time).middle())) << equation.name << ' ' << digits;
          EXPECT_TRUE(image.transition.at(0, 0).contains(equation.derivative(start, time).middle()))
              << equation.name << ' ' << digits;
        }
        if (width == 0.0) {
          EXPECT_LT(image.state[0].radius().upper(), 1e3 * std::pow(10.0, -digits)) << equation.name;
        } else {  // not much wider than what comes of the box
          const double exact = (equation.at(Ball(0.77), time) - equation.at(Ball(0.73), time)).upper() / 2.0;
          EXPECT_LT(image.state[0].radius().upper(), 1.3 * exact + std::pow(10.0, 1.0 - digits)) << equation.name;
        }
      }
    }
}

// For all times of a ball, those before the last step's start among them.
TEST(EnclosedFlow, HoldsAnIntervalOfTimes) {
  const WorkingBits working(128);
  const Solved& equation = solved().front();
  EnclosedFlow flow(formulas_of(equation.f, equation.slope), {}, 20.0);
  const Ball time = Ball(0.7).widened(Ball(0.02));
  const EnclosedFlow::Image image = flow.advance({Ball(0.75)}, time);
  for (const double t : {0.68, 0.7, 0.72}) {
    EXPECT_TRUE(image.state[0].contains(equation.at(Ball(0.75), Ball(t)).middle())) << t;
    EXPECT_TRUE(image.transition.at(0, 0).contains(equation.derivative(Ball(0.75), Ball(t)).middle())) << t;
  }
  EXPECT_THROW(static_cast<void>(flow.advance({Ball(0.75)}, Ball(0.3).widened(Ball(0.29)))), NotProven);
  EXPECT_THROW(static_cast<void>(flow.advance({Ball(0.75)}, Ball(-1.0))), NotProven);
}

// x/(1 - x t) has a pole at 1/x.
TEST(EnclosedFlow, DoesNotCrossAPole) {
  const WorkingBits working(128);
  const Solved& equation = solved().front();
  EnclosedFlow flow(formulas_of(equation.f, equation.slope), {}, 20.0);
  flow.limit_steps(10000);
  EXPECT_THROW(static_cast<void>(flow.advance({Ball(0.75)}, Ball(1.4))), NotProven);
  // Nor does any of a box that has one with a pole.
  EXPECT_THROW(static_cast<void>(flow.advance({Ball(0.75).widened(Ball(0.1))}, Ball(1.25))), NotProven);
  EXPECT_THROW(static_cast<void>(flow.analytic_disc({Ball(1.0) / Ball(0.0)}, 0.1)), NotProven);
}

// On its disc a solution stays as near its start as the bound says, in the complex plane too.
TEST(EnclosedFlow, BoundsSolutionsOnComplexDiscs) {
  const WorkingBits working(128);
  const Solved& equation = solved().front();
  const EnclosedFlow flow(formulas_of(equation.f, equation.slope), {}, 20.0);
  const EnclosedFlow::Disc disc = flow.analytic_disc({Ball(0.75)}, 10.0);
  const double radius = disc.radius.upper();
  EXPECT_LT(radius, 1.0 / 0.75);
  EXPECT_GT(radius, 0.2);
  for (int n = 0; n < 16; ++n) {
    const std::complex<double> t = std::polar(radius, 2.0 * std::numbers::pi * n / 16);
    const std::complex<double> one(1.0);
    EXPECT_LE(std::abs(0.75 / (one - 0.75 * t) - 0.75), disc.departure[0].upper()) << n;
    EXPECT_LE(std::abs(one / ((one - 0.75 * t) * (one - 0.75 * t)) - one), disc.growth.at(0, 0).upper()) << n;
  }
}

// q'' = -omega^2 q: the transition matrix over any time is a rotation, that over the period the identity.
TEST(EnclosedFlow, HoldsTheMultipliersOfTheHarmonicOscillator) {
  const WorkingBits working(200);
  const Ball omega = Ball::of_decimal("0.1");
  EnclosedFlow flow(formulas_of_system("harmonic_oscillator", {{"omega", 0.1}}), {omega}, 40.0);
  const Ball period = Ball(20.0) * Ball::pi();
  const EnclosedFlow::Image once = flow.advance({Ball(1.0).widened(Ball(0.25)), Ball::around_zero(Ball(0.01))}, period);
  for (const std::size_t i : {0U, 1U})
    for (const std::size_t c : {0U, 1U}) {
      EXPECT_TRUE(once.transition.at(i, c).contains(Ball(i == c ? 1.0 : 0.0)));
      EXPECT_LT(once.transition.at(i, c).radius().upper(), 1e-33);
    }
  EXPECT_TRUE(once.state[0].contains(Ball(1.25)) && once.state[0].contains(Ball(0.75)));
  EXPECT_LT(once.state[0].radius().upper(), 0.2501);  // a box that turns does not grow
  const Ball time = Ball::of_decimal("7.3");
  const EnclosedFlow::Image image = flow.advance({Ball(1.0), Ball(0.0)}, time);
  EXPECT_TRUE(image.transition.at(0, 0).contains(cos(omega * time).middle()));
  EXPECT_TRUE(image.transition.at(0, 1).contains((sin(omega * time) / omega).middle()));
  EXPECT_TRUE(image.transition.at(1, 0).contains((-(omega * sin(omega * time))).middle()));
}

TEST(EnclosedFlow, RefusesFunctionsWhoseBranchesItDoesNotKnow) {
  const WorkingBits working(128);
  EnclosedFlow flow(formulas_of([](Recorded x) { return atan(x); }, [](Recorded x) { return 1.0 / (1.0 + x * x); }), {},
                    10.0);
  EXPECT_THAT([&] { static_cast<void>(flow.advance({Ball(0.5)}, Ball(0.1))); },
              ThrowsMessage<NotProven>(HasSubstr("no time is short enough")));
}

}  // namespace
}  // namespace orbweaver::prove::enclosed_flow_test
