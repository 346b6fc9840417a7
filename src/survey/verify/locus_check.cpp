#include "verify/locus_check.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Dense>

#include <fmt/format.h>

#include "orbweaver/archive/schema/crossing_kind.hpp"
#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/scene/scene.hpp"

namespace orbweaver::survey {

namespace {

using archive::CrossingKind;

/// Of the integration; and what a closure may be at most, in parts of 1 + the state times the largest growth.
constexpr double integration = 1e-13;
constexpr double closes = 1e-9;
/// The orbit converged anew, from the state, in parts of 1 + the state: locations are good to 1e-10 of the length, and
/// beside a fold the closure sees a change along the family only squared.
constexpr double same_converged = 1e-6;
/// A singular value that is zero, in parts of the largest: what locations leave of a test function, times its slope.
constexpr double zero = 1e-6;

class Point {
 public:
  Point(const VerifiedAtlas& atlas, std::size_t row) : _table(atlas.archive().loci()), _row(row) {
    std::map<std::string, double> values = atlas.system()->parameters();
    const std::string moving = atlas.archive().moving_parameter();
    if (!moving.empty()) values[moving] = real("parameter");
    values[_table.texts("second_name")[row]] = real("second_parameter");
    scene::SystemChoice choice = atlas.scene().system;
    _system = scene::bound_system(choice)->with_parameters(values);
    const auto d = static_cast<std::size_t>(_system->dimension());
    const auto state = _table.reals("state").begin() + static_cast<std::ptrdiff_t>(row * d);
    _state = Eigen::Map<const Eigen::VectorXd>(&*state, static_cast<Eigen::Index>(d));
  }

  void check(Claims& claims) {
    const double period = real("period");
    const Eigen::VectorXd gap = closure(_state, period);
    const Eigen::MatrixXd flow = transition(_state, period);
    const double size = 1.0 + _state.norm();
    claims.below("state", gap.norm(), closes * size * std::max(1.0, flow.norm()),
                 "the closure of the orbit from the state, integrated");
    // Newton's step on the closure that is shortest: what it cannot see, along the flow and the family, stays.
    const Eigen::MatrixXd linear = flow - Eigen::MatrixXd::Identity(flow.rows(), flow.cols());
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(zero);
    const Eigen::VectorXd step = solver.compute(linear).solve(-gap);
    claims.below("state", step.norm(), same_converged * size,
                 "the distance of the state from the orbit converged anew");
    if (_system->structure().conservative())
      claims.agree("energy", real("energy"), _system->conserved(0, std::span(_state.data(), _state.size())),
                   1e-9 * (1.0 + std::abs(real("energy"))));
    claims.below("kind", defect(flow), zero, "the smallest singular value, in parts of the largest, that should be 0");
  }

 private:
  [[nodiscard]] double real(const char* column) const { return _table.reals(column)[_row]; }

  [[nodiscard]] Eigen::VectorXd closure(const Eigen::VectorXd& state, double period) const {
    const std::vector<double> end =
        certificate::integrate(*_system, {state.data(), state.data() + state.size()}, period, integration);
    Eigen::VectorXd gap = Eigen::Map<const Eigen::VectorXd>(end.data(), state.size()) - state;
    for (const int angle : _system->structure().angles)
      gap(angle) -= 2.0 * std::numbers::pi * std::round(gap(angle) / (2.0 * std::numbers::pi));
    return gap;
  }

  [[nodiscard]] Eigen::MatrixXd transition(const Eigen::VectorXd& state, double period) const {
    const auto all =
        certificate::transitions(*_system, {{state.data(), state.data() + state.size()}}, period, integration);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Eigen::Map<const RowMajor>(all.front().data(), state.size(), state.size());
  }

  /// How far the linearised flow is from having what the kind claims.
  [[nodiscard]] double defect(const Eigen::MatrixXd& flow) const {
    const auto kind = archive::crossing_kind_of(_table.texts("kind")[_row]);
    const Eigen::Index d = flow.rows();
    Eigen::VectorXd field(d);
    _system->field(1, _state.data(), field.data());
    std::vector<Eigen::VectorXd> out{field};  // trivial: along the flow, and across the energy
    if (_system->structure().conservative() && kind != CrossingKind::fold_period) {
      Eigen::VectorXd gradient(d);
      _system->conserved_gradient(0, std::span(_state.data(), _state.size()), std::span(gradient.data(), d));
      out.push_back(gradient);
    }
    Eigen::MatrixXd trivial(d, static_cast<Eigen::Index>(out.size()));
    for (std::size_t n = 0; n < out.size(); ++n) trivial.col(static_cast<Eigen::Index>(n)) = out[n];
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(trivial);
    const Eigen::MatrixXd basis = (qr.householderQ() * Eigen::MatrixXd::Identity(d, d)).rightCols(d - trivial.cols());
    // A change of the period would show along the flow: where the period turns it does not.
    const Eigen::MatrixXd rows = kind == CrossingKind::fold_period ? Eigen::MatrixXd::Identity(d, d) : basis;
    const Eigen::MatrixXcd map = (rows.transpose() * flow * basis).cast<std::complex<double>>();
    const Eigen::MatrixXcd one = (rows.transpose() * basis).cast<std::complex<double>>();
    const auto singular = [&](std::complex<double> multiplier) {
      const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXcd>(map - multiplier * one).singularValues();
      return values.minCoeff() / std::max(1.0, values.maxCoeff());
    };
    if (kind == CrossingKind::period_doubling) return singular(-1.0);
    if (kind != CrossingKind::torus) return singular(1.0);
    // By sum and product, which are smooth where the two coincide: there each is known to half the digits.
    double least = std::numeric_limits<double>::infinity();
    const Eigen::VectorXcd mu = Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(map).eigenvalues();
    for (Eigen::Index n = 0; n < mu.size(); ++n)
      for (Eigen::Index m = 0; m < n; ++m)
        least = std::min(least, std::max(std::abs(mu(n) * mu(m) - 1.0), std::abs(mu(n) + mu(m)) - 2.0));
    return least;
  }

  const archive::Table& _table;
  std::size_t _row;
  std::shared_ptr<const systems::System> _system;
  Eigen::VectorXd _state;
};

}  // namespace

void check_locus_point(const VerifiedAtlas& atlas, std::size_t row, Findings& findings) {
  Claims claims(findings, "loci", static_cast<std::int64_t>(row));
  try {
    Point(atlas, row).check(claims);
  } catch (const core::InputError& error) {
    claims.object("second_parameter", error.what());
  } catch (const core::NumericalError& error) {
    claims.object("", error.what());
  }
}

}  // namespace orbweaver::survey
