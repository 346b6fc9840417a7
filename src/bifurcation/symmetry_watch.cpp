#include "orbweaver/bifurcation/symmetry_watch.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/shift_search.hpp"
#include "orbweaver/loop/time_samples.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr double negligible = 1e-8;  // of a broken part, relative to the loop
constexpr std::size_t phases = 3;    // of a reversor that are watched: the closest ones

// Columns: the complex coefficients of harmonics 0 ... K, so that |z|^2 = sum |column|^2 (harmonics weighted by sqrt(1/2)).
Eigen::MatrixXcd coefficients_of(const loop::Loop& loop) {
  Eigen::MatrixXcd out(loop.dimension, loop.cutoff + 1);
  for (int i = 0; i < loop.dimension; ++i) {
    out(i, 0) = loop.cosine(0, i);
    for (int k = 1; k <= loop.cutoff; ++k)
      out(i, k) = std::numbers::sqrt2 / 2.0 * std::complex<double>(loop.cosine(k, i), -loop.sine(k, i));
  }
  return out;
}

bool generates(const loop::Isotropy& group, const Gained& gained) {
  return std::any_of(group.begin(), group.end(), [&](const loop::SymmetryElement& e) {
    return !e.reversing && e.shift_numerator == gained.shift_numerator &&
           e.shift_denominator == gained.shift_denominator && e.matrix.isApprox(gained.matrix, 1e-9);
  });
}

}  // namespace

// An orbit as the watch sees it: 240 samples, as a loop and as complex coefficients.
struct SymmetryWatch::Seen {
  loop::Loop loop;
  Eigen::MatrixXcd coefficients;
  double size;
};

struct SymmetryWatch::Products {
  double first;   // <c(A), c(A)>
  double mixed;   // <c(A), c(B)>
  double second;  // <c(B), c(B)>
};

std::string to_text(const Gained& gained) {
  if (gained.reversing) return gained.name;
  if (gained.shift_numerator == 0) return gained.name + "@0";
  return fmt::format("{}@{}/{}", gained.name, gained.shift_numerator, gained.shift_denominator);
}

SymmetryWatch::SymmetryWatch(const systems::Description& system, const loop::Isotropy& own, int largest_order)
    : _system(system), _own(own) {
  core::require(largest_order >= 1, "a symmetry watch needs orders of 1 or more");
  const loop::Isotropy group = loop::generated_group(system, own);
  const auto consider = [&](const std::string& name, const Eigen::MatrixXd& matrix, int p, int q) {
    Gained candidate{name, false, matrix, p, q, 0.0};
    if (!generates(group, candidate)) _candidates.push_back(std::move(candidate));
  };
  const int d = system.dimension();
  for (int m = 2; m <= largest_order; ++m) consider("1", Eigen::MatrixXd::Identity(d, d), 1, m);
  for (const systems::Symmetry& s : system.equivariances)
    for (int q = 1; q <= largest_order; ++q)
      for (int p = 0; p < q; ++p)
        if (std::gcd(p, q) == 1) consider(s.name, s.matrix, p, q);
  const auto is_reversing = [](const loop::SymmetryElement& e) { return e.reversing; };
  if (std::none_of(group.begin(), group.end(), is_reversing)) _reversors = system.reversors;
}

SymmetryWatch::Seen SymmetryWatch::see(const loop::Loop& loop) const {
  Seen out{loop::interpolant(loop::time_samples(loop)), {}, 0.0};
  out.coefficients = coefficients_of(out.loop);
  out.size = loop::rms_size(out.loop);
  return out;
}

// The coefficients of M^-1 z(t + T shift) - z(t), or of M^-1 z(-t - T shift) - z(t) for a reversor.
Eigen::MatrixXcd SymmetryWatch::broken_part(const Gained& gained, const Eigen::MatrixXd& inverse, const Seen& orbit,
                                            double shift) const {
  const Eigen::MatrixXcd& z = orbit.coefficients;
  Eigen::MatrixXcd image = gained.reversing ? Eigen::MatrixXcd(z.conjugate()) : z;
  const Eigen::Map<const Eigen::VectorXd> winding(orbit.loop.winding.data(), orbit.loop.dimension);
  image.col(0) += (gained.reversing ? -1.0 : 1.0) * two_pi * shift * winding.cast<std::complex<double>>();
  const std::complex<double> step = std::polar(1.0, two_pi * shift);
  std::complex<double> wave = 1.0;
  for (Eigen::Index k = 1; k < image.cols(); ++k) image.col(k) *= wave *= step;
  return inverse * image - z;
}

SymmetryWatch::Products SymmetryWatch::compare(const Gained& gained, const Seen& a, const Seen& b) const {
  const Eigen::MatrixXd inverse = gained.matrix.inverse();
  double shift_of_a = static_cast<double>(gained.shift_numerator) / gained.shift_denominator;
  double shift_of_b = shift_of_a;
  if (gained.reversing) {  // R^-1 z(T phi - t) = y(t - T phi); the phase of B is the one near that of A
    shift_of_a = -gained.phase;
    const loop::Loop image = loop::transformed(b.loop, gained.matrix, true, 0.0);
    shift_of_b = loop::shift_minimum_near(image, b.loop, _system.angles, shift_of_a).shift;
  }
  Eigen::MatrixXcd broken_a = broken_part(gained, inverse, a, shift_of_a);
  Eigen::MatrixXcd broken_b = broken_part(gained, inverse, b, shift_of_b);
  for (const int i : _system.angles) {
    broken_a(i, 0) = std::remainder(broken_a(i, 0).real(), two_pi);
    broken_b(i, 0) -= two_pi * std::round((broken_b(i, 0) - broken_a(i, 0)).real() / two_pi);
  }
  return {broken_a.squaredNorm(), broken_a.cwiseProduct(broken_b.conjugate()).sum().real(), broken_b.squaredNorm()};
}

// Elements of the group that `gained` and the own isotropy generate; a reversor doubles it, whatever its phase.
std::size_t SymmetryWatch::generated_with(const Gained& gained) const {
  if (gained.reversing) return 2 * loop::generated_group(_system, _own).size();
  loop::Isotropy generators = _own;
  generators.push_back({gained.name, false, gained.matrix, gained.shift_numerator, gained.shift_denominator});
  return loop::generated_group(_system, generators).size();
}

std::vector<Gained> SymmetryWatch::all_passed(const loop::Loop& a, const loop::Loop& b) const {
  const Seen from = see(a);
  const Seen to = see(b);
  std::vector<std::pair<std::size_t, Gained>> found;
  const auto consider = [&](const Gained& candidate) {
    const Products products = compare(candidate, from, to);
    if (std::sqrt(products.first) <= negligible * from.size) return;
    if (products.mixed < 0.0 || std::sqrt(products.second) <= negligible * to.size)
      found.emplace_back(generated_with(candidate), candidate);
  };
  const auto keeps_winding = [&from](const Eigen::MatrixXd& matrix, double sign) {
    const Eigen::Map<const Eigen::VectorXd> winding(from.loop.winding.data(), from.loop.dimension);
    return (sign * (matrix * winding) - winding).isZero(1e-9);
  };
  for (const Gained& candidate : _candidates)
    if (keeps_winding(candidate.matrix, 1.0)) consider(candidate);
  for (const systems::Symmetry& r : _reversors) {
    if (!keeps_winding(r.matrix, -1.0)) continue;
    const loop::Loop image = loop::transformed(from.loop, r.matrix, true, 0.0);
    std::vector<loop::ShiftMinimum> minima = loop::shift_minima(image, from.loop, _system.angles);
    if (minima.size() > phases) minima.resize(phases);
    for (const loop::ShiftMinimum& minimum : minima)
      consider({r.name, true, r.matrix, 0, 1, -minimum.shift + std::ceil(minimum.shift)});
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
  std::vector<Gained> out;
  for (auto& [order, gained] : found) out.push_back(std::move(gained));
  return out;
}

std::optional<Gained> SymmetryWatch::passed(const loop::Loop& a, const loop::Loop& b) const {
  std::vector<Gained> all = all_passed(a, b);
  if (all.empty()) return std::nullopt;
  return std::move(all.front());
}

double SymmetryWatch::signed_part(const Gained& gained, const loop::Loop& a, const loop::Loop& at) const {
  const Products products = compare(gained, see(a), see(at));
  return products.mixed / products.first;
}

double SymmetryWatch::relative_size(const Gained& gained, const loop::Loop& a, const loop::Loop& at) const {
  const Products products = compare(gained, see(a), see(at));
  return std::sqrt(products.second / products.first);
}

}  // namespace orbweaver::bifurcation
