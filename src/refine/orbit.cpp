#include "orbweaver/refine/orbit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "conditioned_orbit.hpp"
#include "multipliers.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/refine/guess.hpp"

namespace orbweaver::refine {

namespace {

using Eigen::Index;
using numerics::Extended;
using numerics::WorkingDigits;

/// Digits beyond those asked for, before anything is known of the orbit; what an orbit's growth takes is added.
constexpr int first_guard = 6;
/// By how many digits the second computation is better than the first, and its order higher.
constexpr int second_guard = 6;
constexpr int second_order = 5;
/// Computations with more digits each, until the bounds hold.
constexpr int most_attempts = 4;
/// Numbers smaller than this part of their scale are known to fewer significant digits.
constexpr double smallest_part = 1e-9;
constexpr double smallest_multiplier = 1e-300;  // 1/mu has its own digits
/// Digits that double precision gives of an orbit.
constexpr double double_accuracy = 11.0;
/// In double, the place of a crossing along the family, in the scales: what is left the secant method removes. Rounding
/// moves it by less.
constexpr double place_in_double = 1e-6;
constexpr double probe = 1e-4;         // for the slope of its condition, to some digits whatever the rounding
constexpr double probed_digits = 3.0;  // of that slope
constexpr int most_probes = 12;
constexpr int first_working = 20;  // digits of the first step of the secant method
constexpr int most_secants = 40;
/// How far along the family, in the scales, a crossing may lie from where the archive has it.
constexpr double farthest = 0.5;

/// All numbers of one computation, in one order.
struct Values {
  std::vector<Extended> state;
  Extended period;
  std::vector<Extended> energy;   // one, or none
  std::vector<Extended> indices;  // full period, fundamental map; or none
  std::vector<ExtendedMultiplier> multipliers;
  std::vector<Extended> test;  // one, at a crossing
};

void check_digits(int digits) {
  if (digits < 1 || digits > most_digits)
    throw core::InputError(fmt::format("expected 1 to {} digits, got {}", most_digits, digits));
}

Held::Kind kind_of(HeldValue::Quantity quantity) {
  switch (quantity) {
    case HeldValue::Quantity::period: return Held::Kind::period;
    case HeldValue::Quantity::energy: return Held::Kind::energy;
    case HeldValue::Quantity::parameter: break;
  }
  return Held::Kind::nothing;
}

/// mu + 1/mu of the pair beside the two trivial multipliers.
template <class Real>
Real index_of(const Matrix<Real>& map) {
  return map.trace() - Real(2.0);
}

std::vector<Extended> multipliers_of(const Extended& index, bool unit_circle) {
  const Extended root = sqrt(Extended(abs(Extended(index * index - 4))));
  if (unit_circle) return {index / 2, root / 2};
  const Extended larger = index > 0 ? Extended((index + root) / 2) : Extended((index - root) / 2);
  return {larger, 1 / larger};
}

/// What is zero at the crossing.
class Test {
 public:
  Test(const CrossingCondition& condition, Eigen::VectorXd along) : _condition(condition), _along(std::move(along)) {}

  template <class Real>
  [[nodiscard]] Real value(const Shooting<Real>& shooting, const Points<Real>& points,
                           const Passage<Real>& passage) const {
    using std::cos;
    if (archive::has_sector(_condition.kind)) {
      const Real angle = 2 * pi<Real>() * Real(static_cast<double>(_condition.sector_j)) / _condition.sector_q;
      return index_of(shooting.fundamental_map(passage)) - 2 * Real(cos(angle));
    }
    const Index d = _along.size() - 1;
    const Vector<Real> tangent = shooting.tangent(points, passage, _along);
    if (_condition.kind == archive::CrossingKind::fold_period) return tangent(d);
    return shooting.energy_gradient(points.nodes.front()).dot(tangent.head(d));
  }

 private:
  CrossingCondition _condition;
  Eigen::VectorXd _along;  // the family's direction at the start, in the scales, in double
};

/// One orbit in ever more digits.
class Refinement {
 public:
  Refinement(const Guess& guess, int digits)
      : _setup(refinable_formulas(*guess.system), guess.system->structure(), guess.scales, guess.loop, guess.isotropy),
        _orbit(_setup),
        _digits(digits) {}

  [[nodiscard]] const ShootingSetup& setup() const { return _setup; }
  [[nodiscard]] ConditionedOrbit& orbit() { return _orbit; }

  /// An orbit of a given period or energy.
  void hold(const HeldValue& value) {
    _held.kind = kind_of(value.quantity);
    _held.decimal = value.decimal;
    const Points<double> found = _orbit.converge(_setup.guess, _held);
    _orbit.factor(found, _held);
    start_from(found);
  }

  /// The orbit where a test vanishes.
  void locate(const CrossingCondition& condition) {
    Held plane;
    plane.origin = _setup.guess;
    plane.along = _orbit.direction(_setup.guess);
    Points<double> found = _orbit.converge(_setup.guess, plane);
    plane.origin = found;
    plane.along = _orbit.direction(found);
    Eigen::VectorXd along(static_cast<Index>(_setup.dimension()) + 1);
    along << plane.along.head(static_cast<Index>(_setup.dimension())), plane.along.tail(1);
    _test.emplace(condition, along / along.squaredNorm());
    const auto value = [&](double offset) {
      plane.offset = offset;
      found = _orbit.converge(found, plane);
      return _test->value(_orbit.in_double(), found, _orbit.in_double().pass(found, true));
    };
    double at = 0.0;
    for (int n = 0;; ++n) {
      const double f = value(at);
      const double slope = (value(at + probe) - f) / probe;
      const double step = -f / slope;
      if (n == most_probes || !std::isfinite(step) || !(std::abs(at + step) < farthest))
        throw core::NumericalError("no crossing was found near the place that the archive gives");
      at += step;
      _slope = slope;
      if (std::abs(step) < place_in_double) break;
    }
    _held = plane;
    _held.offset = at;
    found = _orbit.converge(found, _held);
    _orbit.factor(found, _held);
    start_from(found);
  }

  RefinedOrbit run() {
    int digits = _digits + first_guard + growth();
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
      const Values first = compute(digits);
      _orbit.extra_order += second_order;
      const Values second = compute(digits + second_guard);
      int missing = second_guard;
      if (are_alike(first.multipliers, second.multipliers)) {
        RefinedOrbit result = joined(first, second, digits, missing);
        if (missing <= 0) return result;
      }
      digits += missing + second_guard;
    }
    throw core::NumericalError(fmt::format("{} digits could not be had", _digits));
  }

 private:
  /// As many real ones and pairs: beside a double one rounding may decide which.
  static bool are_alike(const std::vector<ExtendedMultiplier>& a, const std::vector<ExtendedMultiplier>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& x, const auto& y) { return (x.imaginary == 0) == (y.imaginary == 0); });
  }

  void start_from(const Points<double>& found) {
    const WorkingDigits working(static_cast<int>(std::ceil(ConditionedOrbit::double_digits)) + 1);
    _points = extended(found);
    _accuracy = double_accuracy;
    const Passage<double> passage = _orbit.in_double().pass(found, true);
    _growth = std::log10(std::max(1.0, _orbit.in_double().transition(passage).lpNorm<Eigen::Infinity>()));
  }

  /// Digits that the transition over the domain takes from those of the index.
  [[nodiscard]] int growth() const { return static_cast<int>(std::ceil((_setup.mirrored ? 2.0 : 1.0) * _growth)); }

  Values compute(int digits) {
    const WorkingDigits working(digits + 2);
    _points = extended(_points);
    if (_test) return compute_crossing(digits);
    _orbit.polish(_points, _held, _accuracy, digits);
    _accuracy = digits;
    return values_at(digits);
  }

  /// The secant method for the place along the family, each orbit converged to as many digits as the next place has.
  Values compute_crossing(int digits) {
    Extended offset = numerics::rounded(_held.offset);
    Extended slope = numerics::rounded(_slope);
    Extended last_offset;
    Extended last_value;
    bool has_last = false;
    double last_length = 0.0;
    int working = std::min(digits, std::max(static_cast<int>(std::ceil(_accuracy)), first_working) + first_guard);
    double accuracy = _accuracy;
    for (int n = 0; n < most_secants; ++n) {
      Extended value;
      _held.offset = numerics::rounded(offset);
      _orbit.polish(_points, _held, accuracy, working);
      {
        const WorkingDigits in_force(working + 2);
        Shooting<Extended> shooting(_setup, working + 2, _orbit.extra_order);
        const Passage<Extended> passage = shooting.pass(_points, true);
        value = numerics::rounded(_test->value(shooting, _points, passage));
        _orbit.count_steps(shooting.flow().steps());
      }
      if (has_last && value != last_value) {
        slope = (value - last_value) / (offset - last_offset);
        _slope_digits = std::max(_slope_digits, last_length);
      }
      const Extended step = -value / slope;
      const double length = -numerics::log10_abs(step);
      if (n > 0 && length < 1.0)
        throw core::NumericalError("the crossing is not isolated: its condition does not change sign along the family");
      last_offset = offset;
      last_value = value;
      has_last = true;
      numerics::add_to(offset, step);
      accuracy = std::min(length, static_cast<double>(working));
      const bool is_done = working == digits && length + _slope_digits > digits;
      if (is_done) {
        _held.offset = numerics::rounded(offset);
        _slope = numerics::rounded(slope);
        _orbit.polish(_points, _held, accuracy, digits);
        _accuracy = digits;
        return values_at(digits);
      }
      last_length = length;
      working = std::min(digits, static_cast<int>(std::ceil(length + _slope_digits + growth())) + first_guard);
    }
    throw core::NumericalError("the secant method did not find the crossing in extended arithmetic");
  }

  Values values_at(int digits) {
    Shooting<Extended> shooting(_setup, digits + 2, _orbit.extra_order);
    const Passage<Extended> passage = shooting.pass(_points, true);
    _orbit.count_steps(shooting.flow().steps());
    _order_of_series = shooting.flow().order();
    Values values;
    values.state = start_on_fixed_set();
    values.period = _held.kind == Held::Kind::period ? numerics::extended_of(_held.decimal) : _points.period;
    if (!_setup.structure.conservative()) {
      const Matrix<Extended> monodromy = shooting.monodromy(shooting.fundamental_map(passage));
      const Extended determinant = _setup.structure.symplectic ? Extended(1) : shooting.determinant(passage);
      values.multipliers = nontrivial_multipliers(monodromy, determinant);
      return values;
    }
    values.energy = {_held.kind == Held::Kind::energy ? numerics::extended_of(_held.decimal)
                                                      : shooting.energy(values.state)};
    if (_setup.structure.pairs() == 1) {
      const Matrix<Extended> map = shooting.fundamental_map(passage);
      values.indices = {index_of(shooting.monodromy(map)), index_of(map)};
    }
    if (_test) values.test = {_test->value(shooting, _points, passage)};
    return values;
  }

  /// The start, with what involutions say of it fulfilled to the last digit.
  [[nodiscard]] std::vector<Extended> start_on_fixed_set() const {
    std::vector<Extended> state = _points.nodes.front();
    const Index d = static_cast<Index>(state.size());
    const Extended two_pi = 2 * pi<Extended>();
    for (const ShootingSetup::Map& map : _setup.maps) {
      if (map.between != ShootingSetup::Map::Between::start_and_start) continue;
      const Matrix<Extended> matrix = map.matrix.value<Extended>();
      const Matrix<double> narrow = map.matrix.value<double>();
      if (!(narrow * narrow).isIdentity(smallest_part)) continue;
      std::vector<Extended> image(state.size());
      for (Index i = 0; i < d; ++i) {
        Extended sum = two_pi * map.turns[static_cast<std::size_t>(i)];
        for (Index l = 0; l < d; ++l) sum += matrix(i, l) * state[static_cast<std::size_t>(l)];
        image[static_cast<std::size_t>(i)] = sum;
      }
      for (std::size_t i = 0; i < state.size(); ++i) state[i] = (state[i] + image[i]) / 2;
    }
    return state;
  }

  /// The second computation's numbers with bounds; `missing`: digits that they lack.
  RefinedOrbit joined(const Values& first, const Values& second, int digits, int& missing) const {
    const WorkingDigits working(digits + second_guard);
    missing = std::numeric_limits<int>::min();
    // `has_own_digits`: its rounding is relative to itself, though it need not be known to more than the smallest's.
    const auto number = [&](const Extended& a, const Extended& b, double smallest, bool is_exact,
                            bool has_own_digits = false) {
      Number out{numerics::rounded(b), Extended(0)};
      if (is_exact) return out;
      const double size = std::max(numerics::log10_abs(b), std::log10(smallest));
      const double of_rounding = has_own_digits && b != 0 ? numerics::log10_abs(b) : size;
      const Extended rounding = pow(Extended(10), static_cast<int>(std::floor(of_rounding)) + 1 - digits);
      out.error = 2 * abs(Extended(b - a)) + rounding;
      // half a unit of the last digit is for rounding to so many digits, a tenth for what is not known
      missing = std::max(missing, static_cast<int>(std::ceil(numerics::log10_abs(out.error) - size + _digits + 1)));
      return out;
    };
    RefinedOrbit out;
    for (std::size_t i = 0; i < first.state.size(); ++i) {
      const bool is_fixed = second.state[i] == 0 || first.state[i] == 0;
      out.state.push_back(
          number(first.state[i], second.state[i], smallest_part * _setup.scales.coordinate(i), is_fixed));
    }
    out.period =
        number(first.period, second.period, smallest_part * _setup.scales.time, _held.kind == Held::Kind::period);
    if (!first.energy.empty())
      out.energy = number(first.energy.front(), second.energy.front(), smallest_part * _setup.scales.energy(),
                          _held.kind == Held::Kind::energy);
    for (std::size_t i = 0; i < first.multipliers.size(); ++i) {
      const ExtendedMultiplier& a = first.multipliers[i];
      const ExtendedMultiplier& b = second.multipliers[i];
      ComplexNumber& multiplier = out.spectrum.emplace_back();
      const bool has_own_digits = i + 1 == first.multipliers.size() && b.imaginary == 0 && !_setup.structure.symplectic;
      multiplier.real = number(a.real, b.real, 1.0, false, has_own_digits);
      if (b.imaginary != 0) multiplier.imaginary = number(a.imaginary, b.imaginary, 1.0, false);
    }
    if (!first.indices.empty()) {
      out.index = number(first.indices[0], second.indices[0], 1.0, false);
      out.fundamental_index = number(first.indices[1], second.indices[1], 1.0, false);
    }
    if (!first.indices.empty()) {
      const Extended& k = second.indices[0];
      const Extended distance = k * k - 4;
      // the root has half the digits of what is below it
      if (numerics::log10_abs(distance) > -0.5 * _digits) {
        out.unit_circle = distance < 0;
        const std::vector<Extended> a = multipliers_of(first.indices[0], out.unit_circle);
        const std::vector<Extended> b = multipliers_of(k, out.unit_circle);
        for (std::size_t i = 0; i < a.size(); ++i)
          out.multipliers.push_back(number(a[i], b[i], out.unit_circle ? 1.0 : smallest_multiplier, false));
      }
    }
    if (!first.test.empty()) out.test_value = Number{second.test.front(), Extended(0)};
    out.order = _setup.order;
    out.reversor = _setup.reversor_name;
    if (!_setup.starts_with_drive()) out.largest = _setup.phase;
    out.digits = _digits;
    out.working_digits = digits + second_guard;
    out.taylor_order = _order_of_series;
    out.steps = _orbit.steps();
    out.segments = static_cast<int>(_setup.segments());
    return out;
  }

  ShootingSetup _setup;
  ConditionedOrbit _orbit;
  Held _held;
  std::optional<Test> _test;
  int _digits;
  Points<Extended> _points;
  double _accuracy = 0.0;
  double _growth = 0.0;
  Extended _slope;
  double _slope_digits = probed_digits;  // to which the slope is known
  int _order_of_series = 0;
};

}  // namespace

RefinedOrbit refine_orbit(const Guess& guess, const HeldValue& held, int digits) {
  check_digits(digits);
  static_cast<void>(numerics::extended_of(held.decimal));
  const bool is_isolated = !guess.system->structure().conservative();
  if (is_isolated != (held.quantity == HeldValue::Quantity::parameter))
    throw core::InputError(is_isolated ? "where nothing is conserved a parameter picks an orbit, no period or energy"
                                       : "a parameter alone picks no orbit of a system with a conserved energy");
  Refinement refinement(guess, digits);
  refinement.hold(held);
  return refinement.run();
}

RefinedOrbit refine_crossing(const Guess& guess, const CrossingCondition& condition, int digits) {
  check_digits(digits);
  if (!archive::has_sector(condition.kind) && !archive::is_fold(condition.kind))
    throw core::InputError(fmt::format("a crossing of the kind {} cannot be refined: there is no condition for it",
                                       archive::name_of(condition.kind)));
  static_cast<void>(conservative_formulas(*guess.system));
  Refinement refinement(guess, digits);
  refinement.locate(condition);
  return refinement.run();
}

HeldValue::Quantity better_held(const Guess& guess) {
  // A period that moves by less than this part of a step along the family loses that many digits.
  constexpr double nearly_at_rest = 1e-3;
  const ShootingSetup setup(conservative_formulas(*guess.system), guess.system->structure(), guess.scales, guess.loop,
                            guess.isotropy);
  ConditionedOrbit orbit(setup);
  const Eigen::VectorXd along = orbit.direction(setup.guess);
  const double nodes = std::sqrt(static_cast<double>(setup.guess.nodes.size()));
  const double change_of_period = std::abs(along(along.size() - 1)) * nodes;
  return change_of_period > nearly_at_rest ? HeldValue::Quantity::period : HeldValue::Quantity::energy;
}

}  // namespace orbweaver::refine
