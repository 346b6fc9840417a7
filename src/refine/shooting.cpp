#include "shooting.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>

#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"

namespace orbweaver::refine {

namespace {

using Eigen::Index;
using Map = ShootingSetup::Map;

/// A segment for so many harmonics of its part of the loop: over it an orbit is as good as straight, and errors grow
/// little, so that Newton's method starts well.
constexpr int harmonics_a_segment = 2;
constexpr int least_segments = 4;
/// What the dense factorisation of the Jacobian takes a tenth of a second for.
constexpr int most_segments = 64;
/// Of a quarter of a turn: rounding of an offset.
constexpr double same_quarter = 1e-12;

Index as_index(std::size_t n) { return static_cast<Index>(n); }

double scale_of(const ShootingSetup& setup, std::size_t i) { return setup.scales.coordinate(i); }

/// The map's own turns, and the whole ones by which it misses the state `to`.
std::vector<double> turns_between(const systems::AffineMap& map, const std::vector<double>& from,
                                  const std::vector<double>& to, const systems::Structure& structure) {
  const Eigen::VectorXd image = map(Eigen::Map<const Eigen::VectorXd>(from.data(), as_index(from.size())));
  std::vector<double> turns(from.size(), 0.0);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double quarters = map.offset(as_index(i)) / (0.5 * std::numbers::pi);
    const double whole = std::round(quarters);
    if (std::abs(quarters - whole) > same_quarter || (whole != 0.0 && !structure.is_angle(i)))
      throw core::InputError(
          "orbits with a symmetry that shifts the state, other than an angle by quarters of a turn, cannot be refined");
    turns[i] = 0.25 * whole;
    if (structure.is_angle(i)) turns[i] += std::round((to[i] - image(as_index(i))) / (2.0 * std::numbers::pi));
  }
  return turns;
}

/// The same orbit begun where the drive's phase, the last coordinate, is 0.
loop::Loop begun_with_drive(const loop::Loop& loop) {
  const int drive = loop.dimension - 1;
  const auto at = static_cast<std::size_t>(drive);
  const double turns = loop::state_at(loop, 0.0)[at] / (2.0 * std::numbers::pi * loop.winding[at]);
  loop::Loop begun = loop::time_shifted(loop, std::ceil(turns) - turns);
  begun.cosine(0, drive) -= loop::state_at(begun, 0.0)[at];
  return begun;
}

template <class Real>
std::vector<Real> parameters_of(const ShootingSetup& setup) {
  std::vector<Real> parameters;
  for (const double value : setup.formulas.values) {
    if constexpr (std::is_same_v<Real, double>)
      parameters.push_back(value);
    else
      parameters.push_back(numerics::extended_of(numerics::shortest_decimal(value)));
  }
  return parameters;
}

template <class Real>
std::vector<Real> inputs_of(const std::vector<Real>& z) {
  std::vector<Real> inputs = z;
  inputs.resize(z.size() * (1 + z.size()));
  for (std::size_t i = 0; i < z.size(); ++i)
    for (std::size_t c = 0; c < z.size(); ++c) inputs[z.size() * (1 + i) + c] = Real(i == c ? 1.0 : 0.0);
  return inputs;
}

template <class Real>
Vector<Real> as_vector(const std::vector<Real>& values) {
  Vector<Real> vector(as_index(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) vector(as_index(i)) = values[i];
  return vector;
}

}  // namespace

ShootingSetup::ShootingSetup(const systems::Formulas& system_formulas, const systems::Structure& system_structure,
                             const systems::Scales& system_scales, const loop::Loop& stored,
                             const loop::Isotropy& isotropy)
    : formulas(system_formulas),
      structure(system_structure),
      scales(system_scales),
      generator(Eigen::MatrixXd::Identity(stored.dimension, stored.dimension)),
      reversor(Eigen::MatrixXd::Identity(stored.dimension, stored.dimension)) {
  const loop::SymmetryGroup group(structure, isotropy);
  const loop::SymmetryElement* at_start = group.reversor_at_start();
  order = group.order();
  mirrored = at_start != nullptr;
  generator = ExactMatrix(group.generator().matrix);
  if (mirrored) {
    reversor = ExactMatrix(at_start->map.matrix);
    reversor_name = at_start->name;
  }
  const loop::Loop loop = structure.driven && !mirrored ? begun_with_drive(stored) : stored;
  const int count = std::clamp(loop.cutoff / (harmonics_a_segment * copies()), least_segments, most_segments);
  const double end = 2.0 * std::numbers::pi / copies();
  for (int n = 0; n <= count; ++n) {
    const double s = end * n / count;
    fractions.push_back(n == count ? 1.0 / copies() : loop.time_map.phase(s) / (2.0 * std::numbers::pi));
    guess.nodes.push_back(loop::state_at(loop, fractions.back() * loop.period));
  }
  guess.period = loop.period;
  const auto add = [&](Map::Between between, const systems::AffineMap& map, const std::vector<double>& from,
                       const std::vector<double>& to) {
    maps.push_back({between, ExactMatrix(map.matrix), turns_between(map, from, to, structure)});
  };
  const std::vector<double>& first = guess.nodes.front();
  const std::vector<double>& last = guess.nodes.back();
  for (const loop::SymmetryElement& element : group.elements()) {
    const bool is_identity = !element.reversing && element.name == "1";
    if (element.shift_numerator == 0 && !is_identity) add(Map::Between::start_and_start, element.map, first, first);
    // z(T/p - t) = g R z(t): the end, at T/(2p), is kept.
    const bool turns_at_end = element.shift_numerator == (order == 1 ? 0 : 1) && element.shift_denominator == order;
    if (mirrored && element.reversing && turns_at_end) add(Map::Between::end_and_end, element.map, last, last);
  }
  if (!mirrored) {
    add(Map::Between::start_and_end, group.generator(), first, last);
    const int angle = structure.angles.empty() ? 0 : structure.angles.front();
    phase = static_cast<std::size_t>(structure.driven ? structure.dimension - 1 : angle);
    phase_winding = loop.winding[*phase];
  }
}

template <class Real>
Shooting<Real>::Shooting(const ShootingSetup& setup, double digits, int extra_order)
    : _setup(setup),
      _parameters(parameters_of<Real>(setup)),
      _generator(setup.generator.value<Real>()),
      _reversor(setup.reversor.value<Real>()),
      _two_pi(2 * pi<Real>()),
      _flow(setup.formulas, _parameters, {digits, extra_order, setup.scales.coordinates}) {
  for (const Map& map : setup.maps) _matrices.push_back(map.matrix.template value<Real>());
}

template <class Real>
Real Shooting<Real>::fraction(std::size_t node) const {
  if (node == _setup.segments()) return Real(Real(1.0) / _setup.copies());
  return Real(_setup.fractions[node]);
}

template <class Real>
Passage<Real> Shooting<Real>::pass(const Points<Real>& points, bool with_transitions) {
  const std::size_t d = _setup.dimension();
  Passage<Real> passage;
  for (std::size_t m = 0; m < _setup.segments(); ++m) {
    const Real time = (fraction(m + 1) - fraction(m)) * points.period;
    std::vector<Real> state = points.nodes[m];
    if (with_transitions) {
      std::vector<Real> inputs = inputs_of(state);
      std::vector<Real> transition(inputs.begin() + static_cast<std::ptrdiff_t>(d), inputs.end());
      _flow.advance(state, transition, time);
      Matrix<Real> matrix(as_index(d), as_index(d));
      for (std::size_t i = 0; i < d; ++i)
        for (std::size_t c = 0; c < d; ++c) matrix(as_index(i), as_index(c)) = transition[i * d + c];
      passage.transitions.push_back(std::move(matrix));
    } else {
      _flow.advance(state, time);
    }
    passage.ends.push_back(std::move(state));
  }
  return passage;
}

template <class Real>
const std::vector<Real>& Shooting<Real>::from(const Map& map, const Points<Real>& points) const {
  return map.between == Map::Between::end_and_end ? points.nodes.back() : points.nodes.front();
}

template <class Real>
const std::vector<Real>& Shooting<Real>::to(const Map& map, const Points<Real>& points) const {
  return map.between == Map::Between::start_and_start ? points.nodes.front() : points.nodes.back();
}

template <class Real>
Vector<Real> Shooting<Real>::residual(const Points<Real>& points, const Passage<Real>& passage) const {
  const std::size_t d = _setup.dimension();
  Vector<Real> rows(as_index(d * (_setup.segments() + _setup.maps.size()) + (_setup.phase ? 1 : 0)));
  Index row = 0;
  for (std::size_t m = 0; m < _setup.segments(); ++m)
    for (std::size_t i = 0; i < d; ++i)
      rows(row++) = (passage.ends[m][i] - points.nodes[m + 1][i]) / scale_of(_setup, i);
  for (std::size_t n = 0; n < _setup.maps.size(); ++n) {
    const Map& map = _setup.maps[n];
    const Vector<Real> image = _matrices[n] * as_vector(from(map, points));
    for (std::size_t i = 0; i < d; ++i)
      rows(row++) = (image(as_index(i)) + _two_pi * map.turns[i] - to(map, points)[i]) / scale_of(_setup, i);
  }
  if (_setup.starts_with_drive())
    rows(row) = points.nodes.front()[*_setup.phase] / scale_of(_setup, *_setup.phase);
  else if (_setup.phase)
    rows(row) =
        (field(points.nodes.front())(as_index(*_setup.phase)) - _two_pi * _setup.phase_winding / points.period) *
        (_setup.scales.time / scale_of(_setup, *_setup.phase));
  return rows;
}

template <class Real>
Matrix<Real> Shooting<Real>::jacobian(const Points<Real>& points, const Passage<Real>& passage) const {
  const std::size_t d = _setup.dimension();
  const std::size_t segments = _setup.segments();
  const Index last = as_index(d * segments);
  const Index period = as_index(d * (segments + 1));
  Matrix<Real> rows =
      Matrix<Real>::Zero(as_index(d * (segments + _setup.maps.size()) + (_setup.phase ? 1 : 0)), period + 1);
  const auto ratio = [&](std::size_t i, std::size_t c) { return scale_of(_setup, c) / scale_of(_setup, i); };
  Index row = 0;
  for (std::size_t m = 0; m < segments; ++m) {
    const Vector<Real> speed = field(passage.ends[m]);
    for (std::size_t i = 0; i < d; ++i, ++row) {
      for (std::size_t c = 0; c < d; ++c)
        rows(row, as_index(d * m + c)) = passage.transitions[m](as_index(i), as_index(c)) * ratio(i, c);
      rows(row, as_index(d * (m + 1) + i)) -= Real(1.0);
      rows(row, period) =
          speed(as_index(i)) * (fraction(m + 1) - fraction(m)) * (_setup.scales.time / scale_of(_setup, i));
    }
  }
  for (std::size_t n = 0; n < _setup.maps.size(); ++n) {
    const Map& map = _setup.maps[n];
    const Index source = map.between == Map::Between::end_and_end ? last : 0;
    const Index target = map.between == Map::Between::start_and_start ? 0 : last;
    for (std::size_t i = 0; i < d; ++i, ++row) {
      for (std::size_t c = 0; c < d; ++c)
        rows(row, source + as_index(c)) += _matrices[n](as_index(i), as_index(c)) * ratio(i, c);
      rows(row, target + as_index(i)) -= Real(1.0);
    }
  }
  if (_setup.starts_with_drive()) {
    rows(row, as_index(*_setup.phase)) = Real(1.0);
  } else if (_setup.phase) {
    const Matrix<Real> slope = linearized(points.nodes.front());
    for (std::size_t c = 0; c < d; ++c)
      rows(row, as_index(c)) =
          slope(as_index(*_setup.phase), as_index(c)) * (_setup.scales.time * ratio(*_setup.phase, c));
    rows(row, period) = _two_pi * _setup.phase_winding / (points.period * points.period) *
                        (_setup.scales.time * _setup.scales.time / scale_of(_setup, *_setup.phase));
  }
  return rows;
}

template <class Real>
Vector<Real> Shooting<Real>::field(const std::vector<Real>& z) const {
  return as_vector(model::evaluate<Real>(_setup.formulas.graph, _setup.formulas.field, z, _parameters));
}

template <class Real>
Matrix<Real> Shooting<Real>::linearized(const std::vector<Real>& z) const {
  const std::vector<Real> values =
      model::evaluate<Real>(_setup.formulas.graph, _setup.formulas.variations, inputs_of(z), _parameters);
  Matrix<Real> matrix(as_index(z.size()), as_index(z.size()));
  for (std::size_t i = 0; i < z.size(); ++i)
    for (std::size_t c = 0; c < z.size(); ++c) matrix(as_index(i), as_index(c)) = values[i * z.size() + c];
  return matrix;
}

template <class Real>
Real Shooting<Real>::energy(const std::vector<Real>& z) const {
  const std::vector<int> first{_setup.formulas.conserved.front()};
  return model::evaluate<Real>(_setup.formulas.graph, first, z, _parameters).front();
}

template <class Real>
Vector<Real> Shooting<Real>::energy_gradient(const std::vector<Real>& z) const {
  return as_vector(
      model::evaluate<Real>(_setup.formulas.graph, _setup.formulas.conserved_gradients.front(), z, _parameters));
}

template <class Real>
Matrix<Real> Shooting<Real>::transition(const Passage<Real>& passage) const {
  Matrix<Real> product = passage.transitions.front();
  for (std::size_t m = 1; m < passage.transitions.size(); ++m) product = (passage.transitions[m] * product).eval();
  return product;
}

// A reversor R' = g R maps the second half of T/p, run backwards, to the first: M(T/p) = R' Phi^-1 R' Phi.
template <class Real>
Matrix<Real> Shooting<Real>::fundamental_map(const Passage<Real>& passage) const {
  const Matrix<Real> half = transition(passage);
  if (!_setup.mirrored) return _generator.partialPivLu().solve(half);
  const Matrix<Real> mirror = _generator * _reversor;
  const Matrix<Real> turned = mirror * half;
  return _reversor * half.partialPivLu().solve(turned);
}

template <class Real>
Matrix<Real> Shooting<Real>::monodromy(const Matrix<Real>& fundamental_map) const {
  Matrix<Real> result = fundamental_map;
  for (int n = 1; n < _setup.order; ++n) result = (result * fundamental_map).eval();
  for (int n = 0; n < _setup.order; ++n) result = (_generator * result).eval();
  return result;
}

template <class Real>
Real Shooting<Real>::determinant(const Passage<Real>& passage) const {
  Real domain(1.0);
  for (const Matrix<Real>& segment : passage.transitions) domain *= segment.partialPivLu().determinant();
  Real result(1.0);
  for (int n = 0; n < _setup.order; ++n) result *= domain;
  return result;
}

template <class Real>
Vector<Real> Shooting<Real>::tangent(const Points<Real>& points, const Passage<Real>& passage,
                                     const Eigen::VectorXd& along) const {
  const std::size_t d = _setup.dimension();
  const auto size = as_index(d);
  const Matrix<Real> across = transition(passage);
  const Vector<Real> speed = field(points.nodes.back()) / Real(static_cast<double>(_setup.copies()));
  Matrix<Real> rows = Matrix<Real>::Zero(as_index(d * _setup.maps.size()) + (_setup.phase ? 2 : 1), size + 1);
  Index row = 0;
  for (std::size_t n = 0; n < _setup.maps.size(); ++n, row += size) {
    const Map& map = _setup.maps[n];
    const auto add = [&](const Matrix<Real>& matrix, bool at_end) {
      rows.block(row, 0, size, size) += at_end ? Matrix<Real>(matrix * across) : matrix;
      if (at_end) rows.block(row, size, size, 1) += matrix * speed;
    };
    add(_matrices[n], map.between == Map::Between::end_and_end);
    add(-Matrix<Real>::Identity(size, size), map.between != Map::Between::start_and_start);
  }
  if (_setup.phase) {
    rows.block(row, 0, 1, size) = linearized(points.nodes.front()).row(as_index(*_setup.phase));
    rows(row++, size) = _two_pi * _setup.phase_winding / (points.period * points.period);
  }
  for (std::size_t c = 0; c < d; ++c) rows(row, as_index(c)) = Real(along(as_index(c)) / scale_of(_setup, c));
  rows(row, size) = Real(along(size) / _setup.scales.time);
  Vector<Real> right = Vector<Real>::Zero(rows.rows());
  right(row) = Real(1.0);
  return rows.householderQr().solve(right);
}

template class Shooting<double>;
template class Shooting<numerics::Extended>;

}  // namespace orbweaver::refine
