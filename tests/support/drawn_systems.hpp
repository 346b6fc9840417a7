#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "orbweaver/numerics/random.hpp"

namespace orbweaver::test {

/// A system drawn by chance, as the settings of a scene: the model's text, where its families begin, and what moves.
struct DrawnSystem {
  std::string name;
  std::vector<std::string> settings;
};

/// Draws wells, chains of oscillators, networks of reactions and driven oscillators in turn. The same seed gives
/// the same systems, the first of a longer list among them.
class SystemDrawing {
 public:
  explicit SystemDrawing(std::uint64_t seed) : _random(seed) {}

  [[nodiscard]] std::vector<DrawnSystem> draw(int count) {
    std::vector<DrawnSystem> systems;
    for (int n = 0; n < count; ++n) {
      const std::string name = fmt::format("drawn_{}", n);
      switch (n % 4) {
        case 0: systems.push_back(well(name)); break;
        case 1: systems.push_back(chain(name)); break;
        case 2: systems.push_back(network(name)); break;
        default: systems.push_back(driven(name));
      }
    }
    return systems;
  }

 private:
  /// Three digits, so that texts are short.
  double between(double from, double to) {
    const double value = from + (to - from) * 0.5 * (1.0 + _random());
    return std::stod(fmt::format("{:.3g}", value));
  }

  DrawnSystem well(const std::string& name) {
    const std::string energy =
        fmt::format("(px^2 + py^2)/2 + {}*x^2/2 + {}*y^2/2 + {}*x^2*y + {}*y^3/3 + {}*(x^4 + y^4)/4", between(0.5, 2),
                    between(2.5, 6), between(-0.5, 0.5), between(-0.5, 0.5), between(0.1, 1));
    return {
        name,
        {fmt::format("system={{name: {}, coordinates: [x, y], momenta: [px, py], hamiltonian: \"{}\"}}", name, energy),
         "starts={fixed_points: {grid: [[0], [0], [0], [0]]}}", "limits.steps=8", "survey.depth=0"}};
  }

  DrawnSystem chain(const std::string& name) {
    const int size = 2 + static_cast<int>(between(0, 2.99));
    const std::string zeros = size == 2   ? "[[0], [0], [0], [0]]"
                              : size == 3 ? "[[0], [0], [0], [0], [0], [0]]"
                                          : "[[0], [0], [0], [0], [0], [0], [0], [0]]";
    return {name,
            {fmt::format(
                 "system={{name: {}, sizes: {{n: {}}}, coordinates: \"x[1..n]\", momenta: \"p[1..n]\", "
                 "ends: {{x: {{0: 0, n+1: 0}}}}, hamiltonian: \"sum(i = 1..n, p[i]^2/2 + {}*x[i]^2/2 + {}*x[i]^4/4) "
                 "+ sum(i = 0..n, (x[i+1] - x[i])^2/2)\"}}",
                 name, size, between(0.5, 3), between(0.1, 1)),
             "starts={fixed_points: {grid: " + zeros + "}}", "limits.steps=8", "survey.depth=0"}};
  }

  /// The Brusselator: its Hopf point lies at b = 1 + a^2.
  DrawnSystem network(const std::string& name) {
    const double a = between(0.6, 1.6);
    const double critical = 1.0 + a * a;
    return {name,
            {fmt::format("system={{name: {}, equations: {{x': \"a - (b + 1)*x + x^2*y\", y': \"b*x - x^2*y\"}}, "
                         "parameters: {{a: {}, b: {:.3g}}}}}",
                         name, a, 0.8 * critical),
             fmt::format("starts={{fixed_points: {{grid: [[{}], [{:.3g}]]}}}}", a, 0.8 * critical / a),
             "continuation.free=b", fmt::format("limits.parameter=[0.1, {:.3g}]", 1.3 * critical), "limits.steps=8",
             "survey.depth=0"}};
  }

  /// Begins at its linear response to a weak force below the resonance.
  DrawnSystem driven(const std::string& name) {
    const double stiffness = between(1, 3), damping = between(0.05, 0.3), force = between(0.01, 0.03);
    const double rate = std::stod(fmt::format("{:.3g}", 0.6 * std::sqrt(stiffness)));
    const std::complex<double> answer = force / (stiffness - rate * rate + std::complex<double>(0.0, damping * rate));
    return {
        name,
        {fmt::format("system={{name: {}, equations: {{x': v, v': \"-d*v - a*x - b*x^3 + F*cos(w*t)\"}}, parameters: "
                     "{{a: {}, d: {}, b: {}, F: {}, w: {}}}}}",
                     name, stiffness, damping, between(0.1, 1), force, rate),
         fmt::format("starts={{states: [{{state: [{}, {}, 0], period: {}, name: Response}}]}}", answer.real(),
                     -rate * answer.imag(), 2.0 * 3.14159265358979323846 / rate),
         "continuation.free=w", fmt::format("limits.parameter=[{:.3g}, {:.3g}]", 0.5 * rate, 2.5 * rate),
         "limits.steps=30", "survey.depth=0"}};
  }

  numerics::Random _random;
};

}  // namespace orbweaver::test
