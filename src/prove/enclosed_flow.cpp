#include "enclosed_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::prove {

namespace {

/// Order of the series a digit: with it a step is about 1/6 of the disc, near the cheapest product of both.
constexpr double order_a_digit = 1.3;
constexpr int least_order = 8;
/// A step is at most this part of the disc, so that the geometric series of what it leaves out falls off.
constexpr double longest_part = 0.5;
constexpr double largest_part = 0.9;  // of a last step, whose time is uncertain
constexpr long disc_bits = 64;        // bounds need no more
constexpr double first_radius = 0.1;
constexpr double larger = 1.25;  // a disc that is tried after one was found
constexpr double smaller = 0.8;  // and after one was not
constexpr int most_discs = 300;  // 0.8^300 is 1e-29
constexpr int most_inflations = 12;
constexpr double inflation = 1.1;

std::vector<int> outputs_of(const systems::Formulas& formulas) {
  std::vector<int> outputs = formulas.field;
  outputs.insert(outputs.end(), formulas.variations.begin(), formulas.variations.end());
  return outputs;
}

/// The state and, for the derivatives' columns, the unit vectors.
template <class Number>
std::vector<Number> with_unit_columns(const std::vector<Number>& z) {
  const std::size_t d = z.size();
  std::vector<Number> inputs = z;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t c = 0; c < d; ++c) inputs.emplace_back(i == c ? 1.0 : 0.0);
  return inputs;
}

/// Any matrix will do for what is to be proven; a good one is orthogonal and turns with what is to be enclosed, its
/// first column along the longest side (Lohner 1987).
BallMatrix frame_of(const BallMatrix& image, const BallMatrix& sides) {
  const auto d = static_cast<Eigen::Index>(image.rows());
  Eigen::MatrixXd matrix(d, d);
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index j = 0; j < d; ++j)
      matrix(i, j) = image.middle_in_double(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  Eigen::VectorXd lengths(d);
  for (Eigen::Index j = 0; j < d; ++j) {
    // Radii lie far below double precision's range of ratios, but not of exponents.
    const double side = sides.at(static_cast<std::size_t>(j), 0).modulus().middle_in_double();
    lengths(j) = matrix.col(j).norm() * side;
  }
  std::vector<Eigen::Index> order(static_cast<std::size_t>(d));
  for (Eigen::Index j = 0; j < d; ++j) order[static_cast<std::size_t>(j)] = j;
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return lengths(a) > lengths(b); });
  Eigen::MatrixXd sorted(d, d);
  for (Eigen::Index j = 0; j < d; ++j) sorted.col(j) = matrix.col(order[static_cast<std::size_t>(j)]);
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(sorted).householderQ();
  BallMatrix frame(image.rows(), image.rows());
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index j = 0; j < d; ++j)
      frame.set(static_cast<std::size_t>(i), static_cast<std::size_t>(j),
                std::isfinite(q(i, j)) ? q(i, j) : (i == j ? 1.0 : 0.0));
  return frame;
}

}  // namespace

/// States x + C r + Q q and derivatives V + Q w: exact x, C, V and Q, and boxes r, q and w.
class EnclosedFlow::Set {
 public:
  explicit Set(const BallVector& box)
      : _centre(BallMatrix::of(box).middle()),
        _carried(BallMatrix::identity(box.size())),
        _box(BallMatrix::of(box) - _centre),
        _frame(BallMatrix::identity(box.size())),
        _rest(box.size(), 1),
        _derivatives(BallMatrix::identity(box.size())),
        _rest_of_derivatives(box.size(), box.size()) {}

  [[nodiscard]] BallVector centre() const { return _centre.column(0); }
  [[nodiscard]] BallVector hull() const { return (_centre + _carried * _box + _frame * _rest).column(0); }
  [[nodiscard]] BallMatrix derivatives() const { return _derivatives + _frame * _rest_of_derivatives; }

  /// `image` holds the image of the centre, `transition` the derivatives of the map at all states of the hull.
  void move(const BallMatrix& image, const BallMatrix& transition) {
    const BallMatrix carried = transition * _carried;
    const BallMatrix derivatives = transition * _derivatives;
    const BallMatrix turned = transition * _frame;
    _centre = image.middle();
    _carried = carried.middle();
    _derivatives = derivatives.middle();
    const BallMatrix frame = frame_of(turned, _rest);
    const BallMatrix back = inverse(frame);
    const BallMatrix change = back * turned;
    _rest = change * _rest + back * ((carried - _carried) * _box + (image - _centre));
    _rest_of_derivatives = change * _rest_of_derivatives + back * (derivatives - _derivatives);
    _frame = frame;
  }

 private:
  BallMatrix _centre;
  BallMatrix _carried;
  BallMatrix _box;
  BallMatrix _frame;
  BallMatrix _rest;
  BallMatrix _derivatives;
  BallMatrix _rest_of_derivatives;
};

EnclosedFlow::EnclosedFlow(const systems::Formulas& formulas, const BallVector& parameters, double digits)
    : _formulas(formulas),
      _parameters(parameters),
      _complex_parameters(parameters.begin(), parameters.end()),
      _digits(digits),
      _order(std::max(least_order, static_cast<int>(std::ceil(order_a_digit * digits)))),
      _state(formulas.graph, formulas.field, parameters, _order),
      _variational(formulas.graph, outputs_of(formulas), parameters, _order),
      _last_radius(first_radius) {
  core::require(parameters.size() == formulas.parameters.size(), "one value a parameter");
}

std::optional<EnclosedFlow::Disc> EnclosedFlow::disc_of_radius(const BallVector& box, double radius) const {
  const std::size_t d = box.size();
  const Ball rho(radius);
  BallVector reach(d);  // |z_i(t) - z_i(0)| is at most this
  for (int n = 0; n < most_inflations; ++n) {
    std::vector<ComplexBall> region;
    for (std::size_t i = 0; i < d; ++i) region.emplace_back(box[i].widened(reach[i]), Ball::around_zero(reach[i]));
    const std::vector<ComplexBall> speed =
        model::evaluate<ComplexBall>(_formulas.graph, _formulas.field, region, _complex_parameters);
    bool holds = n > 0;
    BallVector needed(d);
    for (std::size_t i = 0; i < d; ++i) {
      if (!speed[i].is_finite()) return std::nullopt;
      needed[i] = (rho * speed[i].modulus()).modulus();
      if (!(needed[i] <= reach[i])) holds = false;
    }
    if (holds) {
      const std::vector<ComplexBall> slopes = model::evaluate<ComplexBall>(_formulas.graph, _formulas.variations,
                                                                        with_unit_columns(region), _complex_parameters);
      BallMatrix slope(d, d);
      for (std::size_t i = 0; i < d; ++i)
        for (std::size_t c = 0; c < d; ++c) {
          if (!slopes[i * d + c].is_finite()) return std::nullopt;
          slope.set(i, c, rho * slopes[i * d + c].modulus());
        }
      return Disc{rho, needed, growth_bound(slope)};
    }
    for (std::size_t i = 0; i < d; ++i)
      if (!(needed[i] <= reach[i])) reach[i] = (needed[i] * Ball(inflation)).modulus();
  }
  return std::nullopt;
}

EnclosedFlow::Disc EnclosedFlow::analytic_disc(const BallVector& box, double guess) const {
  const WorkingBits working(disc_bits);
  for (const Ball& z : box)
    if (!z.is_finite()) throw NotProven("a state cannot be enclosed");
  double radius = guess;
  for (int n = 0; n < most_discs; ++n, radius *= smaller)
    if (std::optional<Disc> disc = disc_of_radius(box, radius)) return *disc;
  throw NotProven(
      "no time is short enough for an enclosure of the solutions: the box is too wide, or meets a singularity");
}

double EnclosedFlow::step_size(const Disc& disc) const {
  double largest = std::numeric_limits<double>::min();
  for (const Ball& bound : disc.departure) largest = std::max(largest, bound.upper());
  for (std::size_t i = 0; i < disc.growth.rows(); ++i)
    for (std::size_t c = 0; c < disc.growth.columns(); ++c) largest = std::max(largest, disc.growth.at(i, c).upper());
  const double log_part = (-_digits - std::log10(largest)) / (_order + 1);
  return disc.radius.lower() * std::min(longest_part, std::pow(10.0, log_part));
}

EnclosedFlow::Image EnclosedFlow::advance(const BallVector& box, const Ball& time) {
  const std::size_t d = static_cast<std::size_t>(_formulas.dimension);
  core::require(box.size() == d, "a state of another dimension");
  if (!(time.lower() > 0.0)) throw NotProven("the time is not positive on all of its ball");
  Set set(box);
  const BallMatrix unit = BallMatrix::identity(d);
  BallVector unit_rows;
  for (std::size_t i = 0; i < d; ++i)
    for (std::size_t c = 0; c < d; ++c) unit_rows.push_back(unit.at(i, c));
  Ball remaining = time;
  while (true) {
    if (_steps >= _most_steps) throw NotProven("an enclosure was given up: its steps become ever shorter");
    const BallVector hull = set.hull();
    const Disc disc = analytic_disc(hull, larger * _last_radius);
    _last_radius = disc.radius.middle_in_double();
    const double longest = step_size(disc);
    const bool is_last = remaining.upper() <= longest;
    const Ball step = is_last ? remaining : Ball(longest);
    // Cauchy: the coefficient of t^k is at most the bound on the disc over radius^k.
    const Ball part = step.modulus() / disc.radius;
    if (!(part <= Ball(largest_part))) throw NotProven("the time is too uncertain for its last step");
    Ball left_out;
    arb_pow_ui(left_out.get(), part.get(), static_cast<ulong>(_order) + 1, WorkingBits::in_force());
    left_out = left_out / (Ball(1.0) - part);
    _state.expand(set.centre(), {});
    BallVector image(d);
    for (std::size_t i = 0; i < d; ++i) {
      _state.sum(i, step, image[i]);
      image[i] = image[i].widened(disc.departure[i] * left_out);
    }
    _variational.expand(hull, unit_rows);
    BallMatrix transition(d, d);
    Ball entry;
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t c = 0; c < d; ++c) {
        _variational.sum(d + i * d + c, step, entry);
        transition.set(i, c, entry.widened(disc.growth.at(i, c) * left_out));
      }
    if (!transition.is_finite()) throw NotProven("the Taylor series of a box is not finite: the box is too wide");
    set.move(BallMatrix::of(image), transition);
    ++_steps;
    if (is_last) break;
    remaining -= step;
  }
  Image result{set.hull(), set.derivatives()};
  for (const Ball& z : result.state)
    if (!z.is_finite()) throw NotProven("a state cannot be enclosed");
  return result;
}

BallVector EnclosedFlow::field(const BallVector& z) const {
  return model::evaluate<Ball>(_formulas.graph, _formulas.field, z, _parameters);
}

Ball EnclosedFlow::energy(const BallVector& z) const {
  const std::vector<int> first{_formulas.conserved.front()};
  return model::evaluate<Ball>(_formulas.graph, first, z, _parameters).front();
}

BallVector EnclosedFlow::energy_gradient(const BallVector& z) const {
  return model::evaluate<Ball>(_formulas.graph, _formulas.conserved_gradients.front(), z, _parameters);
}

}  // namespace orbweaver::prove
