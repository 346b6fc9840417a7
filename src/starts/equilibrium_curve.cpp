#include "orbweaver/starts/equilibrium_curve.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/numerics/eigenvalues.hpp"
#include "orbweaver/numerics/locate.hpp"
#include "orbweaver/starts/sweep.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Complex = std::complex<double>;

constexpr int newton_steps = 12;
/// A Newton step below this, in parts of 1 + |z|, is rounding's.
constexpr double converged = 1e-13;
/// Steps grow by this where Newton's method takes at most so many steps, and are halved where it fails.
constexpr double growth = 1.5;
constexpr int few_steps = 4;
/// Cosine of the largest turn of the direction over a step: a longer one may have gone over to another curve.
constexpr double least_cosine = 0.9;
/// Zeros are located to this, in parts of a step.
constexpr double located_to = 1e-12;
/// Hopf points nearer than this, relative, are at one place.
constexpr double same_place = 1e-9;
/// Of an eigenvalue: a real part of the curve's first or last equilibrium that may be rounding's.
constexpr double at_end = 1e-12;
/// A step over which eigenvalues become real, or real ones complex, is halved so often.
constexpr int most_halvings = 6;
/// A branch point is located to this, relative, and then by a chord, which is good to the square of it. There rounding
/// is 1e5 times as large across the curve.
constexpr double near_singular = 1e-5;
constexpr double converged_beside = 1e-8;
/// Steps after which a curve may have come back.
constexpr std::size_t least_round = 8;
/// A determinant of rows of at most length 1 that is smaller is rounding's.
constexpr double dependent = 1e-13;
/// Of the largest eigenvalue: a pair whose sum is smaller than this cancels, and its real part is none.
constexpr double cancels = 1e-6;

/// A place on the curve: the state, then the parameter.
struct Node {
  VectorXd x;
  VectorXd direction;
};

/// A point that was located between two nodes.
struct Between {
  VectorXd x;
  EquilibriumKind kind;
  double period = 0.0;
};

class Curve {
 public:
  Curve(const systems::System& system, const EquilibriumCurveOptions& options)
      : _system(system),
        _name(system.family_scalars().free.front()),
        _unit(system.parameter_scale(_name)),
        _options(options),
        _d(system.dimension()) {}

  struct Linear {
    VectorXd f;
    MatrixXd jacobian;  // d x d
    VectorXd by_parameter;
  };

  [[nodiscard]] Linear at(const VectorXd& x) const {
    const std::shared_ptr<const systems::System> here = _system.with_parameters({{_name, x(_d) * _unit}});
    Linear out{VectorXd(_d), MatrixXd(), VectorXd(_d)};
    RowMajor jacobian(_d, _d);
    here->field_jacobian(1, x.data(), out.f.data(), jacobian.data());
    here->parameter_derivatives(_name, 1, x.data(), out.by_parameter.data());
    out.jacobian = jacobian;
    return out;
  }

  /// On the hyperplane through `guess` across `row`.
  [[nodiscard]] std::optional<VectorXd> corrected(VectorXd x, const VectorXd& row, int& steps,
                                                  double to = converged) const {
    const VectorXd guess = x;
    for (steps = 0; steps < newton_steps; ++steps) {
      const Linear linear = at(x);
      if (!linear.f.allFinite() || !linear.jacobian.allFinite()) return std::nullopt;
      MatrixXd matrix(_d + 1, _d + 1);
      matrix << linear.jacobian, linear.by_parameter, row.transpose();
      VectorXd right(_d + 1);
      right << -linear.f, row.dot(guess - x);
      const VectorXd step = Eigen::PartialPivLU<MatrixXd>(matrix).solve(right);
      if (!step.allFinite()) return std::nullopt;
      x += step;
      if (step.norm() <= to * (1.0 + x.norm())) return x;
    }
    return std::nullopt;
  }

  /// The unit null vector of (J, df/dp), on the side of `near`.
  [[nodiscard]] VectorXd direction(const VectorXd& x, const VectorXd& near) const {
    const Linear linear = at(x);
    MatrixXd matrix(_d + 1, _d + 1);
    matrix << linear.jacobian, linear.by_parameter, near.transpose();
    const VectorXd out = Eigen::PartialPivLU<MatrixXd>(matrix).solve(VectorXd::Unit(_d + 1, _d));
    return out.allFinite() ? VectorXd(out.normalized()) : near;
  }

  [[nodiscard]] Eigen::VectorXcd eigenvalues(const VectorXd& x) const { return eigensystem(x, false).values; }

  [[nodiscard]] numerics::Eigensystem eigensystem(const VectorXd& x, bool with_vectors) const {
    std::optional<numerics::Eigensystem> system = numerics::eigensystem(at(x).jacobian, with_vectors);
    if (!system)
      throw core::NumericalError(
          fmt::format("the eigenvalues of the Jacobian at the equilibrium at {} = {:.9g}: the QR "
                      "iteration does not converge",
                      _name, x(_d)));
    return std::move(*system);
  }

  /// The product of the sums of two eigenvalues, each divided by its moduli: real, and 0 at Hopf points.
  [[nodiscard]] double hopf_function(const VectorXd& x) const {
    const Eigen::VectorXcd values = eigenvalues(x);
    Complex product = 1.0;
    for (Index i = 0; i < values.size(); ++i)
      for (Index l = i + 1; l < values.size(); ++l)
        product *= (values(i) + values(l)) / (std::abs(values(i)) + std::abs(values(l)));
    return product.real();
  }

  /// Derivatives of the equation by state and parameter, then the curve's direction.
  [[nodiscard]] MatrixXd bordered(const VectorXd& x, const VectorXd& near) const {
    const Linear linear = at(x);
    MatrixXd matrix(_d + 1, _d + 1);
    matrix << linear.jacobian, linear.by_parameter, direction(x, near).transpose();
    return matrix;
  }

  /// The real eigenvalue of least modulus; NaN without one.
  [[nodiscard]] double least_real_eigenvalue(const VectorXd& x) const {
    double least = std::numeric_limits<double>::quiet_NaN();
    for (const Complex value : eigenvalues(x))
      if (value.imag() == 0.0 && !(std::abs(value.real()) >= std::abs(least))) least = value.real();
    return least;
  }

  /// Of the eigenvalues on the imaginary axis there the one nearest to `near`; none where only real ones cancel. Of a
  /// double one the vectors in their order, `taken` being passed over.
  [[nodiscard]] std::optional<HopfPoint> hopf_at(const VectorXd& x, Complex near, std::size_t taken) const;
  [[nodiscard]] Equilibrium equilibrium(const VectorXd& x) const { return {{x.data(), x.data() + _d}, x(_d)}; }
  [[nodiscard]] bool is_within(double parameter) const {
    return parameter >= _options.parameter_from && parameter <= _options.parameter_to;
  }
  [[nodiscard]] const EquilibriumCurveOptions& options() const { return _options; }
  [[nodiscard]] Index dimension() const { return _d; }
  [[nodiscard]] const std::string& name() const { return _name; }
  [[nodiscard]] double unit() const { return _unit; }

 private:
  const systems::System& _system;
  const std::string& _name;
  double _unit;
  const EquilibriumCurveOptions& _options;
  Index _d;
};

std::optional<HopfPoint> Curve::hopf_at(const VectorXd& x, Complex near, std::size_t taken) const {
  const numerics::Eigensystem system = eigensystem(x, true);
  const Eigen::VectorXcd& values = system.values;
  const double largest = values.cwiseAbs().maxCoeff();
  std::vector<Index> on_axis;
  for (Index i = 0; i < values.size(); ++i)
    if (values(i).imag() > cancels * largest && std::abs(values(i).real()) < cancels * largest) on_axis.push_back(i);
  std::stable_sort(on_axis.begin(), on_axis.end(),
                   [&](Index i, Index l) { return std::abs(values(i) - near) < std::abs(values(l) - near); });
  if (on_axis.size() <= taken) return std::nullopt;  // two real eigenvalues cancel: a neutral saddle
  const Index found = on_axis[taken];
  HopfPoint out;
  out.at = equilibrium(x);
  out.period = 2.0 * std::numbers::pi / values(found).imag();
  out.real_part = values(found).real();
  Eigen::VectorXcd v = system.vectors.col(found);
  // The phase in which z(s = 0) is largest.
  const Complex square = (v.array() * v.array()).sum();
  if (std::abs(square) > 0.0) v *= std::polar(1.0, -0.5 * std::arg(square));
  const double length = v.real().norm();
  loop::Loop loop = loop::constant_loop(out.at.state, out.period, _options.cutoff);
  loop.parameters = {out.at.parameter};
  loop::Loop oscillation = loop;
  std::fill(oscillation.modes.begin(), oscillation.modes.end(), 0.0);
  for (Index i = 0; i < _d; ++i) {  // Re(v e^{is})
    oscillation.cosine(1, static_cast<int>(i)) = v(i).real() / length;
    oscillation.sine(1, static_cast<int>(i)) = -v(i).imag() / length;
  }
  out.direction.modes = std::move(oscillation.modes);
  out.isotropy = loop::find_isotropy(_system.structure(), loop::moved(std::move(loop), out.direction, 1.0),
                                     loop::symmetry_tolerance);
  return out;
}

/// One side of the curve, from a node on.
class Side {
 public:
  Side(const Curve& curve, Node start) : _curve(curve), _nodes{std::move(start)} {}

  void run() {
    const EquilibriumCurveOptions& options = _curve.options();
    double length = options.largest_step;
    while (_end.empty()) {
      if (static_cast<int>(_nodes.size()) >= options.most_points)
        _end = fmt::format("{} points", options.most_points);
      else if (!step(length))
        break;
    }
  }
  [[nodiscard]] const std::vector<Node>& nodes() const { return _nodes; }
  [[nodiscard]] const std::string& end() const { return _end; }

 private:
  bool step(double& length) {
    const EquilibriumCurveOptions& options = _curve.options();
    const Node& last = _nodes.back();
    const Index p = _curve.dimension();
    while (length >= options.smallest_step) {
      int steps = 0;
      const auto x = _curve.corrected(last.x + length * last.direction, last.direction, steps);
      if (x) {
        Node next{*x, _curve.direction(*x, last.direction)};
        if (next.direction.dot(last.direction) >= least_cosine) return accept(std::move(next), steps, length);
      }
      length *= 0.5;
    }
    _end = fmt::format("no equilibrium further on from {} = {:.9g}", _curve.name(), last.x(p) * _curve.unit());
    return false;
  }

  bool accept(Node next, int steps, double& length) {
    const EquilibriumCurveOptions& options = _curve.options();
    const Index p = _curve.dimension();
    if (!_curve.is_within(next.x(p))) {
      const double limit = next.x(p) > options.parameter_to ? options.parameter_to : options.parameter_from;
      const double share = (limit - _nodes.back().x(p)) / (next.x(p) - _nodes.back().x(p));
      VectorXd guess = _nodes.back().x + share * (next.x - _nodes.back().x);
      guess(p) = limit;
      int more = 0;
      if (const auto x = _curve.corrected(guess, VectorXd::Unit(p + 1, p), more))
        _nodes.push_back({*x, _curve.direction(*x, next.direction)});
      _end = fmt::format("parameter limit ({} = {:g})", _curve.name(), limit * _curve.unit());
      return false;
    }
    _nodes.push_back(std::move(next));
    if ((_nodes.back().x - _nodes.front().x).norm() > options.largest_state) {
      _end = "it leaves for infinity";
      return false;
    }
    if (_nodes.size() > least_round && (_nodes.back().x - _nodes.front().x).norm() < length) {
      _end = "closed curve";
      return false;
    }
    if (steps <= few_steps) length = std::min(options.largest_step, growth * length);
    return true;
  }

  const Curve& _curve;
  std::vector<Node> _nodes;
  std::string _end;
};

bool are_one_place(const VectorXd& x, const VectorXd& y) { return (x - y).norm() <= same_place * (1.0 + y.norm()); }

/// The eigenvalues above the real axis.
std::vector<Complex> oscillating(const Eigen::VectorXcd& values) {
  std::vector<Complex> out;
  for (Index i = 0; i < values.size(); ++i)
    if (values(i).imag() > 0.0) out.push_back(values(i));
  return out;
}

/// The one of `values` nearest to another; their number where there is none.
std::size_t nearest_of(const std::vector<Complex>& values, Complex to) {
  const auto found = std::min_element(values.begin(), values.end(),
                                      [&](Complex a, Complex b) { return std::abs(a - to) < std::abs(b - to); });
  return static_cast<std::size_t>(found - values.begin());
}

/// An eigenvalue above the real axis and what it becomes.
struct Path {
  Complex from;
  Complex to;
  [[nodiscard]] bool crosses() const { return (from.real() >= 0.0) != (to.real() >= 0.0); }
};

/// Each eigenvalue of one place with the nearest of those of the other that are left, the nearest first.
std::vector<Path> paths_between(std::vector<Complex> from, std::vector<Complex> to) {
  std::vector<Path> paths;
  while (!from.empty() && !to.empty()) {
    std::size_t best = 0;
    for (std::size_t n = 1; n < from.size(); ++n)
      if (std::abs(from[n] - to[nearest_of(to, from[n])]) < std::abs(from[best] - to[nearest_of(to, from[best])]))
        best = n;
    const std::size_t end = nearest_of(to, from[best]);
    paths.push_back({from[best], to[end]});
    from.erase(from.begin() + static_cast<std::ptrdiff_t>(best));
    to.erase(to.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return paths;
}

/// The zero of a function of places between two nodes: the corrected place on the chord, share of the way.
template <class F>
std::optional<VectorXd> zero_between(const Curve& curve, const Node& a, const Node& b, const F& function) {
  const VectorXd chord = b.x - a.x;
  std::optional<VectorXd> place;
  const auto there = [&](double share) {
    int steps = 0;
    place = curve.corrected(a.x + share * chord, chord.normalized(), steps);
    return place ? function(*place) : std::numeric_limits<double>::quiet_NaN();
  };
  const auto found = numerics::locate_root(there, 0.0, 1.0, located_to);
  if (!found) return std::nullopt;
  static_cast<void>(there(found->position));
  return place;
}

/// The same beside another curve, which passes through the zero: by halves, each from the cubic through the places and
/// directions of its ends, which comes nearer to this curve than the other one is; the last of them by a chord.
template <class F>
std::optional<VectorXd> zero_beside_curve(const Curve& curve, Node a, Node b, const F& function) {
  double at_a = function(a.x);
  double at_b = function(b.x);
  if (!(at_a * at_b < 0.0)) return std::nullopt;
  while ((b.x - a.x).norm() > near_singular * (1.0 + a.x.norm())) {
    const VectorXd chord = b.x - a.x;
    const VectorXd guess = 0.5 * (a.x + b.x) + 0.125 * chord.norm() * (a.direction - b.direction);
    int steps = 0;
    const auto x = curve.corrected(guess, chord.normalized(), steps, converged_beside);
    if (!x) return std::nullopt;
    Node middle{*x, curve.direction(*x, a.direction)};
    const double value = function(*x);
    if (!(std::abs(value) > 0.0)) return x;
    const bool is_before = value * at_a < 0.0;
    (is_before ? at_b : at_a) = value;
    (is_before ? b : a) = std::move(middle);
  }
  return VectorXd(a.x + at_a / (at_a - at_b) * (b.x - a.x));
}

/// Hopf points between two nodes, each where one eigenvalue crosses the imaginary axis; where eigenvalues have become
/// real, or real ones complex, the two halves are looked at, and at last the product of all sums.
std::vector<std::pair<VectorXd, HopfPoint>> hopf_between(const Curve& curve, const Node& a, const Node& b,
                                                         int halvings = 0) {
  const Eigen::VectorXcd at_a = curve.eigenvalues(a.x);
  const Eigen::VectorXcd at_b = curve.eigenvalues(b.x);
  const std::vector<Complex> from = oscillating(at_a);
  const std::vector<Complex> to = oscillating(at_b);
  std::vector<std::pair<VectorXd, HopfPoint>> found;
  const VectorXd chord = b.x - a.x;
  const auto in_halves = [&]() -> std::optional<std::vector<std::pair<VectorXd, HopfPoint>>> {
    int steps = 0;
    const auto middle =
        halvings < most_halvings ? curve.corrected(a.x + 0.5 * chord, chord.normalized(), steps) : std::nullopt;
    if (!middle) return std::nullopt;
    const Node between{*middle, curve.direction(*middle, a.direction)};
    std::vector<std::pair<VectorXd, HopfPoint>> all = hopf_between(curve, a, between, halvings + 1);
    for (auto& other : hopf_between(curve, between, b, halvings + 1)) all.push_back(std::move(other));
    return all;
  };
  if (from.size() != to.size())
    if (auto all = in_halves()) return *std::move(all);
  const auto add = [&](const std::optional<VectorXd>& place, const auto& near) {
    if (!place) return;
    const auto taken = std::count_if(found.begin(), found.end(),
                                     [&](const auto& known) { return are_one_place(known.first, *place); });
    if (auto point = curve.hopf_at(*place, near(*place), 0)) {
      const bool is_known = std::any_of(found.begin(), found.end(), [&](const auto& known) {
        return are_one_place(known.first, *place) &&
               std::abs(known.second.period - point->period) <= same_place * point->period;
      });
      if (is_known) point = curve.hopf_at(*place, near(*place), static_cast<std::size_t>(taken));
      if (point) found.emplace_back(*place, std::move(*point));
    }
  };
  std::size_t crossings = 0;
  for (const Path& path : paths_between(from, to)) {
    if (!path.crosses()) continue;
    ++crossings;
    const auto near = [&](const VectorXd& at) {
      const double share = chord.dot(at - a.x) / chord.squaredNorm();
      const std::vector<Complex> here = oscillating(curve.eigenvalues(at));
      const Complex expected = path.from + share * (path.to - path.from);
      const std::size_t n = nearest_of(here, expected);
      return n < here.size() ? here[n] : expected;
    };
    add(zero_between(curve, a, b, [&](const VectorXd& at) { return near(at).real(); }), near);
  }
  if (from.size() == to.size()) {  // where eigenvalues come near one another they may be taken for one another
    std::optional<std::vector<std::pair<VectorXd, HopfPoint>>> all;
    if (found.size() < crossings) all = in_halves();
    return all ? *std::move(all) : found;
  }
  const auto product = [&](const VectorXd& at) { return curve.hopf_function(at); };
  const auto on_axis = [&](const VectorXd& at) {
    const std::vector<Complex> here = oscillating(curve.eigenvalues(at));
    const auto least = std::min_element(here.begin(), here.end(),
                                        [](Complex x, Complex y) { return std::abs(x.real()) < std::abs(y.real()); });
    return least == here.end() ? Complex{} : *least;
  };
  if (found.size() % 2 == 0 && (product(a.x) >= 0.0) != (product(b.x) >= 0.0))
    add(zero_between(curve, a, b, product), on_axis);
  return found;
}

int positive_real(const Eigen::VectorXcd& values) {
  return static_cast<int>(std::count_if(
      values.begin(), values.end(), [](const Complex& value) { return value.imag() == 0.0 && value.real() > 0.0; }));
}

/// The sign of the determinant of the equation bordered by the curve's direction; 0 where rounding has it.
int sign_of_determinant(const Curve& curve, const Node& node) {
  const MatrixXd matrix = curve.bordered(node.x, node.direction);
  const double value =
      Eigen::PartialPivLU<MatrixXd>(matrix.rowwise().norm().cwiseInverse().asDiagonal() * matrix).determinant();
  return std::abs(value) > dependent ? (value > 0.0 ? 1 : -1) : 0;
}

/// Where that determinant passes zero between two nodes.
std::optional<VectorXd> branch_point_between(const Curve& curve, const Node& a, const Node& b) {
  const VectorXd lengths =
      curve.bordered(a.x, a.direction).rowwise().norm().cwiseMax(curve.bordered(b.x, a.direction).rowwise().norm());
  return zero_beside_curve(curve, a, b, [&](const VectorXd& at) {
    const MatrixXd scaled = lengths.cwiseInverse().asDiagonal() * curve.bordered(at, a.direction);
    return Eigen::PartialPivLU<MatrixXd>(scaled).determinant();
  });
}

/// Where an even number of real eigenvalues pass zero together, and the determinant keeps its sign.
std::optional<VectorXd> double_branch_point_between(const Curve& curve, const Node& a, const Node& b) {
  const int change = positive_real(curve.eigenvalues(b.x)) - positive_real(curve.eigenvalues(a.x));
  if (change == 0 || change % 2 != 0) return std::nullopt;
  const auto least = [&](const VectorXd& at) { return curve.least_real_eigenvalue(at); };
  for (const Node* node : {&a, &b})
    if (std::abs(least(node->x)) <= at_end * curve.eigenvalues(node->x).cwiseAbs().maxCoeff()) return node->x;
  if (!(least(a.x) * least(b.x) < 0.0)) return std::nullopt;  // two have met and left the axis, or come to it
  return zero_beside_curve(curve, a, b, least);
}

/// Where other curves pass through, between node n - 1 and node n, which may be such a place itself.
std::optional<VectorXd> branch_point_before(const Curve& curve, const std::vector<Node>& nodes,
                                            const std::vector<int>& signs, std::size_t n, bool folds) {
  if (signs[n - 1] * signs[n] < 0) return branch_point_between(curve, nodes[n - 1], nodes[n]);
  if (signs[n] == 0 && n + 1 < nodes.size() && signs[n - 1] * signs[n + 1] < 0) return nodes[n].x;
  return folds ? std::nullopt : double_branch_point_between(curve, nodes[n - 1], nodes[n]);
}

/// Hopf points at an end of the curve, where rounding has the eigenvalue on either side.
void add_at_end(const Curve& curve, const VectorXd& end, std::vector<std::pair<VectorXd, HopfPoint>>& found) {
  for (const Complex value : oscillating(curve.eigenvalues(end))) {
    const bool is_known = std::any_of(found.begin(), found.end(), [&](const auto& known) {
      return are_one_place(known.first, end) &&
             std::abs(known.second.period - 2.0 * std::numbers::pi / value.imag()) <= same_place * known.second.period;
    });
    if (is_known || !(std::abs(value.real()) <= at_end * std::abs(value))) continue;
    if (auto point = curve.hopf_at(end, value, 0)) found.emplace_back(end, std::move(*point));
  }
}

/// Along the step; those at one place by their periods, the longest first, where the first of them lies.
std::vector<std::pair<VectorXd, HopfPoint>> in_order(std::vector<std::pair<VectorXd, HopfPoint>> found, const Node& a,
                                                     const Node& b) {
  const VectorXd chord = b.x - a.x;
  std::sort(found.begin(), found.end(),
            [&](const auto& x, const auto& y) { return chord.dot(x.first) < chord.dot(y.first); });
  for (std::size_t n = 0; n < found.size();) {
    std::size_t end = n + 1;
    while (end < found.size() && are_one_place(found[end].first, found[n].first)) ++end;
    for (std::size_t m = n + 1; m < end; ++m) found[m].first = found[n].first;
    std::stable_sort(found.begin() + static_cast<std::ptrdiff_t>(n), found.begin() + static_cast<std::ptrdiff_t>(end),
                     [](const auto& x, const auto& y) { return x.second.period > y.second.period; });
    n = end;
  }
  return found;
}

}  // namespace

EquilibriumCurve follow_equilibrium(const systems::System& system, std::span<const double> start,
                                    const EquilibriumCurveOptions& options) {
  core::require(!system.family_scalars().free.empty(), "equilibria are followed in a parameter that moves");
  core::require(static_cast<int>(start.size()) == system.dimension(), "a state of another dimension");
  const Curve curve(system, options);
  const Index d = curve.dimension();
  VectorXd x(d + 1);
  for (Index i = 0; i < d; ++i) x(i) = start[static_cast<std::size_t>(i)];
  x(d) = system.parameters().at(curve.name()) / curve.unit();
  int steps = 0;
  const auto first = curve.corrected(x, VectorXd::Unit(d + 1, d), steps);
  if (!first) throw core::NumericalError("Newton's method reaches no equilibrium from the start of the curve");
  const VectorXd ahead = curve.direction(*first, VectorXd::Unit(d + 1, d));
  Side up(curve, {*first, ahead});
  Side down(curve, {*first, -ahead});
  up.run();
  down.run();

  std::vector<Node> nodes(down.nodes().rbegin(), down.nodes().rend());
  for (Node& node : nodes) node.direction *= -1.0;
  nodes.insert(nodes.end(), up.nodes().begin() + 1, up.nodes().end());
  EquilibriumCurve out;
  out.ends = {down.end(), up.end()};
  const std::size_t begin = down.nodes().size() - 1;
  const auto length = [&](std::size_t from, std::size_t to) {
    double sum = 0.0;
    for (std::size_t n = from; n < to; ++n) sum += (nodes[n + 1].x - nodes[n].x).norm();
    return sum;
  };
  out.points.push_back({curve.equilibrium(nodes.front().x)});
  std::vector<int> signs;
  for (const Node& node : nodes) signs.push_back(sign_of_determinant(curve, node));
  for (std::size_t n = 1; n < nodes.size(); ++n) {
    const Node& a = nodes[n - 1];
    const Node& b = nodes[n];
    std::vector<Between> between;
    const bool folds = a.direction(d) * b.direction(d) < 0.0;
    const auto branch = branch_point_before(curve, nodes, signs, n, folds);
    if (branch) between.push_back({*branch, EquilibriumKind::branch_point});
    if (folds) {
      const auto slope = [&](const VectorXd& at) { return curve.direction(at, a.direction)(d); };
      auto fold = zero_between(curve, a, b, slope);
      if (branch || !fold) fold = zero_beside_curve(curve, a, b, slope);
      if (fold) {
        out.folds.push_back(curve.equilibrium(*fold));
        between.push_back({*fold, EquilibriumKind::fold});
      }
    }
    const double started = nodes[begin].x(d);
    if ((a.x(d) - started) * (b.x(d) - started) < 0.0)
      if (const auto again = zero_between(curve, a, b, [&](const VectorXd& at) { return at(d) - started; }))
        between.push_back({*again, EquilibriumKind::came_back});
    auto hopf = hopf_between(curve, a, b);
    if (n == 1) add_at_end(curve, a.x, hopf);
    if (n + 1 == nodes.size()) add_at_end(curve, b.x, hopf);
    for (auto& [place, point] : in_order(std::move(hopf), a, b)) {
      const double within = n > begin ? (place - a.x).norm() : (b.x - place).norm();
      point.distance = within + (n > begin ? length(begin, n - 1) : length(n, begin));
      between.push_back({place, EquilibriumKind::hopf, point.period});
      out.hopf.push_back(std::move(point));
    }
    const VectorXd chord = b.x - a.x;
    std::stable_sort(between.begin(), between.end(),
                     [&](const Between& one, const Between& other) { return chord.dot(one.x) < chord.dot(other.x); });
    for (const Between& point : between) out.points.push_back({curve.equilibrium(point.x), point.kind, point.period});
    if (n == begin) out.start = out.points.size();
    out.points.push_back({curve.equilibrium(b.x)});
  }
  return out;
}

}  // namespace orbweaver::starts
