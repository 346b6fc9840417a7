#include "orbweaver/bifurcation/subharmonic_crossing.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "orbweaver/continuation/family_curve.hpp"
#include "orbweaver/continuation/orbit.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/symmetry/alignment.hpp"
#include "orbweaver/loss/slice.hpp"
#include "orbweaver/loss/unknowns.hpp"

namespace orbweaver::bifurcation {

namespace {

/// Amplitudes between which the crossing is looked for, relative to the guess's: the first interval holds most, each
/// next one is `wider` times as wide.
constexpr double first_width = 3e-3;
constexpr double widest = 0.2;
constexpr double wider = 4.0;
/// How far the number of turns in a sector may be from a whole one: neighbours are 1 apart.
constexpr double of_a_turn = 0.4;

enum class Guess {
  rest_of_a_loop,  ///< right to second order only: where Newton's method stalls, a slower one that is damped goes on
  beside_an_orbit,
};

/// The orbit whose part along the guess's own oscillation is the guess's: families change their amplitude, and where
/// they do not, no orbit is found.
std::optional<loop::Loop> orbit_of_amplitude(const systems::System& system, loop::Loop guess, Guess kind,
                                             const continuation::Options& options) {
  // Of a loop with few harmonics nothing repeats many times: no oscillation is left that could be held.
  if (!(loop::rms_amplitude(guess) > loop::negligible_harmonic)) return std::nullopt;
  while (true) {
    const loss::Unknowns unknowns{loop::Subspace(guess.dimension, guess.cutoff, {}), {loss::Scalar::period()}};
    std::vector<double> oscillation = guess.modes;
    std::fill(oscillation.begin(), oscillation.begin() + guess.dimension, 0.0);
    const std::vector<double> along = unknowns.coordinates_of({oscillation, {}});
    const std::vector<double> shift = unknowns.time_shift_direction(guess);
    Eigen::MatrixXd conditions(unknowns.size(), 2);
    conditions.col(0) = Eigen::Map<const Eigen::VectorXd>(along.data(), unknowns.size()).normalized();
    conditions.col(1) = Eigen::Map<const Eigen::VectorXd>(shift.data(), unknowns.size()).normalized();
    const loss::Slice slice(unknowns.size(), conditions);
    corrector::Result result = corrector::correct(system, guess, unknowns, slice, options.corrector);
    if (kind == Guess::rest_of_a_loop && result.outcome == corrector::Outcome::stalled &&
        unknowns.size() <= corrector::largest_dense) {
      corrector::Options careful = options.corrector;
      careful.method = corrector::Method::brgn;
      result = corrector::correct(system, guess, unknowns, slice, careful);
    }
    if (result.converged()) return std::move(result.loop);
    const int larger = loop::next_cutoff(guess.cutoff);
    if (result.outcome != corrector::Outcome::under_resolved || larger > options.cutoff_to) return std::nullopt;
    guess = loop::with_cutoff(guess, larger);
  }
}

loop::Loop with_amplitude(loop::Loop loop, double factor) {
  for (std::size_t n = static_cast<std::size_t>(loop.dimension); n < loop.modes.size(); ++n) loop.modes[n] *= factor;
  return loop;
}

std::optional<Sector> nearest_sector(double index, int q) {
  if (!(std::abs(index) < 2.0)) return std::nullopt;
  const double turns = q * std::acos(0.5 * index) / (2.0 * std::numbers::pi);
  const Sector sector{q, static_cast<int>(std::lround(turns))};
  if (std::abs(turns - sector.j) > of_a_turn || std::gcd(sector.j, q) != 1) return std::nullopt;
  return sector;
}

}  // namespace

std::optional<CrossingFound> crossing_beneath(const std::shared_ptr<const systems::System>& system,
                                              const loop::Loop& near, int multiplicity,
                                              const continuation::Options& options) {
  if (!system->structure().symplectic || system->structure().pairs() != 1) return std::nullopt;
  const std::optional<loop::Loop> middle =
      orbit_of_amplitude(*system, loop::without_repetition(near, multiplicity), Guess::rest_of_a_loop, options);
  if (!middle) return std::nullopt;
  const auto sector = nearest_sector(spectrum::floquet(*system, *middle, {}).full.front().real(), multiplicity);
  if (!sector) return std::nullopt;
  const Event event{Event::Kind::test_function, {TestFunction::Kind::sector, *sector}, false};
  for (double width = first_width; width <= widest; width *= wider) {
    const auto before =
        orbit_of_amplitude(*system, with_amplitude(*middle, 1.0 - width), Guess::beside_an_orbit, options);
    const auto after =
        orbit_of_amplitude(*system, with_amplitude(*middle, 1.0 + width), Guess::beside_an_orbit, options);
    if (!before || !after) return std::nullopt;
    continuation::FamilyCurve curve(system, {}, options);
    curve.add(0.0, *before);
    curve.add(0.5, *middle);
    curve.add(1.0, *after);
    NotLocated why;
    if (auto crossing = locate(*system, curve, event, 0.0, 1.0, why)) {
      // Positions are no lengths here.
      if (system->scales().are_one())
        crossing->place_error.arclength *= continuation::arclength_in_units(*system, *before, *middle) +
                                           continuation::arclength_in_units(*system, *middle, *after);
      return CrossingFound{event, std::move(*crossing)};
    }
    if (why.reason == NotLocated::Reason::no_orbit) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace orbweaver::bifurcation
