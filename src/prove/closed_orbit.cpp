#include "closed_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::prove {

namespace {

using refine::ExactMatrix;
using Quantity = refine::HeldValue::Quantity;

Eigen::MatrixXd middles(const BallMatrix& matrix) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(matrix.rows()), static_cast<Eigen::Index>(matrix.columns()));
  for (std::size_t i = 0; i < matrix.rows(); ++i)
    for (std::size_t j = 0; j < matrix.columns(); ++j)
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = matrix.middle_in_double(i, j);
  return result;
}

/// `count` columns that are as independent as can be, in rising order.
std::vector<std::size_t> independent_columns(const Eigen::MatrixXd& matrix, std::size_t count) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  std::vector<std::size_t> columns;
  for (std::size_t n = 0; n < count; ++n)
    columns.push_back(static_cast<std::size_t>(qr.colsPermutation().indices()(static_cast<Eigen::Index>(n))));
  std::sort(columns.begin(), columns.end());
  return columns;
}

bool may_be_zero(const BallMatrix& matrix) {
  for (std::size_t i = 0; i < matrix.rows(); ++i)
    for (std::size_t j = 0; j < matrix.columns(); ++j)
      if (!matrix.at(i, j).contains(Ball(0.0))) return false;
  return true;
}

}  // namespace

BallMatrix enclosed(const ExactMatrix& matrix, std::size_t size) {
  using Kind = ExactMatrix::Entry::Kind;
  BallMatrix result(size, size);
  for (std::size_t n = 0; n < matrix.entries().size(); ++n) {
    const ExactMatrix::Entry& entry = matrix.entries()[n];
    Ball value(entry.otherwise);
    if (entry.denominator != 0) {
      value = Ball(entry.numerator) / Ball(entry.denominator);
      if (entry.kind == Kind::root) value = sqrt(value);
      if (entry.kind == Kind::cosine) value = cos(Ball(2.0) * Ball::pi() * value);
      value *= Ball(entry.sign);
    }
    result.set(n / size, n % size, value);
  }
  return result;
}

BallVector ClosedOrbit::FixedSet::at(const BallVector& coordinates) const {
  BallVector state = (basis * BallMatrix::of(coordinates)).column(0);
  for (std::size_t i = 0; i < state.size(); ++i) state[i] += offset[i];
  for (std::size_t n = 0; n < rows.size(); ++n) state[rows[n]] = coordinates[n];
  return state;
}

std::vector<double> ClosedOrbit::turns_between(const BallMatrix& matrix, const BallVector& from,
                                               const BallVector& to) const {
  const BallVector image = (matrix * BallMatrix::of(from)).column(0);
  std::vector<double> turns(from.size(), 0.0);
  for (std::size_t i = 0; i < from.size(); ++i)
    if (_structure.is_angle(i)) turns[i] = std::round((to[i] - image[i]).middle_in_double() / (2.0 * std::numbers::pi));
  return turns;
}

// A z + 2 pi n = z for an involution A with A n = -n: z = pi n + c, A c = c.
ClosedOrbit::FixedSet ClosedOrbit::fixed_set(const BallMatrix& matrix, const BallVector& near) const {
  const std::size_t d = dimension();
  const BallMatrix unit = BallMatrix::identity(d);
  if (!may_be_zero(matrix * matrix - unit))
    throw core::InputError("orbits cannot be proven between ends that a reversor keeps which is no involution");
  BallVector turns;
  for (const double n : turns_between(matrix, near, near)) turns.emplace_back(n);
  if (!may_be_zero((matrix + unit) * BallMatrix::of(turns)))
    throw core::InputError("the ends of the orbit do not lie on the fixed sets of its reversors");
  const BallMatrix projector = matrix + unit;  // twice
  const auto rank = static_cast<std::size_t>(std::lround(0.5 * projector.trace().middle_in_double()));
  const Eigen::MatrixXd rough = middles(projector);
  const std::vector<std::size_t> columns = independent_columns(rough, rank);
  Eigen::MatrixXd picked(rough.rows(), static_cast<Eigen::Index>(rank));
  for (std::size_t n = 0; n < rank; ++n)
    picked.col(static_cast<Eigen::Index>(n)) = rough.col(static_cast<Eigen::Index>(columns[n]));
  FixedSet set;
  set.rows = independent_columns(picked.transpose(), rank);
  BallMatrix tall(d, rank);
  BallMatrix square(rank, rank);
  for (std::size_t n = 0; n < rank; ++n) {
    for (std::size_t i = 0; i < d; ++i) tall.set(i, n, projector.at(i, columns[n]));
    for (std::size_t i = 0; i < rank; ++i) square.set(i, n, projector.at(set.rows[i], columns[n]));
  }
  set.basis = rank == 0 ? tall : tall * inverse(square);
  for (std::size_t n = 0; n < rank; ++n)
    for (std::size_t c = 0; c < rank; ++c) set.basis.set(set.rows[n], c, Ball(n == c ? 1.0 : 0.0));
  // The offset is moved along the set until its coordinates there are 0.
  for (const Ball& n : turns) set.offset.push_back(Ball::pi() * n);
  BallVector along;
  for (const std::size_t row : set.rows) along.push_back(set.offset[row]);
  const BallVector shift = (set.basis * BallMatrix::of(along)).column(0);
  for (std::size_t i = 0; i < d; ++i) set.offset[i] -= shift[i];
  return set;
}

ClosedOrbit::ClosedOrbit(const systems::Formulas& formulas, const systems::Structure& structure,
                         const systems::Scales& scales, const loop::Isotropy& isotropy,
                         const std::vector<double>& fractions, const refine::HeldValue& held, const BallVector& start,
                         const BallVector& end)
    : _formulas(formulas), _structure(structure), _fractions(fractions), _held(held) {
  const std::size_t d = dimension();
  const loop::SymmetryGroup group(structure, isotropy);
  const loop::SymmetryElement* at_start = group.reversor_at_start();
  _order = group.order();
  _mirrored = at_start != nullptr;
  if (!group.generator().is_linear() || (_mirrored && !at_start->map.is_linear()))
    throw core::InputError("orbits with a symmetry that shifts the state cannot be proven yet");
  _generator = enclosed(ExactMatrix(group.generator().matrix), d);
  _held_value = Ball::of_decimal(held.decimal) / Ball(period_is_unknown() ? scales.energy() : scales.time);
  for (const double value : formulas.values) _parameters.push_back(Ball::of_decimal(numerics::shortest_decimal(value)));
  const std::string at = period_is_unknown() ? "energy" : "period";
  if (_mirrored) {
    _reversor = enclosed(ExactMatrix(at_start->map.matrix), d);
    _start = fixed_set(_reversor, start);
    _end = fixed_set(_generator * _reversor, end);
    if (_start.rows.size() + _end.rows.size() != d)
      throw core::InputError(fmt::format("the fixed sets at the ends have {} and {} dimensions, not {} together",
                                         _start.rows.size(), _end.rows.size(), d));
    _isolated_by = fmt::format("the {} and the ends on the fixed sets of {} at t = 0 and of {} at t = T/{}", at,
                               at_start->name, _order == 1 ? at_start->name : "g " + at_start->name, 2 * _order);
    return;
  }
  _turns = turns_between(_generator, start, end);
  const EnclosedFlow rough = flow(1.0);
  for (const Ball& z : start) _section_point.push_back(z.middle());
  for (const Ball& speed : rough.field(_section_point)) _section_normal.emplace_back(speed.middle_in_double());
  const BallVector slope = rough.energy_gradient(end);
  for (std::size_t i = 1; i < d; ++i)
    if (std::abs(slope[i].middle_in_double()) > std::abs(slope[_left_out].middle_in_double())) _left_out = i;
  _isolated_by = fmt::format("the {} and the section through its start, across the field there", at);
}

EnclosedFlow ClosedOrbit::flow(double digits) const { return {_formulas, _parameters, digits}; }

std::size_t ClosedOrbit::unknowns() const {
  return first_size() + dimension() * (segments() - 1) + (_mirrored ? _end.rows.size() : 0) +
         (period_is_unknown() ? 1 : 0);
}

Ball ClosedOrbit::fraction(std::size_t node) const {
  if (node == segments()) return Ball(1.0) / Ball(_mirrored ? 2 * _order : _order);
  return {_fractions[node]};
}

BallVector ClosedOrbit::image_of_start(const BallVector& start) const {
  BallVector image = (_generator * BallMatrix::of(start)).column(0);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] += Ball(2.0) * Ball::pi() * Ball(_turns[i]);
  return image;
}

std::vector<BallVector> ClosedOrbit::nodes(const BallVector& unknowns) const {
  const auto part = [&](std::size_t first, std::size_t count) {
    return BallVector(unknowns.begin() + static_cast<std::ptrdiff_t>(first),
                      unknowns.begin() + static_cast<std::ptrdiff_t>(first + count));
  };
  std::vector<BallVector> nodes;
  nodes.push_back(_mirrored ? _start.at(part(0, first_size())) : part(0, first_size()));
  for (std::size_t m = 1; m < segments(); ++m) nodes.push_back(part(place(m), dimension()));
  nodes.push_back(_mirrored ? _end.at(part(place(segments()), _end.rows.size())) : image_of_start(nodes.front()));
  return nodes;
}

Ball ClosedOrbit::period(const BallVector& unknowns) const {
  return period_is_unknown() ? unknowns.back() : _held_value;
}

BallVector ClosedOrbit::candidate(EnclosedFlow& flow, const BallVector& start, const Ball& period) const {
  BallVector unknowns;
  if (_mirrored)
    for (const std::size_t row : _start.rows) unknowns.push_back(start[row].middle());
  else
    for (const Ball& z : start) unknowns.push_back(z.middle());
  BallVector node = _mirrored ? _start.at(unknowns) : unknowns;
  const Ball whole = period_is_unknown() ? period.middle() : _held_value;
  for (std::size_t m = 0; m < segments(); ++m) {
    node = flow.advance(node, (fraction(m + 1) - fraction(m)) * whole).state;
    for (Ball& z : node) z = z.middle();
    if (m + 1 < segments())
      unknowns.insert(unknowns.end(), node.begin(), node.end());
    else if (_mirrored)
      for (const std::size_t row : _end.rows) unknowns.push_back(node[row]);
  }
  if (period_is_unknown()) unknowns.push_back(whole);
  return unknowns;
}

ClosedOrbit::Passage ClosedOrbit::pass(EnclosedFlow& flow, const BallVector& unknowns) const {
  const std::vector<BallVector> states = nodes(unknowns);
  Passage passage;
  for (std::size_t m = 0; m < segments(); ++m)
    passage.push_back(flow.advance(states[m], (fraction(m + 1) - fraction(m)) * period(unknowns)));
  return passage;
}

BallMatrix ClosedOrbit::residual(const EnclosedFlow& flow, const BallVector& unknowns, const Passage& passage) const {
  const std::vector<BallVector> states = nodes(unknowns);
  BallVector rows;
  for (std::size_t m = 0; m < segments(); ++m)
    for (std::size_t i = 0; i < dimension(); ++i)
      if (_mirrored || m + 1 < segments() || i != _left_out) rows.push_back(passage[m].state[i] - states[m + 1][i]);
  if (!_mirrored) {
    Ball sum;
    for (std::size_t i = 0; i < dimension(); ++i) sum += _section_normal[i] * (states.front()[i] - _section_point[i]);
    rows.push_back(sum);
  }
  if (period_is_unknown()) rows.push_back(flow.energy(states.front()) - _held_value);
  core::require(rows.size() == this->unknowns(), "as many equations as unknowns");
  return BallMatrix::of(rows);
}

BallMatrix ClosedOrbit::jacobian(const EnclosedFlow& flow, const BallVector& unknowns, const Passage& passage) const {
  const std::size_t d = dimension();
  const std::vector<BallVector> states = nodes(unknowns);
  BallMatrix result(this->unknowns(), this->unknowns());
  const BallMatrix minus_unit = BallMatrix(d, d) - BallMatrix::identity(d);
  for (std::size_t m = 0; m < segments(); ++m) {
    const bool is_last = m + 1 == segments();
    BallMatrix rows(d, this->unknowns());
    const BallMatrix& transition = passage[m].transition;
    if (m > 0)
      rows.set_block(0, place(m), transition);
    else
      rows.set_block(0, 0, _mirrored ? transition * _start.basis : transition);
    if (!is_last) {
      rows.set_block(0, place(m + 1), minus_unit);
    } else if (_mirrored) {
      rows.set_block(0, place(m + 1), minus_unit * _end.basis);
    } else {
      rows.set_block(0, 0, rows.block(0, 0, d, d) - _generator);
    }
    if (period_is_unknown()) {
      const BallVector speed = flow.field(passage[m].state);
      for (std::size_t i = 0; i < d; ++i) rows.set(i, this->unknowns() - 1, (fraction(m + 1) - fraction(m)) * speed[i]);
    }
    for (std::size_t i = 0, row = d * m; i < d; ++i)
      if (_mirrored || !is_last || i != _left_out) result.set_block(row++, 0, rows.block(i, 0, 1, this->unknowns()));
  }
  std::size_t row = d * segments();
  if (!_mirrored) {
    --row;
    for (std::size_t i = 0; i < d; ++i) result.set(row, i, _section_normal[i]);
    ++row;
  }
  if (period_is_unknown()) {
    BallMatrix slope(1, d);
    const BallVector gradient = flow.energy_gradient(states.front());
    for (std::size_t i = 0; i < d; ++i) slope.set(0, i, gradient[i]);
    result.set_block(row, 0, _mirrored ? slope * _start.basis : slope);
  }
  return result;
}

void ClosedOrbit::require_closes(const EnclosedFlow& flow, const BallVector& unknowns, const Passage& passage) const {
  if (_mirrored) return;
  const std::vector<BallVector> states = nodes(unknowns);
  BallVector both;
  for (std::size_t i = 0; i < dimension(); ++i) {
    Ball hull;
    arb_union(hull.get(), states.back()[i].get(), passage.back().state[i].get(), WorkingBits::in_force());
    both.push_back(hull);
  }
  if (flow.energy_gradient(both)[_left_out].contains(Ball(0.0)))
    throw NotProven("the conserved quantity does not close the orbit: it may be at rest along the equation left out");
}

// Of z(T/p - t) = g R z(t) the derivatives: M(T/p) = g R Phi^-1 (g R)^-1 Phi over the half domain.
std::optional<Ball> ClosedOrbit::fundamental_index(const Passage& passage) const {
  if (_structure.pairs() != 1) return std::nullopt;
  BallMatrix across = passage.front().transition;
  for (std::size_t m = 1; m < passage.size(); ++m) across = passage[m].transition * across;
  const BallMatrix map =
      _mirrored ? _reversor * inverse(across) * inverse(_generator * _reversor) * across : inverse(_generator) * across;
  return map.trace() - Ball(2.0);
}

}  // namespace orbweaver::prove
