#include "orbweaver/prove/proof.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "ball.hpp"
#include "closed_orbit.hpp"
#include "enclosed_flow.hpp"
#include "orbweaver/loop/symmetry/isotropy_text.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/refine/guess.hpp"
#include "orbweaver/refine/stored_family.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/scaled_system.hpp"

namespace orbweaver::prove {

namespace {

using Quantity = refine::HeldValue::Quantity;

/// Digits that the centre has beyond those aimed at, and those that steps and arithmetic have: sums of some hundred
/// errors, and what Krawczyk's test needs to spare.
constexpr int centre_guard = 6;
constexpr int step_guard = 6;
constexpr int arithmetic_guard = 20;
constexpr long most_bits = 20000;  // of any statement: an orbit that needs more is not proven
constexpr double bits_a_digit = 3.3219280948873626;
/// An instant for so many harmonics of the fundamental domain: boxes grow little in between.
constexpr int harmonics_a_segment = 2;
constexpr int least_segments = 2;
constexpr int most_segments = 32;
/// The narrow box is no narrower than so many digits beyond those aimed at, nor than so many times the correction of
/// its centre, and wider each time that it fails.
constexpr int least_narrow = 2;
constexpr double narrow_factor = 8.0;
constexpr double wider = 1e3;
constexpr int most_narrow_boxes = 4;
/// Radii in which uniqueness is tried, the largest first.
constexpr double largest_radius = 0.1;
constexpr double next_radius = 0.31622776601683794;
/// Digits of a wide box's integration beyond those of its radius.
constexpr double wide_guard = 6.0;
constexpr double wide_least_digits = 10.0;
/// A box that is too wide has ever shorter steps: it is given up after so many times those of its
/// centre.
constexpr long most_wide_steps = 3;

Enclosure enclosure_of(const Ball& ball) { return {ball.exact_text()}; }
Ball ball_of(const Enclosure& enclosure) { return Ball::of_exact_text(enclosure.exact); }

BallVector balls_of(const std::vector<std::string>& texts) {
  BallVector balls;
  for (const std::string& text : texts) balls.push_back(Ball::of_exact_text(text));
  return balls;
}

std::vector<std::string> texts_of(const BallVector& balls) {
  std::vector<std::string> texts;
  for (const Ball& ball : balls) texts.push_back(ball.exact_text());
  return texts;
}

ClosedOrbit closed_orbit_of(const Statement& statement) {
  std::map<std::string, double> parameters;
  for (const auto& [name, decimal] : statement.parameters) {
    const auto value = static_cast<double>(numerics::extended_of(decimal));
    if (numerics::shortest_decimal(value) != decimal)
      throw core::InputError(fmt::format("the parameter {} = {} is not what it is computed with", name, decimal));
    parameters[name] = value;
  }
  const std::shared_ptr<const systems::System> system =
      systems::scaled(systems::make_system(statement.system, parameters, statement.effects), statement.scales);
  const auto d = static_cast<std::size_t>(system->dimension());
  if (statement.start.size() != d || statement.end.size() != d || statement.fractions.empty() ||
      statement.fractions.front() != 0.0)
    throw core::InputError("the statement does not fit its system");
  return {refine::conservative_formulas(*system),
          system->structure(),
          statement.scales,
          loop::isotropy_of(system->structure(), statement.isotropy),
          statement.fractions,
          statement.held,
          balls_of(statement.start),
          balls_of(statement.end)};
}

/// Krawczyk's test of one box about a centre: where the operator maps the box into its interior, there is exactly one
/// zero in the box, and it lies in the image (Krawczyk 1969; Neumaier 1990, Interval Methods for Systems of Equations,
/// 5.1).
class Krawczyk {
 public:
  Krawczyk(const ClosedOrbit& orbit, const BallVector& centre, EnclosedFlow& flow) : _orbit(orbit), _centre(centre) {
    const ClosedOrbit::Passage passage = orbit.pass(flow, centre);
    _inverse = inverse(orbit.jacobian(flow, centre, passage).middle()).middle();
    _correction = _inverse * orbit.residual(flow, centre, passage);
    if (!_correction.is_finite()) throw NotProven("the equations are not finite at the centre");
  }

  /// Of the correction of the centre, in the largest unknown.
  [[nodiscard]] double correction() const {
    double largest = 0.0;
    for (const Ball& x : _correction.column(0)) largest = std::max(largest, x.modulus().upper());
    return largest;
  }

  struct Outcome {
    BallVector image;  ///< holds the zero
    ClosedOrbit::Passage passage;
  };
  /// Throws NotProven where the box is not mapped into itself.
  [[nodiscard]] Outcome test(EnclosedFlow& flow, double radius) const {
    BallVector box;
    for (const Ball& x : _centre) box.push_back(x.widened(Ball(radius)));
    Outcome outcome;
    outcome.passage = _orbit.pass(flow, box);
    const BallMatrix slope = BallMatrix::identity(box.size()) - _inverse * _orbit.jacobian(flow, box, outcome.passage);
    BallVector cube;
    for (std::size_t n = 0; n < box.size(); ++n) cube.push_back(Ball::around_zero(Ball(radius)));
    const BallMatrix moved = slope * BallMatrix::of(cube) - _correction;
    double farthest = 0.0;
    for (std::size_t n = 0; n < box.size(); ++n) {
      const Ball distance = moved.at(n, 0).modulus();
      if (!(distance < Ball(radius))) farthest = std::max(farthest, distance.upper() / radius);
      outcome.image.push_back(_centre[n] + moved.at(n, 0));
    }
    if (!moved.is_finite() || farthest > 0.0)
      throw NotProven(fmt::format("Krawczyk's operator maps the box of radius {:.1e} {:.2g} times as far as its faces",
                                  radius, farthest));
    _orbit.require_closes(flow, box, outcome.passage);
    return outcome;
  }

 private:
  const ClosedOrbit& _orbit;
  BallVector _centre;
  BallMatrix _inverse;
  BallMatrix _correction;
};

/// The largest radius in which the zero of the narrow box is the only one.
double unique_radius(const ClosedOrbit& orbit, const Krawczyk& krawczyk, double narrow, std::optional<double> given,
                     long thin_steps, long& steps) {
  for (double radius = given.value_or(largest_radius); radius > narrow; radius *= next_radius) {
    const double digits = std::max(wide_least_digits, -std::log10(radius) + wide_guard);
    const WorkingBits working(static_cast<long>((digits + arithmetic_guard) * bits_a_digit));
    EnclosedFlow flow = orbit.flow(digits);
    flow.limit_steps(most_wide_steps * thin_steps);
    try {
      static_cast<void>(krawczyk.test(flow, radius));
      steps += flow.steps();
      return radius;
    } catch (const core::NumericalError&) {
      steps += flow.steps();
      if (given) throw;
    }
  }
  return narrow;
}

void add_multipliers(Proof& proof, const Ball& k) {
  // Over p times the fundamental map: cos p t and sin p t / sin t as polynomials in 2 cos t.
  Ball before(2.0);
  Ball index = k;
  Ball sine_before(0.0);
  Ball sine(1.0);
  for (int n = 1; n < proof.order; ++n) {
    const Ball next = k * index - before;
    before = index;
    index = next;
    const Ball next_sine = k * sine - sine_before;
    sine_before = sine;
    sine = next_sine;
  }
  proof.fundamental_index = enclosure_of(k);
  proof.index = enclosure_of(index);
  const Ball two(2.0);
  Ball size;
  arb_abs(size.get(), k.get());
  if (size < two) {
    proof.stability = Stability::elliptic;
    const Ball imaginary = sine * sqrt(Ball(1.0) - k * k / Ball(4.0));
    Ball above;
    arb_abs(above.get(), imaginary.get());
    proof.multiplier = {enclosure_of(index / two), enclosure_of(above)};
  } else if (two < size) {
    proof.stability = Stability::hyperbolic;
    const Ball root = sqrt(k * k - Ball(4.0));
    const Ball larger = k.middle_in_double() > 0.0 ? (k + root) / two : (k - root) / two;
    Ball power(1.0);
    for (int n = 0; n < proof.order; ++n) power *= larger;
    proof.multiplier = {enclosure_of(power)};
  } else {
    proof.stability = Stability::undecided;
  }
}

}  // namespace

double Enclosure::lower() const { return ball_of(*this).lower(); }
double Enclosure::upper() const { return ball_of(*this).upper(); }
double Enclosure::radius() const { return ball_of(*this).radius().upper(); }
bool Enclosure::contains(const Enclosure& other) const { return ball_of(*this).contains(ball_of(other)); }
bool Enclosure::contains(const numerics::Extended& number) const { return ball_of(*this).contains(Ball::of(number)); }

std::string Enclosure::text(int digits) const {
  char* raw = arb_get_str(ball_of(*this).get(), digits, 0);
  std::string text(raw);
  flint_free(raw);
  return text;
}

const char* name_of(Stability stability) {
  switch (stability) {
    case Stability::elliptic: return "elliptic";
    case Stability::hyperbolic: return "hyperbolic";
    case Stability::undecided: return "undecided";
    case Stability::none: break;
  }
  return "none";
}

Statement statement_about(const std::string& family, const std::vector<std::string>& effects,
                          const refine::Guess& guess, const refine::HeldValue& held, int digits) {
  if (digits < 1 || digits > most_proof_digits)
    throw core::InputError(fmt::format("expected 1 to {} digits, got {}", most_proof_digits, digits));
  static_cast<void>(refine::conservative_formulas(*guess.system));
  const refine::RefinedOrbit refined = refine::refine_orbit(guess, held, digits + centre_guard);
  Statement statement;
  statement.family = family;
  statement.state_names = guess.system->info().state_names;
  statement.system = guess.system->info().name;
  for (const auto& [name, value] : guess.system->parameters())
    statement.parameters.emplace_back(name, numerics::shortest_decimal(value));
  statement.effects = effects;
  statement.scales = guess.scales;
  statement.isotropy = loop::to_text(guess.isotropy);
  statement.held = held;
  statement.digits = digits;
  const double growth = refined.index ? std::max(0.0, numerics::log10_abs(refined.index->value)) : 0.0;
  statement.bits = static_cast<long>(std::ceil((digits + arithmetic_guard + growth) * bits_a_digit));
  const WorkingBits working(statement.bits);
  const loop::SymmetryGroup group(guess.system->structure(), guess.isotropy);
  const int copies = group.order() * (group.reversor_at_start() != nullptr ? 2 : 1);
  const int count = std::clamp(guess.loop.cutoff / (harmonics_a_segment * copies), least_segments, most_segments);
  for (int n = 0; n < count; ++n) {
    const double s = 2.0 * std::numbers::pi / copies * n / count;
    statement.fractions.push_back(n == 0 ? 0.0 : guess.loop.time_map.phase(s) / (2.0 * std::numbers::pi));
  }
  BallVector start;
  BallVector end;
  const std::vector<double> rough = loop::state_at(guess.loop, guess.loop.period / copies);
  for (std::size_t i = 0; i < rough.size(); ++i) {
    const Ball scale(guess.scales.coordinate(i));
    start.push_back((Ball::of(refined.state[i].value) / scale).middle());
    end.push_back((Ball(rough[i]) / scale).middle());
  }
  statement.start = texts_of(start);
  statement.end = texts_of(end);
  const ClosedOrbit orbit = closed_orbit_of(statement);
  EnclosedFlow flow = orbit.flow(digits + step_guard);
  statement.centre = texts_of(orbit.candidate(flow, start, Ball::of(refined.period.value) / Ball(guess.scales.time)));
  return statement;
}

Statement statement_about(const archive::Archive& atlas, const std::string& family, const std::string& orbit,
                          int digits) {
  const auto named = refine::StoredFamily::named(atlas, family).named_orbit(orbit, std::nullopt);
  return statement_about(family, atlas.header().effects, named.place.guess, named.held, digits);
}

Proof prove(const Statement& statement, std::optional<double> radius) {
  if (statement.bits < 2 || statement.bits > most_bits || statement.digits < 1 || statement.digits > most_proof_digits)
    throw core::InputError(fmt::format("expected a statement of 1 to {} digits and 2 to {} bits, got {} and {}",
                                       most_proof_digits, most_bits, statement.digits, statement.bits));
  const WorkingBits working(statement.bits);
  const ClosedOrbit orbit = closed_orbit_of(statement);
  BallVector centre = balls_of(statement.centre);
  if (centre.size() != orbit.unknowns())
    throw core::InputError(
        fmt::format("the statement has {} unknowns, its equations {}", centre.size(), orbit.unknowns()));
  for (Ball& x : centre) x = x.middle();
  EnclosedFlow flow = orbit.flow(statement.digits + step_guard);
  const Krawczyk krawczyk(orbit, centre, flow);
  double narrow = std::max(narrow_factor * krawczyk.correction(), std::pow(10.0, -statement.digits - least_narrow));
  const long thin_steps = flow.steps();
  std::optional<Krawczyk::Outcome> outcome;
  for (int n = 0; !outcome; ++n) {
    flow.limit_steps(flow.steps() + most_wide_steps * thin_steps);
    try {
      outcome = krawczyk.test(flow, narrow);
    } catch (const core::NumericalError&) {
      if (n + 1 == most_narrow_boxes) throw;
      narrow *= wider;
    }
  }
  Proof proof;
  proof.statement = statement;
  proof.isolated_by = orbit.isolated_by();
  proof.order = orbit.order();
  proof.taylor_order = flow.order();
  proof.steps = flow.steps();
  proof.radius = unique_radius(orbit, krawczyk, narrow, radius, thin_steps, proof.steps);
  for (std::size_t n = 0; n < centre.size(); ++n)
    proof.distance = std::max(proof.distance, (outcome->image[n] - centre[n]).modulus().upper());
  const BallVector start = orbit.nodes(outcome->image).front();
  const BallVector speed = flow.field(start);
  if (std::all_of(speed.begin(), speed.end(), [](const Ball& f) { return f.contains(Ball(0.0)); }))
    throw NotProven("the solution may be an equilibrium");
  for (std::size_t i = 0; i < start.size(); ++i)
    proof.state.push_back(enclosure_of(start[i] * Ball(statement.scales.coordinate(i))));
  const bool holds_energy = statement.held.quantity == Quantity::energy;
  proof.period = enclosure_of(holds_energy ? orbit.period(outcome->image) * Ball(statement.scales.time)
                                           : Ball::of_decimal(statement.held.decimal));
  proof.energy = enclosure_of(holds_energy ? Ball::of_decimal(statement.held.decimal)
                                           : flow.energy(start) * Ball(statement.scales.energy()));
  if (const std::optional<Ball> k = orbit.fundamental_index(outcome->passage)) add_multipliers(proof, *k);
  return proof;
}

std::vector<std::string> check(const Proof& proof) {
  Proof again;
  try {
    again = prove(proof.statement, proof.radius);
  } catch (const core::NumericalError& failure) {
    return {failure.what()};
  }
  std::vector<std::string> missing;
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) missing.push_back(what + " does not follow");
  };
  const auto require_within = [&](const Enclosure& claimed, const Enclosure& found, const std::string& what) {
    require(claimed.contains(found), what + " in " + claimed.text());
  };
  require(proof.isolated_by == again.isolated_by, "isolation by " + proof.isolated_by);
  require(proof.order == again.order, "the order of the fundamental map");
  require(again.radius == proof.radius, fmt::format("a radius of {:.3e}", proof.radius));
  require(again.distance <= proof.distance, "the distance from the centre");
  require(proof.state.size() == again.state.size(), "the size of the state");
  for (std::size_t i = 0; i < std::min(proof.state.size(), again.state.size()); ++i)
    require_within(proof.state[i], again.state[i], fmt::format("coordinate {}", i));
  require_within(proof.period, again.period, "the period");
  require_within(proof.energy, again.energy, "the energy");
  require(proof.stability == again.stability, std::string("the stability ") + name_of(proof.stability));
  const auto optional_within = [&](const std::optional<Enclosure>& claimed, const std::optional<Enclosure>& found,
                                   const std::string& what) {
    require(claimed.has_value() == found.has_value(), what);
    if (claimed && found) require_within(*claimed, *found, what);
  };
  optional_within(proof.fundamental_index, again.fundamental_index, "the index of the fundamental map");
  optional_within(proof.index, again.index, "the index");
  require(proof.multiplier.size() == again.multiplier.size(), "the multiplier");
  for (std::size_t n = 0; n < std::min(proof.multiplier.size(), again.multiplier.size()); ++n)
    require_within(proof.multiplier[n], again.multiplier[n], "the multiplier");
  return missing;
}

}  // namespace orbweaver::prove
