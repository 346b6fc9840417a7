#include "verify/equilibrium_check.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Dense>

#include "orbweaver/core/error.hpp"
#include "orbweaver/numerics/decompositions.hpp"

namespace orbweaver::survey {

namespace {

using Complex = std::complex<double>;

/// Of the field, in parts of its Jacobian times 1 + |z|: a few hundred roundings.
constexpr double rests = 1e-11;
/// Of eigenvalues, in parts of the Jacobian's norm: Hopf points and folds are located to 1e-12 of a step, and double
/// eigenvalues are means.
constexpr double same_eigenvalue = 1e-9;
/// Of arclengths and energies, in parts of 1 + their size.
constexpr double same_number = 1e-9;

class Row {
 public:
  Row(const VerifiedAtlas& atlas, std::size_t row)
      : _atlas(atlas), _table(atlas.archive().equilibria()), _row(row), _system(atlas.system()) {
    _moving = atlas.archive().moving_parameter();
    if (!_moving.empty()) _system = _system->with_parameters({{_moving, real("parameter")}});
    _state = scaled_state(row);
    for (std::size_t n = 0; n < _state.size(); ++n) {
      const std::size_t at = 2 * (_row * _state.size() + n);
      const Complex value(_table.reals("eigenvalues")[at], _table.reals("eigenvalues")[at + 1]);
      _eigenvalues.push_back(value * _system->scales().time);
    }
  }

  void check(Claims& claims) const {
    const auto d = static_cast<Eigen::Index>(_state.size());
    Eigen::VectorXd f(d);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(d, d);
    _system->field_jacobian(1, _state.data(), f.data(), jacobian.data());
    if (_system->structure().driven) f(d - 1) = 0.0;  // the phase goes on
    const double norm = jacobian.norm();
    const double size = 1.0 + Eigen::Map<const Eigen::VectorXd>(_state.data(), d).norm();
    claims.below("state", f.norm(), rests * norm * size, "the field at the point");
    if (_system->structure().conservative()) {
      const double energy = _system->conserved(0, _state) * _system->scales().energy();
      claims.agree("energy", real("energy"), energy, same_number * (1.0 + std::abs(energy)));
    }
    check_place(claims);
    const std::string& stability = _table.texts("stability")[_row];
    const bool is_computed = std::none_of(_eigenvalues.begin(), _eigenvalues.end(), [](const Complex& value) {
      return std::isnan(value.real()) || std::isnan(value.imag());
    });
    claims.expect(is_computed != stability.empty(), "eigenvalues", "are not there, or the stability is not");
    if (!is_computed) return;
    check_eigenvalues(claims, jacobian, norm);
    check_periods(claims, norm);
    claims.expect(is_stability(stability), "stability",
                  fmt::format("is '{}', which the eigenvalues do not say", stability));
    check_kind(claims);
  }

 private:
  [[nodiscard]] double real(const char* column) const { return _table.reals(column)[_row]; }

  [[nodiscard]] std::vector<double> scaled_state(std::size_t row) const {
    const auto d = static_cast<std::size_t>(_system->dimension());
    std::vector<double> state(d);
    for (std::size_t i = 0; i < d; ++i) state[i] = _table.reals("state")[row * d + i] / _system->scales().coordinate(i);
    return state;
  }

  /// Each eigenvalue is one of the Jacobian's, and their power sums are its traces, which leaves no other.
  void check_eigenvalues(Claims& claims, const Eigen::MatrixXd& jacobian, double norm) const {
    const Eigen::Index d = jacobian.rows();
    const Eigen::MatrixXcd identity = Eigen::MatrixXcd::Identity(d, d);
    Eigen::MatrixXd power = Eigen::MatrixXd::Identity(d, d);
    double scale = 1.0;
    for (Eigen::Index k = 0; k < d; ++k) {
      const Complex value = _eigenvalues[static_cast<std::size_t>(k)];
      const double least =
          Eigen::JacobiSVD<Eigen::MatrixXcd>(jacobian.cast<Complex>() - value * identity).singularValues().minCoeff();
      claims.below("eigenvalues", least, same_eigenvalue * norm, "the least singular value of the Jacobian less one");
      power *= jacobian;
      scale *= norm;
      Complex sum = 0.0;
      for (const Complex& each : _eigenvalues) sum += std::pow(each, static_cast<double>(k + 1));
      claims.below("eigenvalues", std::abs(sum - power.trace()), same_eigenvalue * scale,
                   fmt::format("the sum of the powers {}, less the trace of that of the Jacobian,", k + 1));
    }
    const auto in_order = [](const Complex& a, const Complex& b) {
      return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
    };
    claims.expect(std::is_sorted(_eigenvalues.begin(), _eigenvalues.end(), in_order), "eigenvalues",
                  "are not in order");
  }

  void check_periods(Claims& claims, double norm) const {
    const std::size_t width = _state.size() / 2;
    std::int64_t counted = 0;
    double before = std::numeric_limits<double>::infinity();
    for (std::size_t n = _row * width; n < (_row + 1) * width; ++n) {
      const double period = _table.reals("periods")[n] / _system->scales().time;
      const std::int64_t multiplicity = _table.integers("multiplicity")[n];
      claims.expect(std::isnan(period) == (multiplicity < 1), "multiplicity",
                    fmt::format("is {} of the period {}", multiplicity, period));
      if (std::isnan(period)) continue;
      const double frequency = 2.0 * std::numbers::pi / period;
      const auto count = std::count_if(_eigenvalues.begin(), _eigenvalues.end(), [&](const Complex& value) {
        return value.real() == 0.0 && std::abs(value.imag() - frequency) <= same_eigenvalue * norm;
      });
      claims.expect(count == multiplicity, "periods",
                    fmt::format("{} of the eigenvalues oscillate with {:.12g}, not {}", count,
                                _table.reals("periods")[n], multiplicity));
      claims.expect(period < before, "periods", "are not in order");
      before = period;
      counted += multiplicity;
    }
    const auto all = std::count_if(_eigenvalues.begin(), _eigenvalues.end(),
                                   [](const Complex& value) { return value.real() == 0.0 && value.imag() > 0.0; });
    claims.expect(counted == all, "periods", fmt::format("are of {} oscillations, where {} are", counted, all));
  }

  [[nodiscard]] bool is_stability(const std::string& stability) const {
    std::vector<Complex> values = _eigenvalues;
    if (_system->structure().driven)  // of the phase
      if (const auto zero = std::find(values.begin(), values.end(), Complex()); zero != values.end())
        values.erase(zero);
    const auto all = [&](const auto& holds) { return std::all_of(values.begin(), values.end(), holds); };
    if (stability == "unstable") return !all([](const Complex& value) { return value.real() <= 0.0; });
    if (stability == "stable") return all([](const Complex& value) { return value.real() < 0.0; });
    if (stability == "elliptic")
      return all([](const Complex& value) { return value.real() == 0.0 && value.imag() != 0.0; });
    if (stability == "neutral") return all([](const Complex& value) { return value.real() <= 0.0; });
    return stability == "undecided";
  }

  void check_kind(Claims& claims) const {
    const std::string& kind = _table.texts("kind")[_row];
    const auto any = [&](const auto& holds) { return std::any_of(_eigenvalues.begin(), _eigenvalues.end(), holds); };
    if (kind == "hopf")
      claims.expect(any([](const Complex& value) { return value.real() == 0.0 && value.imag() > 0.0; }), "kind",
                    "is hopf, where no eigenvalues pass the imaginary axis");
    else if (kind == "fold-parameter" || kind == "branch-point")
      claims.expect(any([](const Complex& value) { return value == Complex(); }), "kind",
                    fmt::format("is {}, where the Jacobian is regular", kind));
    else if (kind != "return")
      claims.expect(kind == "equilibrium", "kind", fmt::format("is '{}', which is not known here", kind));
  }

  /// Along the curve, from the row before.
  void check_place(Claims& claims) const {
    const std::vector<std::int64_t>& equilibria = _table.integers("equilibrium");
    const std::int64_t step = _table.integers("step")[_row];
    if (!_moving.empty() && (step == 0 || _table.texts("kind")[_row] == "return")) {
      const double value = _atlas.system()->parameters().at(_moving);
      claims.agree("parameter", real("parameter"), value, same_number * (1.0 + std::abs(value)));
    }
    if (step == 0) claims.agree("arclength", real("arclength"), 0.0, same_number);
    const bool is_first = _row == 0 || equilibria[_row - 1] != equilibria[_row];
    const bool is_last = _row + 1 == _table.rows() || equilibria[_row + 1] != equilibria[_row];
    claims.expect((!is_first || step <= 0) && (!is_last || step >= 0), "step",
                  fmt::format("is {} at an end, and none is 0", step));
    if (is_first) {
      claims.expect(_row == 0 || equilibria[_row - 1] < equilibria[_row], "equilibrium", "is not in order");
      return;
    }
    claims.expect(step == _table.integers("step")[_row - 1] + 1, "step",
                  fmt::format("is {} after {}", step, _table.integers("step")[_row - 1]));
    const std::vector<double> before = scaled_state(_row - 1);
    double square = 0.0;
    for (std::size_t i = 0; i < before.size(); ++i) square += (before[i] - _state[i]) * (before[i] - _state[i]);
    if (!_moving.empty()) {
      const double way = (real("parameter") - _table.reals("parameter")[_row - 1]) / _system->parameter_scale(_moving);
      square += way * way;
    }
    claims.agree("arclength", real("arclength") - _table.reals("arclength")[_row - 1], std::sqrt(square),
                 same_number * (1.0 + std::abs(real("arclength"))));
  }

  const VerifiedAtlas& _atlas;
  const archive::Table& _table;
  std::size_t _row;
  std::shared_ptr<const systems::System> _system;
  std::string _moving;
  std::vector<double> _state;         // in scales
  std::vector<Complex> _eigenvalues;  // in scales
};

}  // namespace

void check_equilibrium(const VerifiedAtlas& atlas, std::size_t row, Findings& findings) {
  Claims claims(findings, "equilibria", static_cast<std::int64_t>(row));
  try {
    Row(atlas, row).check(claims);
  } catch (const core::NumericalError& error) {
    claims.object("", error.what());
  }
}

}  // namespace orbweaver::survey
