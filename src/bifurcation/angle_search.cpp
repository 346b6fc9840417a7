#include "angle_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "born_orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "pushed_system.hpp"

namespace orbweaver::bifurcation {

namespace {

/// Angles in a turn by 2 pi/q at which the push is looked at: a sine needs three, its first harmonics a few more.
constexpr int samples = 8;
/// Amplitudes, in parts of the scale. Beyond the largest an orbit is not near the crossing.
constexpr double least = 0.01;
constexpr double largest = 0.35;
constexpr double growth = 2.0;
/// The push must exceed its noise so many times for its zeros to be where the family's are. Not measured.
constexpr double clear = 30.0;
/// Accuracy of an angle, in parts of a turn by 2 pi/q.
constexpr double of_angle = 1e-7;

struct Held {
  double push = 0.0;
  loop::Loop loop;
};

class Plane {
 public:
  Plane(const systems::System& system, const loop::Loop& base, const KernelActions& group,
        const loop::Isotropy& isotropy, const DirectionOptions& options)
      : _system(system, loop::mean_state(base)), _base(base), _group(group), _isotropy(isotropy), _options(options) {}

  [[nodiscard]] static Eigen::VectorXd unit(double angle) { return Eigen::Vector2d(std::cos(angle), std::sin(angle)); }

  /// The orbit held at an angle, from a guess that has its part in the kernel there.
  [[nodiscard]] std::optional<Held> held(const loop::Loop& guess) const {
    const std::vector<loop::Tangent> axes{_group.vector_at(Eigen::Vector2d(1, 0)), _group.vector_at(Eigen::Vector2d(0, 1))};
    const corrector::Result result = held_orbit(_system, guess, axes, {loss::Scalar::of_parameter(PushedSystem::push)},
                                                _isotropy, _options.corrector);
    if (!result.converged()) return std::nullopt;
    return Held{result.parameters.at(0), result.loop};
  }

  [[nodiscard]] loop::Loop beside(double angle, double amplitude) const {
    return loop::moved(_base, _group.vector_at(unit(angle)), amplitude);
  }

  /// At `factor` times the amplitude: what lies in the kernel grows with it, the rest and T with its square.
  [[nodiscard]] loop::Loop enlarged(const loop::Loop& orbit, double factor) const {
    loop::Loop out = orbit;
    const loop::Loop base = loop::with_cutoff(_base, orbit.cutoff);
    const Gap gap = gap_between(_base, orbit, _group, {});
    const std::vector<double> inside =
        loop::with_cutoff(_group.vector_at(gap.inside), orbit.cutoff, orbit.dimension).modes;
    for (std::size_t n = 0; n < out.modes.size(); ++n)
      out.modes[n] = base.modes[n] + factor * inside[n] + factor * factor * (orbit.modes[n] - base.modes[n] - inside[n]);
    out.period = _base.period + factor * factor * (orbit.period - _base.period);
    return out;
  }

 private:
  PushedSystem _system;
  const loop::Loop& _base;
  const KernelActions& _group;
  const loop::Isotropy& _isotropy;
  const DirectionOptions& _options;
};

int sign_changes(const std::vector<Held>& around) {
  int changes = 0;
  for (int n = 0; n < samples; ++n)
    if (around[static_cast<std::size_t>(n)].push * around[static_cast<std::size_t>(n + 1)].push < 0.0) ++changes;
  return changes;
}

}  // namespace

AnglesFound search_angles(const systems::System& system, const loop::Loop& base, const KernelActions& group,
                          const loop::Isotropy& isotropy, int q, double scale, const DirectionOptions& options) {
  core::require(group.dimension() == 2 && q >= 3, "angles are searched in a plane, from q = 3 on");
  const Plane plane(system, base, group, isotropy, options);
  const double turn = 2.0 * std::numbers::pi / q;
  AnglesFound out;
  std::vector<Held> around;  // samples + 1: the last one a turn from the first, and the same orbit
  for (double r = least; r <= largest; r *= growth) {
    std::vector<Held> here;
    for (int n = 0; n <= samples; ++n) {
      const loop::Loop guess = around.empty()
                                   ? plane.beside(n * turn / samples, r * scale)
                                   : plane.enlarged(around[static_cast<std::size_t>(n)].loop, growth);
      std::optional<Held> held = plane.held(guess);
      if (!held) return out;
      here.push_back(std::move(*held));
    }
    around = std::move(here);
    out.amplitude = r * scale;
    out.noise = std::abs(around.back().push - around.front().push);
    out.force = 0.0;
    for (const Held& h : around) out.force = std::max(out.force, std::abs(h.push));
    if (out.force > clear * out.noise && sign_changes(around) == 2) break;
    if (r * growth > largest) return out;
  }
  const int wanted = q % 2 == 0 ? 2 : 1;
  for (int n = 0; n < samples && static_cast<int>(out.found.size()) < wanted; ++n) {
    const Held& before = around[static_cast<std::size_t>(n)];
    const Held& after = around[static_cast<std::size_t>(n + 1)];
    if (!(before.push * after.push < 0.0)) continue;
    const double from = n * turn / samples;
    const double to = (n + 1) * turn / samples;
    Held last = before;
    // From the nearest orbit known, turned in the kernel.
    const auto push_at = [&](double angle) {
      loop::Loop guess = last.loop;
      const Gap gap = gap_between(base, guess, group, {});
      const Eigen::VectorXd change = out.amplitude * Plane::unit(angle) - gap.inside;
      guess = loop::moved(guess, loop::with_cutoff(group.vector_at(change), guess.cutoff, guess.dimension), 1.0);
      std::optional<Held> held = plane.held(guess);
      if (!held) return std::nan("");
      last = std::move(*held);
      return last.push;
    };
    const auto located = numerics::locate_root(push_at, numerics::Place{from, before.push},
                                               numerics::Place{to, after.push}, of_angle * turn);
    if (!located || std::isnan(push_at(located->position))) continue;
    const Gap gap = gap_between(base, last.loop, group, options.family.modes);
    const double length = gap.inside.norm();
    out.found.push_back({gap.inside / length, gap.along / length, last.loop});
  }
  return out;
}

}  // namespace orbweaver::bifurcation
