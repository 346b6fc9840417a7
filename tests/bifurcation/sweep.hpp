#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "orbweaver/bifurcation/detector.hpp"
#include "orbweaver/bifurcation/test_functions.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::test {

/// The stability of the family's orbit at a position.
using StabilityAt = std::function<spectrum::Stability(double position)>;

struct Event {
  bifurcation::TestFunction function;
  double position;
  bool tangency;
  bool genuine;  ///< is_event
};

struct Detection {
  std::vector<Event> events;  ///< located, in the order found
  int probes = 0;             ///< of the detector
};

/// Runs the detector over the points and locates what it brackets.
inline Detection detect(const systems::Structure& system, const StabilityAt& stability_at,
                        const std::vector<bifurcation::TestFunction>& functions, const std::vector<double>& positions,
                        double tolerance) {
  using namespace bifurcation;
  const auto point = [&](double position) -> std::optional<TestPoint> {
    const spectrum::Stability stability = stability_at(position);
    TestPoint out{position, {}};
    for (const TestFunction& function : functions) out.readings.push_back(evaluate(function, system, stability));
    return out;
  };
  Detection result;
  Detector detector;
  const auto probe = [&](double position) {
    ++result.probes;
    return point(position);
  };
  std::vector<Bracket> brackets;
  const auto append = [&](const std::vector<Bracket>& found) {
    brackets.insert(brackets.end(), found.begin(), found.end());
  };
  for (const double position : positions) append(detector.advance(*point(position), probe));
  append(detector.finish(probe));
  for (const Bracket& bracket : brackets) {
    const TestFunction& function = functions[bracket.function];
    const auto value = [&](double position) { return evaluate(function, system, stability_at(position)).value; };
    const auto located = bracket.tangency
                             ? numerics::locate_minimum([&](double position) { return std::abs(value(position)); },
                                                        bracket.from, bracket.to, tolerance)
                             : numerics::locate_root(value, bracket.from, bracket.to, tolerance);
    if (!located) {
      ADD_FAILURE() << "nothing located in [" << bracket.from << ", " << bracket.to << "]";
      continue;
    }
    const bool is_one = is_event(function, system, stability_at(located->position), bracket.tangency) == true;
    result.events.push_back({function, located->position, bracket.tangency, is_one});
  }
  return result;
}

}  // namespace orbweaver::test
