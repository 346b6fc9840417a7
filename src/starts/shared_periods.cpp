#include "orbweaver/starts/shared_periods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "second_derivatives.hpp"

namespace orbweaver::starts {

namespace {

/// Detunings, in parts of the period, that orbits of amplitude r (in scales) do not tell from none: the terms that
/// couple two oscillations move frequencies by r (k = 2) or its square (k = 1, 3), times coefficients of order 1, for
/// which this is a margin. At a larger detuning, or amplitude, what is born is a crossing on a family that starts at
/// the equilibrium. No detuning above the second is near.
constexpr double margin = 5.0;
constexpr double largest_detuning = 0.05;
/// Families start no nearer to the equilibrium to be apart: the terms that decide, r^2, are there 400 times the loss's
/// tolerance (1e-10).
constexpr double least_apart = 2e-4;
/// Where periods are nearly in ratio 1:3 families that are born at r may turn at some 10 r (with m2 = 1.7778 m1
/// the double pendulum's at 7 r) and come back. What is not told at the least amplitude starts beyond such turns.
constexpr double beyond_turns = 40.0;
/// Oscillations of nearly one period whose vectors nearly agree are not taken together: their combinations would be
/// too few radians apart for a search. Least singular value of the vectors side by side; 1: orthogonal.
constexpr double least_angle = 0.3;
/// Of energies of vectors of unit length, relative to the largest: differences are good to 1e-6.
constexpr double no_energy = 1e-4;

/// How much of its period `slow` differs from `harmonic` times the other's, less than rounding tells: 0.
double detuning(const Oscillation& slow, const Oscillation& fast, int harmonic) {
  const double gap = std::abs(slow.period - harmonic * fast.period);
  return gap <= slow.period_error + harmonic * fast.period_error ? 0.0 : gap / slow.period;
}

/// The length in the kernel below which orbits tell a detuning.
double told_below(double detuning, int harmonic) {
  if (detuning > largest_detuning) return std::numeric_limits<double>::infinity();
  return harmonic == 2 ? detuning / margin : std::sqrt(detuning / margin);
}

/// Which oscillations share a period, and how far out what that leaves is to start.
class Neighbours {
 public:
  Neighbours(const std::vector<Oscillation>& all, double amplitude)
      : _all(all),
        _amplitude(amplitude),
        _apart_below(all.size(), std::numeric_limits<double>::infinity()),
        _together_from(all.size(), 0.0),
        _detuning(all.size(), 0.0) {}

  bool share(std::size_t slow, std::size_t fast, int harmonic) {
    const double away = detuning(_all[slow], _all[fast], harmonic);
    const double told = told_below(away, harmonic);
    if (told >= _amplitude) return false;
    // At 1:2 what is born does not turn and come back. At 1:1 it is born where an index is (2 pi r^2)^2 from 2, which
    // rounding hides at small amplitudes.
    const bool may_turn = harmonic == 3;
    if (may_turn && told >= least_apart) {
      for (const std::size_t n : {slow, fast}) _apart_below[n] = std::min(_apart_below[n], told);
      return false;
    }
    if (may_turn && away > 0.0) _together_from[slow] = beyond_turns * least_apart;
    _detuning[slow] = std::max(_detuning[slow], away);
    return true;
  }

  /// Of vectors that nearly agree, where energies have both signs: the equilibrium is about to lose its stability (a
  /// Krein collision), and orbits of length r move both frequencies by the root of detuning^2 + r^2.
  void about_to_collide(std::size_t slow, std::size_t fast) {
    const double away = detuning(_all[slow], _all[fast], 1);
    if (away > largest_detuning) return;
    for (const std::size_t n : {slow, fast})
      _apart_below[n] = std::min(_apart_below[n], std::max(away / margin, least_apart));
  }

  void set(SharedPeriod& shared) const {
    for (const SharedPeriod::Member& member : shared.members) {
      if (member.harmonic == 1) shared.apart_below = std::min(shared.apart_below, _apart_below[member.oscillation]);
      shared.together_from = std::max(shared.together_from, _together_from[member.oscillation]);
      shared.detuning = std::max(shared.detuning, _detuning[member.oscillation]);
    }
  }

 private:
  const std::vector<Oscillation>& _all;
  double _amplitude;
  std::vector<double> _apart_below;    // as SharedPeriod, one an oscillation
  std::vector<double> _together_from;  // the same
  std::vector<double> _detuning;       // the same
};

Eigen::MatrixXcd side_by_side(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b) {
  Eigen::MatrixXcd both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

/// Nothing if some vectors nearly depend on the others.
Eigen::MatrixXcd joined(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b) {
  const Eigen::MatrixXcd both = side_by_side(a, b);
  const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(both, Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (svd.singularValues()(both.cols() - 1) < least_angle) return {};
  return svd.matrixU();
}

bool have_one_sign(const systems::System& system, std::span<const double> point, const SharedPeriod& shared) {
  if (system.structure().conserved.empty()) return false;
  const Eigen::VectorXd z = Eigen::Map<const Eigen::VectorXd>(point.data(), static_cast<Eigen::Index>(point.size()));
  const Eigen::MatrixXd second = second_derivatives(system, 0, z, Eigen::VectorXd::Constant(z.size(), difference_step));
  const Eigen::MatrixXcd form =
      shared.kernel.adjoint() * (0.5 * (second + second.transpose())).cast<std::complex<double>>() * shared.kernel;
  std::vector<double> energies;  // oscillations of different frequencies do not share any
  for (int harmonic = 1; harmonic <= strongest_harmonic; ++harmonic) {
    std::vector<Eigen::Index> columns;
    for (std::size_t c = 0; c < shared.harmonics.size(); ++c)
      if (shared.harmonics[c] == harmonic) columns.push_back(static_cast<Eigen::Index>(c));
    if (columns.empty()) continue;
    const Eigen::MatrixXcd block = form(columns, columns);
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd>(block).eigenvalues();
    energies.insert(energies.end(), values.begin(), values.end());
  }
  double largest = 0.0;
  for (const double e : energies) largest = std::max(largest, std::abs(e));
  const auto rises = [&](double e) { return e > no_energy * largest; };
  const auto falls = [&](double e) { return e < -no_energy * largest; };
  return std::all_of(energies.begin(), energies.end(), rises) || std::all_of(energies.begin(), energies.end(), falls);
}

}  // namespace

std::vector<SharedPeriod> shared_periods(const systems::System& system, std::span<const double> point,
                                         const LinearModes& modes, double amplitude) {
  core::require(static_cast<int>(point.size()) == system.dimension(), "a fixed point of another dimension");
  std::vector<SharedPeriod> out;
  const std::vector<Oscillation>& all = modes.oscillations;
  Neighbours neighbours(all, amplitude);
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (!out.empty()) {
      SharedPeriod& last = out.back();
      Eigen::MatrixXcd both = joined(last.kernel, all[n].kernel);
      if (both.size() == 0) {
        SharedPeriod side;
        side.kernel = side_by_side(last.kernel, all[n].kernel);
        side.harmonics.assign(static_cast<std::size_t>(side.kernel.cols()), 1);
        if (!have_one_sign(system, point, side)) neighbours.about_to_collide(n - 1, n);
      } else if (neighbours.share(n - 1, n, 1)) {
        last.kernel = std::move(both);
        last.residual = std::max(last.residual, all[n].residual);
        last.members.push_back({n, 1});
        continue;
      }
    }
    out.push_back({all[n].period, all[n].residual, {{n, 1}}, all[n].kernel, {}, false});
  }
  for (SharedPeriod& shared : out) {
    shared.harmonics.assign(static_cast<std::size_t>(shared.kernel.cols()), 1);
    const std::size_t slow = shared.members.front().oscillation;
    for (int harmonic = 2; harmonic <= strongest_harmonic; ++harmonic)
      for (std::size_t n = 0; n < all.size(); ++n) {
        if (!neighbours.share(slow, n, harmonic)) continue;
        const bool first = shared.members.back().harmonic != harmonic;
        Eigen::MatrixXcd others(shared.kernel.rows(), 0);
        if (!first)
          for (std::size_t c = 0; c < shared.harmonics.size(); ++c)
            if (shared.harmonics[c] == harmonic)
              others = side_by_side(others, shared.kernel.col(static_cast<Eigen::Index>(c)));
        const Eigen::MatrixXcd block = first ? all[n].kernel : joined(others, all[n].kernel);
        if (block.size() == 0) continue;
        shared.kernel = side_by_side(shared.kernel.leftCols(shared.kernel.cols() - others.cols()), block);
        shared.harmonics.resize(static_cast<std::size_t>(shared.kernel.cols()), harmonic);
        shared.residual = std::max(shared.residual, all[n].residual);
        shared.members.push_back({n, harmonic});
      }
    shared.is_definite = have_one_sign(system, point, shared);
  }
  for (SharedPeriod& shared : out) neighbours.set(shared);
  return out;
}

}  // namespace orbweaver::starts
