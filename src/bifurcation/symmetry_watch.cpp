#include "orbweaver/bifurcation/symmetry_watch.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/curve/time_samples.hpp"
#include "orbweaver/loop/symmetry/shift_search.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::bifurcation {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
/// Of a broken part, relative to the loop: orbits that have the symmetry have it to the corrector's accuracy, and a
/// branch is born with a part of the size of its first amplitude.
constexpr double negligible = 1e-8;
/// What samples leave out may be this share of the broken part. Not measured.
constexpr double small_share = 0.01;
/// Phases of a reversor that are watched, the closest ones. Not measured.
constexpr std::size_t phases = 3;
/// Of the amplitude: what breaks a symmetry that is about to be gained. Not measured.
constexpr double nearly = 0.2;
/// Windings are whole numbers: anything below a half would do.
constexpr double same_winding = 1e-9;
/// Rounding of a correlation in parts of |A|^2 + |B|^2, with room: what is below is computed without cancellation.
constexpr double correlation_rounding = 1e-13;

// Columns: the complex coefficients of harmonics 0 ... K, so that |z|^2 = sum |column|^2 (harmonics weighted by
// sqrt(1/2)).
Eigen::MatrixXcd coefficients_of(const loop::Loop& loop) {
  Eigen::MatrixXcd out(loop.dimension, loop.cutoff + 1);
  for (int i = 0; i < loop.dimension; ++i) {
    out(i, 0) = loop.cosine(0, i);
    for (int k = 1; k <= loop.cutoff; ++k)
      out(i, k) = std::numbers::sqrt2 / 2.0 * std::complex<double>(loop.cosine(k, i), -loop.sine(k, i));
  }
  return out;
}

/// Whether the loop goes around an orbit a number of times, the shift's denominator.
bool is_repetition(const SymmetryGain& gain) {
  return !gain.reversing && gain.shift_numerator == 1 && gain.name == "1";
}

double shift_of(const SymmetryGain& gain) { return static_cast<double>(gain.shift_numerator) / gain.shift_denominator; }

// Broken means modulo the lattice of angles: A's within a half turn of 0, B's within a half turn of A's.
void reduce(const std::vector<int>& angles, Eigen::VectorXd& of_a, Eigen::VectorXd& of_b) {
  for (const int i : angles) {
    of_a(i) = std::remainder(of_a(i), two_pi);
    of_b(i) -= two_pi * std::round((of_b(i) - of_a(i)) / two_pi);
  }
}

bool keeps_winding(const Eigen::MatrixXd& matrix, double sign, const loop::Loop& loop) {
  const Eigen::Map<const Eigen::VectorXd> winding(loop.winding.data(), loop.dimension);
  return (sign * (matrix * winding) - winding).isZero(same_winding);
}

// Those that generate the most first.
std::vector<SymmetryGain> ordered(std::vector<std::pair<std::size_t, SymmetryGain>> found) {
  std::stable_sort(found.begin(), found.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
  std::vector<SymmetryGain> out;
  for (auto& [order, gain] : found) out.push_back(std::move(gain));
  return out;
}

bool contains(const loop::Isotropy& group, const SymmetryGain& gain, const std::vector<int>& angles) {
  return std::any_of(group.begin(), group.end(), [&](const loop::SymmetryElement& e) {
    return !e.reversing && e.shift_numerator == gain.shift_numerator && e.shift_denominator == gain.shift_denominator &&
           e.map.is_same(gain.map, angles);
  });
}

}  // namespace

struct SymmetryWatch::Products {
  double first;   // <c(A), c(A)>
  double mixed;   // <c(A), c(B)>
  double second;  // <c(B), c(B)>
};

struct SymmetryWatch::Resolved {
  const SampledOrbit& a;
  const SampledOrbit& b;
  std::optional<SampledOrbit> finer_a{};
  std::optional<SampledOrbit> finer_b{};
};

SymmetryWatch::SymmetryWatch(const systems::Structure& system, const loop::Isotropy& own, int largest_order,
                             int largest_repetition)
    : _system(system), _own(own) {
  core::require(largest_order >= 1 && largest_repetition >= 1, "a symmetry watch needs orders of 1 or more");
  const loop::Isotropy group = loop::SymmetryGroup(system, own).elements();
  std::vector<systems::Symmetry> symmetries{{"1", systems::AffineMap::identity(system.dimension)}};
  symmetries.insert(symmetries.end(), system.equivariances.begin(), system.equivariances.end());
  for (const systems::Symmetry& s : symmetries) {
    const bool is_identity = &s == &symmetries.front();  // 1@p/q generates 1@1/q
    Shifted shifted{s, {}};
    for (int q = is_identity ? 2 : 1; q <= (is_identity ? largest_repetition : largest_order); ++q)
      for (int p = is_identity ? 1 : 0; p < (is_identity ? 2 : q); ++p) {
        SymmetryGain candidate{s.name, false, s.map, p, q, 0.0};
        const bool is_new = is_identity || std::gcd(p, q) == 1;
        if (is_new && !contains(group, candidate, system.angles)) shifted.candidates.push_back(std::move(candidate));
      }
    _equivariances.push_back(std::move(shifted));
  }
  const auto is_reversing = [](const loop::SymmetryElement& e) { return e.reversing; };
  if (std::none_of(group.begin(), group.end(), is_reversing)) _reversors = system.reversors;
}

namespace {

SymmetryWatch::SampledOrbit sampled_with(const loop::Loop& source, loop::Loop even) {
  SymmetryWatch::SampledOrbit out{source, std::move(even), {}, 0.0, 0.0};
  out.coefficients = coefficients_of(out.loop);
  out.size = loop::rms_size(out.loop);
  if (!source.time_map.is_identity()) out.left_out = loop::tail(out.loop);
  return out;
}

}  // namespace

SymmetryWatch::SampledOrbit SymmetryWatch::sampled(const loop::Loop& loop) {
  return sampled_with(loop, loop.time_map.is_identity() ? loop : loop::interpolant(loop::time_samples(loop)));
}

// The coefficients of M^-1 z(t + T shift) - z(t), or of M^-1 z(-t - T shift) - z(t) for a reversor. Of a repetition,
// all of them that are not repeated, with one weight: a short shift changes slow harmonics little.
Eigen::MatrixXcd SymmetryWatch::broken_part(const SymmetryGain& gain, const systems::AffineMap& inverse,
                                            const SampledOrbit& orbit, double shift) const {
  const Eigen::MatrixXcd& z = orbit.coefficients;
  Eigen::MatrixXcd image = gain.reversing ? Eigen::MatrixXcd(z.conjugate()) : z;
  const Eigen::Map<const Eigen::VectorXd> winding(orbit.loop.winding.data(), orbit.loop.dimension);
  image.col(0) += (gain.reversing ? -1.0 : 1.0) * two_pi * shift * winding.cast<std::complex<double>>();
  if (is_repetition(gain)) {
    Eigen::MatrixXcd broken = -z;
    broken.col(0) += image.col(0);
    for (Eigen::Index k = gain.shift_denominator; k < z.cols(); k += gain.shift_denominator) broken.col(k).setZero();
    return broken;
  }
  const std::complex<double> step = std::polar(1.0, two_pi * shift);
  std::complex<double> wave = 1.0;
  for (Eigen::Index k = 1; k < image.cols(); ++k) image.col(k) *= wave *= step;
  Eigen::MatrixXcd broken = inverse.matrix * image - z;
  if (!inverse.is_linear()) broken.col(0) += inverse.offset.cast<std::complex<double>>();
  return broken;
}

SymmetryWatch::Products SymmetryWatch::compare(const SymmetryGain& gain, const SampledOrbit& a,
                                               const SampledOrbit& b) const {
  const systems::AffineMap inverse = gain.map.inverse();
  double shift_of_a = shift_of(gain);
  double shift_of_b = shift_of_a;
  if (gain.reversing) {  // R^-1 z(T phi - t) = y(t - T phi); the phase of B is the one near that of A
    shift_of_a = -gain.phase;
    const loop::Loop image = loop::transformed(b.loop, gain.map, true, 0.0);
    shift_of_b = loop::shift_minimum_near(image, b.loop, _system.angles, shift_of_a).shift;
  }
  Eigen::MatrixXcd broken_a = broken_part(gain, inverse, a, shift_of_a);
  Eigen::MatrixXcd broken_b = broken_part(gain, inverse, b, shift_of_b);
  Eigen::VectorXd mean_a = broken_a.col(0).real();
  Eigen::VectorXd mean_b = broken_b.col(0).real();
  reduce(_system.angles, mean_a, mean_b);
  broken_a.col(0) = mean_a;
  broken_b.col(0) = mean_b;
  const Eigen::Index both = std::min(broken_a.cols(), broken_b.cols());
  const double mixed = broken_a.leftCols(both).cwiseProduct(broken_b.leftCols(both).conjugate()).sum().real();
  return {broken_a.squaredNorm(), mixed, broken_b.squaredNorm()};
}

SymmetryWatch::Products SymmetryWatch::compare_resolved(SymmetryGain& gain, Resolved& orbits) const {
  Products products = compare(gain, orbits.a, orbits.b);
  const SampledOrbit* a = &orbits.a;
  const SampledOrbit* b = &orbits.b;
  // What is left out looks like a broken part; that may be smaller than it seemed, which asks for more again.
  while (true) {
    const double part = std::sqrt(std::min(products.first, products.second));
    const double wanted = std::max(small_share * part, negligible * std::min(a->size, b->size));
    if (std::max(a->left_out, b->left_out) <= wanted) return products;
    const bool is_finer_known = orbits.finer_a && a == &orbits.a;
    if (!is_finer_known) {
      SampledOrbit next_a = sampled_with(orbits.a.source, loop::resolved_in_time(orbits.a.source, wanted));
      SampledOrbit next_b = sampled_with(orbits.b.source, loop::resolved_in_time(orbits.b.source, wanted));
      const bool is_finest = next_a.loop.cutoff <= a->loop.cutoff && next_b.loop.cutoff <= b->loop.cutoff;
      if (is_finest) return products;
      orbits.finer_a = std::move(next_a);
      orbits.finer_b = std::move(next_b);
    }
    a = &*orbits.finer_a;
    b = &*orbits.finer_b;
    if (gain.reversing) {
      const loop::Loop image = loop::transformed(a->loop, gain.map, true, 0.0);
      const double shift = loop::shift_minimum_near(image, a->loop, _system.angles, -gain.phase).shift;
      gain.phase = -shift + std::ceil(shift);
    }
    products = compare(gain, *a, *b);
  }
}

// <c(A), c(B)> of one matrix for all its shifts, from correlations harmonic by harmonic: cheap, but known only to
// rounding of |A||B|, which decides where nothing is gain.
class SymmetryWatch::Correlation {
 public:
  Correlation(const systems::AffineMap& inverse, const SampledOrbit& a, const SampledOrbit& b,
              const std::vector<int>& angles)
      : _inverse(inverse),
        _a(a),
        _b(b),
        _angles(angles),
        _sums(std::min(a.coefficients.cols(), b.coefficients.cols())),
        _plain(_sums.size()) {
    const Eigen::MatrixXcd image_a = inverse.matrix * a.coefficients;
    const Eigen::MatrixXcd image_b = inverse.matrix * b.coefficients;
    for (Eigen::Index k = 1; k < _sums.size(); ++k) {
      _plain(k) = b.coefficients.col(k).dot(a.coefficients.col(k)).real();
      _unshifted += image_b.col(k).dot(image_a.col(k)).real() + b.coefficients.col(k).dot(a.coefficients.col(k)).real();
      _sums(k) = b.coefficients.col(k).dot(image_a.col(k)) + a.coefficients.col(k).dot(image_b.col(k));
    }
  }

  [[nodiscard]] double of(const SymmetryGain& gain) const {
    const double shift = shift_of(gain);
    const Eigen::VectorXd winding = Eigen::Map<const Eigen::VectorXd>(_a.loop.winding.data(), _a.loop.dimension);
    const Eigen::VectorXd turn = two_pi * shift * winding;
    const Eigen::VectorXd mean_a = _a.coefficients.col(0).real();
    const Eigen::VectorXd mean_b = _b.coefficients.col(0).real();
    Eigen::VectorXd broken_a = _inverse(mean_a + turn) - mean_a;
    Eigen::VectorXd broken_b = _inverse(mean_b + turn) - mean_b;
    reduce(_angles, broken_a, broken_b);
    if (is_repetition(gain)) {
      double mixed = broken_a.dot(broken_b);
      for (Eigen::Index k = 1; k < _plain.size(); ++k)
        if (k % gain.shift_denominator != 0) mixed += _plain(k);
      return mixed;
    }
    double mixed = _unshifted + broken_a.dot(broken_b);
    const std::complex<double> step = std::polar(1.0, two_pi * shift);
    std::complex<double> wave = 1.0;
    for (Eigen::Index k = 1; k < _sums.size(); ++k) {
      wave *= step;
      mixed -= wave.real() * _sums(k).real() - wave.imag() * _sums(k).imag();
    }
    return mixed;
  }

 private:
  const systems::AffineMap& _inverse;
  const SampledOrbit& _a;
  const SampledOrbit& _b;
  const std::vector<int>& _angles;
  double _unshifted = 0.0;
  Eigen::VectorXcd _sums;
  Eigen::VectorXd _plain;  // of the loops themselves, for repetitions
};

loop::Isotropy SymmetryWatch::group_with(const SymmetryGain& gain) const {
  loop::Isotropy generators = _own;
  generators.push_back({gain.name, false, gain.map, gain.shift_numerator, gain.shift_denominator});
  return loop::SymmetryGroup(_system, generators).elements();
}

// Elements of the group that `gain` and the own isotropy generate; a reversor doubles it, whatever its phase.
std::size_t SymmetryWatch::generated_with(const SymmetryGain& gain) const {
  return gain.reversing ? 2 * loop::SymmetryGroup(_system, _own).elements().size() : group_with(gain).size();
}

bool SymmetryWatch::generates(const SymmetryGain& gain, const SymmetryGain& power) const {
  return !gain.reversing && !power.reversing && contains(group_with(gain), power, _system.angles);
}

std::vector<SymmetryGain> SymmetryWatch::nearly_gained(const SampledOrbit& from, const SampledOrbit& to) const {
  const Eigen::Index moving = to.coefficients.cols() - 1;
  const double small = nearly * to.coefficients.rightCols(moving).norm();
  Resolved orbits{from, to};
  std::vector<std::pair<std::size_t, SymmetryGain>> found;
  for (const auto& [symmetry, candidates] : _equivariances) {
    if (!keeps_winding(symmetry.map.matrix, 1.0, to.loop)) continue;
    const systems::AffineMap inverse = symmetry.map.inverse();
    const Correlation correlation(inverse, to, to, _system.angles);
    for (const SymmetryGain& candidate : candidates) {
      if (!(correlation.of(candidate) < small * small)) continue;
      SymmetryGain seen = candidate;
      const Products products = compare_resolved(seen, orbits);
      if (products.mixed > 0.0 && products.second < std::min(products.first, small * small))
        found.emplace_back(generated_with(candidate), candidate);
    }
  }
  return ordered(std::move(found));
}

std::vector<SymmetryGain> SymmetryWatch::all_passed(const SampledOrbit& from, const SampledOrbit& to) const {
  std::vector<std::pair<std::size_t, SymmetryGain>> found;
  Resolved orbits{from, to};
  const auto consider = [&](SymmetryGain candidate) {
    const Products products = compare_resolved(candidate, orbits);
    if (std::sqrt(products.first) <= negligible * from.size) return;
    if (products.mixed < 0.0 || std::sqrt(products.second) <= negligible * to.size)
      found.emplace_back(generated_with(candidate), candidate);
  };
  const double rounding = correlation_rounding * (from.size * from.size + to.size * to.size) +
                          (from.left_out + to.left_out) * (from.size + to.size);
  // A part that has become negligible has the sign it had as well as the other.
  const double at_most = std::max(rounding, 2.0 * negligible * from.size * to.size);
  for (const auto& [symmetry, candidates] : _equivariances) {
    if (!keeps_winding(symmetry.map.matrix, 1.0, from.loop)) continue;
    const systems::AffineMap inverse = symmetry.map.inverse();
    const Correlation correlation(inverse, from, to, _system.angles);
    for (const SymmetryGain& candidate : candidates)
      if (correlation.of(candidate) <= at_most) consider(candidate);
  }
  for (const systems::Symmetry& r : _reversors) {
    if (!keeps_winding(r.map.matrix, -1.0, from.loop)) continue;
    const loop::Loop image = loop::transformed(from.loop, r.map, true, 0.0);
    std::vector<loop::ShiftMinimum> minima = loop::shift_minima(image, from.loop, _system.angles);
    if (minima.size() > phases) minima.resize(phases);
    for (const loop::ShiftMinimum& minimum : minima)
      consider({r.name, true, r.map, 0, 1, -minimum.shift + std::ceil(minimum.shift)});
  }
  return ordered(std::move(found));
}

double SymmetryWatch::signed_part(const SymmetryGain& gain, const loop::Loop& a, const loop::Loop& at) const {
  SymmetryGain seen = gain;
  const SampledOrbit of_a = sampled(a);
  const SampledOrbit of_at = sampled(at);
  Resolved orbits{of_a, of_at};
  const Products products = compare_resolved(seen, orbits);
  return products.mixed / products.first;
}

double SymmetryWatch::relative_size(const SymmetryGain& gain, const loop::Loop& a, const loop::Loop& at) const {
  SymmetryGain seen = gain;
  const SampledOrbit of_a = sampled(a);
  const SampledOrbit of_at = sampled(at);
  Resolved orbits{of_a, of_at};
  const Products products = compare_resolved(seen, orbits);
  return std::sqrt(products.second / products.first);
}

}  // namespace orbweaver::bifurcation
