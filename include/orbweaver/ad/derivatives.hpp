#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

/// Derivatives of templated functions by forward automatic differentiation. This header alone knows which library does
/// it.
///
/// A function to be differentiated is written once for any scalar type S, with `using std::sin;` (and so on) before a
/// call of sin, and with S, never auto, for what it stores: an expression kept by auto would refer to temporaries.
namespace orbweaver::ad {

/// A value with its gradient in D variables.
template <int D>
using First = Eigen::AutoDiffScalar<Eigen::Matrix<double, D, 1>>;

/// A value with its gradient and its Hessian in D variables.
template <int D>
using Second = Eigen::AutoDiffScalar<Eigen::Matrix<First<D>, D, 1>>;

/// D numbers.
template <int D>
using Vector = std::array<double, static_cast<std::size_t>(D)>;

/// D x D numbers; entry (i, l) stands at [i * D + l].
template <int D>
using Square = std::array<double, static_cast<std::size_t>(D) * static_cast<std::size_t>(D)>;

/// A scalar function at one state.
template <int D>
struct ValueGradient {
  double value = 0.0;
  Vector<D> gradient{};
};

/// A vector field at one state; jacobian entry (i, l) = df_i/dz_l.
template <int D>
struct ValueJacobian {
  Vector<D> value{};
  Square<D> jacobian{};
};

namespace detail {

template <int D>
std::array<First<D>, static_cast<std::size_t>(D)> first_order_variables(const double* z) {
  std::array<First<D>, static_cast<std::size_t>(D)> variables;
  for (int l = 0; l < D; ++l) variables[static_cast<std::size_t>(l)] = First<D>(z[l], D, l);
  return variables;
}

template <int D>
std::array<Second<D>, static_cast<std::size_t>(D)> second_order_variables(const double* z) {
  std::array<Second<D>, static_cast<std::size_t>(D)> variables;
  for (int l = 0; l < D; ++l) variables[static_cast<std::size_t>(l)] = Second<D>(First<D>(z[l], D, l), D, l);
  return variables;
}

}  // namespace detail

/// f(z) and its Jacobian at the state `z` of D numbers. `field(const S* z, S* f)` is callable for S = First<D> and
/// writes all D entries of f.
template <int D, class Field>
[[nodiscard]] ValueJacobian<D> field_jacobian(const Field& field, const double* z) {
  static_assert(D > 0, "a vector field needs at least one dimension");
  const auto variables = detail::first_order_variables<D>(z);
  std::array<First<D>, static_cast<std::size_t>(D)> f;
  field(variables.data(), f.data());
  ValueJacobian<D> result;
  for (std::size_t i = 0; i < D; ++i) {
    result.value[i] = f[i].value();
    for (std::size_t l = 0; l < D; ++l) result.jacobian[i * D + l] = f[i].derivatives()[static_cast<Eigen::Index>(l)];
  }
  return result;
}

/// Second derivatives of a vector field, contracted with the D numbers `weights`: entry (l, m) is
/// sum_i weights_i d2f_i/dz_l dz_m at `z`, exactly symmetric. `field(const S* z, S* f)` is callable for S = Second<D>.
template <int D, class Field>
[[nodiscard]] Square<D> second_derivatives(const Field& field, const double* z, const double* weights) {
  static_assert(D > 0, "a vector field needs at least one dimension");
  const auto variables = detail::second_order_variables<D>(z);
  std::array<Second<D>, static_cast<std::size_t>(D)> f;
  field(variables.data(), f.data());
  const auto entry = [&](int i, int l, int m) {
    return f[static_cast<std::size_t>(i)].derivatives()[l].derivatives()[m];
  };
  Square<D> result{};
  for (int l = 0; l < D; ++l) {
    for (int m = 0; m <= l; ++m) {
      double sum = 0.0;
      for (int i = 0; i < D; ++i) sum += weights[i] * 0.5 * (entry(i, l, m) + entry(i, m, l));
      result[static_cast<std::size_t>(l * D + m)] = sum;
      result[static_cast<std::size_t>(m * D + l)] = sum;
    }
  }
  return result;
}

/// A scalar function and its gradient at the state `z` of D numbers. `function(const S* z)` returns S for S = First<D>.
template <int D, class Function>
[[nodiscard]] ValueGradient<D> value_gradient(const Function& function, const double* z) {
  static_assert(D > 0, "a function needs at least one variable");
  const auto variables = detail::first_order_variables<D>(z);
  const First<D> value = function(variables.data());
  ValueGradient<D> result;
  result.value = value.value();
  for (std::size_t l = 0; l < D; ++l) result.gradient[l] = value.derivatives()[static_cast<Eigen::Index>(l)];
  return result;
}

}  // namespace orbweaver::ad
