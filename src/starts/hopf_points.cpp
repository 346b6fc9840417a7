#include "hopf_points.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "orbweaver/loop/symmetry/isotropy.hpp"
#include "orbweaver/numerics/locate.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Complex = std::complex<double>;

/// Hopf points nearer than this, relative, are at one place.
constexpr double same_place = 1e-9;
/// A step over which eigenvalues become real, or real ones complex, is halved so often.
constexpr int most_halvings = 6;
/// Of an eigenvalue's size: a pair whose sum is smaller than this cancels, and its real part is none.
constexpr double cancels = 1e-6;

/// The product of the sums of two eigenvalues, each divided by its moduli: real, and 0 at Hopf points.
double hopf_function(const CurveEquations& curve, const VectorXd& x) {
  const Eigen::VectorXcd values = curve.eigenvalues(x);
  Complex product = 1.0;
  for (Index i = 0; i < values.size(); ++i)
    for (Index l = i + 1; l < values.size(); ++l)
      product *= (values(i) + values(l)) / (std::abs(values(i)) + std::abs(values(l)));
  return product.real();
}

/// Of the eigenvalues on the imaginary axis there the one nearest to `near`; none where only real ones cancel. Of a
/// double one the vectors in their order, `taken` being passed over.
std::optional<HopfPoint> hopf_at(const CurveEquations& curve, const VectorXd& x, Complex near, std::size_t taken) {
  const GradedSpectrum system = curve.eigensystem(x, true);
  const Eigen::VectorXcd& values = system.values;
  std::vector<Index> on_axis;
  for (Index i = 0; i < values.size(); ++i)
    if (values(i).imag() > cancels * system.sizes(i) && std::abs(values(i).real()) < cancels * system.sizes(i))
      on_axis.push_back(i);
  std::stable_sort(on_axis.begin(), on_axis.end(),
                   [&](Index i, Index l) { return std::abs(values(i) - near) < std::abs(values(l) - near); });
  if (on_axis.size() <= taken) return std::nullopt;  // two real eigenvalues cancel: a neutral saddle
  const Index found = on_axis[taken];
  HopfPoint out;
  out.at = curve.equilibrium(x);
  out.period = 2.0 * std::numbers::pi / values(found).imag();
  out.real_part = values(found).real();
  Eigen::VectorXcd v = system.vectors.col(found);
  // The phase in which z(s = 0) is largest.
  const Complex square = (v.array() * v.array()).sum();
  if (std::abs(square) > 0.0) v *= std::polar(1.0, -0.5 * std::arg(square));
  const double length = v.real().norm();
  loop::Loop loop = loop::constant_loop(out.at.state, out.period, curve.options().cutoff);
  loop.parameters = {out.at.parameter};
  loop::Loop oscillation = loop;
  std::fill(oscillation.modes.begin(), oscillation.modes.end(), 0.0);
  for (Index i = 0; i < curve.dimension(); ++i) {  // Re(v e^{is})
    oscillation.cosine(1, static_cast<int>(i)) = v(i).real() / length;
    oscillation.sine(1, static_cast<int>(i)) = -v(i).imag() / length;
  }
  out.direction.modes = std::move(oscillation.modes);
  out.isotropy = loop::find_isotropy(curve.system().structure(), loop::moved(std::move(loop), out.direction, 1.0),
                                     loop::symmetry_tolerance);
  return out;
}

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

/// Whether a real part is rounding's.
bool may_be_on_axis(Complex value, double size) { return std::abs(value.real()) <= at_end * size; }

/// Whether the eigenvalue nearest to `near` is one whose real part is rounding's.
bool stays_at(const GradedSpectrum& spectrum, Complex near) {
  Index nearest = 0;
  for (Index i = 1; i < spectrum.values.size(); ++i)
    if (std::abs(spectrum.values(i) - near) < std::abs(spectrum.values(nearest) - near)) nearest = i;
  return may_be_on_axis(spectrum.values(nearest), spectrum.sizes(nearest));
}

/// Whether an eigenvalue is zero to rounding.
bool has_zero(const GradedSpectrum& spectrum) {
  return (spectrum.values.cwiseAbs().array() <= at_end * spectrum.sizes.array()).any();
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

/// Hopf points between two nodes, each where one eigenvalue crosses the imaginary axis; where eigenvalues have become
/// real, or real ones complex, the two halves are looked at, and at last the product of all sums.
HopfPoints hopf_between(const CurveEquations& curve, const CurveNode& a, const CurveNode& b, int halvings) {
  const GradedSpectrum at_a = curve.eigensystem(a.x, false);
  const GradedSpectrum at_b = curve.eigensystem(b.x, false);
  const std::vector<Complex> from = oscillating(at_a.values);
  const std::vector<Complex> to = oscillating(at_b.values);
  HopfPoints out;
  // Of one that is zero all along it is not told what it does.
  out.is_undecided = has_zero(at_a) && has_zero(at_b) && !are_one_place(a.x, b.x);
  std::vector<LocatedHopf>& found = out.found;
  const VectorXd chord = b.x - a.x;
  const auto in_halves = [&]() -> std::optional<HopfPoints> {
    int steps = 0;
    const auto middle =
        halvings < most_halvings ? curve.corrected(a.x + 0.5 * chord, chord.normalized(), steps) : std::nullopt;
    if (!middle) return std::nullopt;
    const CurveNode between{*middle, curve.direction(*middle, a.direction)};
    HopfPoints all = hopf_between(curve, a, between, halvings + 1);
    HopfPoints more = hopf_between(curve, between, b, halvings + 1);
    for (LocatedHopf& other : more.found) all.found.push_back(std::move(other));
    all.is_undecided = all.is_undecided || more.is_undecided;
    if (std::isnan(all.stays)) all.stays = more.stays;
    return all;
  };
  if (from.size() != to.size())
    if (auto all = in_halves()) return *std::move(all);
  const auto add = [&](const std::optional<VectorXd>& place, const auto& near) {
    if (!place) return;
    const auto taken = std::count_if(found.begin(), found.end(),
                                     [&](const auto& known) { return are_one_place(known.first, *place); });
    if (auto point = hopf_at(curve, *place, near(*place), 0)) {
      const bool is_known = std::any_of(found.begin(), found.end(), [&](const auto& known) {
        return are_one_place(known.first, *place) &&
               std::abs(known.second.period - point->period) <= same_place * point->period;
      });
      if (is_known) point = hopf_at(curve, *place, near(*place), static_cast<std::size_t>(taken));
      if (point) found.emplace_back(*place, std::move(*point));
    }
  };
  // A place where a pair passes the axis is one alone.
  const auto stays = [&](const Path& path) {
    if (!stays_at(at_a, path.from) || !stays_at(at_b, path.to)) return false;
    int steps = 0;
    const auto middle = curve.corrected(a.x + 0.5 * chord, chord.normalized(), steps);
    return middle && stays_at(curve.eigensystem(*middle, false), 0.5 * (path.from + path.to));
  };
  std::size_t crossings = 0;
  for (const Path& path : paths_between(from, to)) {
    if (stays(path)) {
      out.stays = 2.0 * std::numbers::pi / path.from.imag();
      continue;
    }
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
    if (found.size() == crossings) return out;
    if (auto all = in_halves()) return *std::move(all);
    out.is_undecided = true;
    return out;
  }
  const auto product = [&](const VectorXd& at) { return hopf_function(curve, at); };
  const auto on_axis = [&](const VectorXd& at) {
    const std::vector<Complex> here = oscillating(curve.eigenvalues(at));
    const auto least = std::min_element(here.begin(), here.end(),
                                        [](Complex x, Complex y) { return std::abs(x.real()) < std::abs(y.real()); });
    return least == here.end() ? Complex{} : *least;
  };
  if (std::isnan(out.stays) && found.size() % 2 == 0 && (product(a.x) >= 0.0) != (product(b.x) >= 0.0))
    add(zero_between(curve, a, b, product), on_axis);
  return out;
}

/// Hopf points at an end of the curve, where rounding has the eigenvalue on either side, unless it has so at the node
/// beside it.
void add_at_end(const CurveEquations& curve, const VectorXd& end, const VectorXd& beside,
                std::vector<LocatedHopf>& found) {
  const GradedSpectrum at = curve.eigensystem(end, false);
  const GradedSpectrum near = curve.eigensystem(beside, false);
  for (const Complex value : oscillating(at.values)) {
    if (stays_at(at, value) && stays_at(near, value)) continue;
    const bool is_known = std::any_of(found.begin(), found.end(), [&](const auto& known) {
      return are_one_place(known.first, end) &&
             std::abs(known.second.period - 2.0 * std::numbers::pi / value.imag()) <= same_place * known.second.period;
    });
    if (is_known || !(std::abs(value.real()) <= at_end * std::abs(value))) continue;
    if (auto point = hopf_at(curve, end, value, 0)) found.emplace_back(end, std::move(*point));
  }
}

/// Along the step; those at one place by their periods, the longest first, where the first of them lies.
std::vector<LocatedHopf> in_order(std::vector<LocatedHopf> found, const CurveNode& a, const CurveNode& b) {
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

HopfPoints hopf_points(const CurveEquations& curve, const CurveNode& a, const CurveNode& b, CurveEnds at) {
  HopfPoints out = hopf_between(curve, a, b, 0);
  if (at.first) add_at_end(curve, a.x, b.x, out.found);
  if (at.last) add_at_end(curve, b.x, a.x, out.found);
  out.found = in_order(std::move(out.found), a, b);
  return out;
}

}  // namespace orbweaver::starts
