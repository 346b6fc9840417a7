#include "orbweaver/spectrum/floquet_vector.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "floquet_chain.hpp"
#include "floquet_group.hpp"
#include "matrix_table.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/loop/grid/fourier.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/spectrum/floquet.hpp"
#include "transverse_flow.hpp"

namespace orbweaver::spectrum {

namespace {

using Complex = std::complex<double>;

/// Of the harmonics that a chain's segments can hold, those that are believed: the last ones carry what is beyond.
constexpr double believed = 0.8;
/// Angles of sectors are 0 or 2 pi/q and more, up to roundings.
constexpr double same_angle = 1e-9;

/// Singular values of the closing equations, of size 1, from which on a vector does not close, beside the largest: no
/// solution, and no smooth function. Not measured.
constexpr double left_open = 1e-7;
constexpr double left_open_of_largest = 1e-4;

/// Vectors y_0 .. y_(n-1) in the transverse bases, one a column, with y_(m+1) = F_m y_m and y_n = `multiplier` y_0: the
/// one that does so most nearly, and of the others up to `count` that do.
std::vector<Eigen::MatrixXcd> closing_vectors(const TransverseFlow& flow, Complex multiplier, int count) {
  const Eigen::Index d = flow.dimension();
  const Eigen::Index segments = flow.factors.cols();
  // E y_0 + F y_m = 0, and where y_m was eliminated y_m = from_first y_0 + from_next y_(m+1).
  Eigen::MatrixXd e = matrix_in<Eigen::Dynamic>(flow.factors, 0, d);
  Eigen::MatrixXd f = -Eigen::MatrixXd::Identity(d, d);
  std::vector<Eigen::MatrixXd> from_first;
  std::vector<Eigen::MatrixXd> from_next;
  for (Eigen::Index m = 1; m < segments; ++m) {
    Eigen::MatrixXd here(2 * d, d);
    here << f, matrix_in<Eigen::Dynamic>(flow.factors, m, d);
    Eigen::MatrixXd others = Eigen::MatrixXd::Zero(2 * d, 2 * d);
    others.topLeftCorner(d, d) = e;
    others.bottomRightCorner(d, d).setIdentity();
    others.bottomRightCorner(d, d) *= -1.0;
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(here);
    others.applyOnTheLeft(qr.householderQ().transpose());
    const auto triangle = qr.matrixQR().topRows(d).triangularView<Eigen::Upper>();
    from_first.emplace_back(-triangle.solve(others.topLeftCorner(d, d)));
    from_next.emplace_back(-triangle.solve(others.topRightCorner(d, d)));
    e = others.bottomLeftCorner(d, d);
    f = others.bottomRightCorner(d, d);
  }
  const Eigen::MatrixXcd closing = e.cast<Complex>() + multiplier * f.cast<Complex>();
  const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(closing, Eigen::ComputeFullV);
  std::vector<Eigen::MatrixXcd> all;
  for (Eigen::Index n = d; n-- > std::max<Eigen::Index>(0, d - count);) {
    const auto& values = svd.singularValues();
    if (!all.empty() && values(n) > std::max(left_open, left_open_of_largest * values(0))) break;
    Eigen::MatrixXcd y(d, segments);
    y.col(0) = svd.matrixV().col(n);
    Eigen::VectorXcd next = multiplier * y.col(0);
    for (Eigen::Index m = segments; m-- > 1;) {
      const auto at = static_cast<std::size_t>(m - 1);
      next = from_first[at].cast<Complex>() * y.col(0) + from_next[at].cast<Complex>() * next;
      y.col(m) = next;
    }
    all.push_back(std::move(y));
  }
  return all;
}

/// The solution v(t_m) of the whole linearised flow, times e^{-i angle m/n}: its parts in the transverse bases are
/// known, and its part along f is what makes it close. Without an angle only a change of the period closes it, which
/// takes out what is in proportion to time.
Eigen::MatrixXcd periodic_part(const systems::System& system, const Chain& chain, const Eigen::MatrixXcd& y,
                               double angle) {
  const Eigen::Index segments = chain.segments();
  const Eigen::Index d = chain.dimension();
  Eigen::MatrixXcd across(d, segments);
  Eigen::VectorXcd along = Eigen::VectorXcd::Zero(segments + 1);  // parts of f, from 0 at t_0
  for (Eigen::Index m = 0; m < segments; ++m) {
    across.col(m) = transverse_basis(system, chain, m).cast<Complex>() * y.col(m);
    const Eigen::VectorXcd image = matrix_in<Eigen::Dynamic>(chain.transitions, m, d).cast<Complex>() * across.col(m);
    const Eigen::VectorXd next = chain.fields.col(m + 1);
    along[m + 1] = along[m] + next.cast<Complex>().dot(image) / next.squaredNorm();
  }
  const Complex total = along[segments];
  const Complex turned = std::polar(1.0, angle) - 1.0;
  const bool closes = std::abs(turned) > same_angle;
  const double period = chain.steps.sum();
  double time = 0.0;
  Eigen::MatrixXcd out(d, segments);
  for (Eigen::Index m = 0; m < segments; ++m) {
    const Complex part = along[m] + (closes ? total / turned : -total * time / period);
    out.col(m) = std::polar(1.0, -angle * static_cast<double>(m) / static_cast<double>(segments)) *
                 (across.col(m) + part * chain.fields.col(m).cast<Complex>());
    time += chain.steps[m];
  }
  return out;
}

/// The highest harmonic of a periodic function that is above `share` of the largest.
int highest_harmonic(const Eigen::MatrixXcd& periodic, double share) {
  const auto nodes = static_cast<int>(periodic.cols());
  const auto size = 2 * static_cast<int>(periodic.rows());
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> nodal(size, nodes);
  nodal << periodic.real(), periodic.imag();
  const int cutoff = (nodes - 1) / 2;
  std::vector<double> modes(static_cast<std::size_t>((2 * cutoff + 1) * size));
  loop::FourierGrid::of_size(nodes).analyze(cutoff, size, nodal.data(), modes.data());
  std::vector<double> squares(static_cast<std::size_t>(cutoff) + 1, 0.0);
  for (std::size_t n = 0; n < modes.size(); ++n)
    squares[(n / static_cast<std::size_t>(size) + 1) / 2] += modes[n] * modes[n];
  const double least = share * share * *std::max_element(squares.begin(), squares.end());
  int highest = cutoff;
  while (highest > 0 && squares[static_cast<std::size_t>(highest)] <= least) --highest;
  return highest;
}

}  // namespace

int floquet_vector_cutoff(const systems::System& family, const loop::Loop& loop, const loop::Isotropy& isotropy,
                          const FloquetVectorOptions& options) {
  const core::LogStage stage(core::Stage::spectrum);
  const std::shared_ptr<const systems::System> here = loop::system_at(family, loop);
  const systems::System& system = *here;
  const FundamentalGroup group = fundamental_group(system, loop, isotropy);
  core::require(options.count >= 1, "at least one solution of the linearised flow can be asked for");
  core::require(options.order % group.order == 0, "the order of a sector's fundamental map does not fit the loop's");
  const double angle = options.angle * options.order / group.order;
  core::Team* team = core::worth_dividing(options.team, system.dimension());
  VariationalStep stepper(system);
  int least = FloquetOptions{}.least_segments;
  while (true) {
    const Chain chain = make_chain(system, stepper, loop, group, least, team);
    const TransverseFlow flow = transverse_flow(system, chain, group, team);
    const Eigen::Index segments = chain.segments();
    const auto around = static_cast<double>(segments * group.order);
    int highest = 0;
    for (const Eigen::MatrixXcd& y : closing_vectors(flow, std::polar(1.0, angle), options.count)) {
      Eigen::MatrixXcd periodic(chain.dimension(), segments * group.order);
      periodic.leftCols(segments) = periodic_part(system, chain, y, angle);
      for (Eigen::Index m = segments; m < periodic.cols(); ++m)
        periodic.col(m) = group.generator.cast<Complex>() * periodic.col(m - segments);
      highest = std::max(highest, highest_harmonic(periodic, options.share));
    }
    // v itself has e^{i angle p s / 2 pi} more.
    const int needed = highest + 1;
    if (2.0 * needed < believed * around) return needed;
    if (needed > options.most) return needed;
    least = static_cast<int>(2.0 * around);
  }
}

}  // namespace orbweaver::spectrum
