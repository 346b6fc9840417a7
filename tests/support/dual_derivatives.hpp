#pragma once

#include <array>
#include <cstddef>

#include "support/dual.hpp"
#include "orbweaver/ad/lanes.hpp"

/// Derivatives of templated functions by forward automatic differentiation, at one state (S = double) or at as many at
/// once as the CPU has lanes (S = Lanes).
///
/// A function to be differentiated is written once for any scalar type, with `using std::sin;` (and so on) before a
/// call of sin; constants are doubles. It may not branch on its arguments.
namespace orbweaver::ad {

/// A value with its gradient in D variables.
template <int D, class S = double>
using First = Dual<S, D>;

/// A value with its gradient and its Hessian in D variables.
template <int D, class S = double>
using Second = Dual<Dual<S, D>, D>;

/// D numbers.
template <int D, class S = double>
using Vector = std::array<S, static_cast<std::size_t>(D)>;

/// D x D numbers; entry (i, l) stands at [i * D + l].
template <int D, class S = double>
using Square = std::array<S, static_cast<std::size_t>(D) * static_cast<std::size_t>(D)>;

/// A scalar function at one state.
template <int D, class S = double>
struct ValueGradient {
  S value;
  Vector<D, S> gradient;
};

/// A vector field at one state; jacobian entry (i, l) = df_i/dz_l.
template <int D, class S = double>
struct ValueJacobian {
  Vector<D, S> value;
  Square<D, S> jacobian;
};

namespace detail {

template <int D, class S>
Vector<D, First<D, S>> first_order_variables(const S* z) {
  Vector<D, First<D, S>> variables;
  for (int l = 0; l < D; ++l) variables[static_cast<std::size_t>(l)] = First<D, S>::variable(z[l], l);
  return variables;
}

template <int D, class S>
Vector<D, Second<D, S>> second_order_variables(const S* z) {
  Vector<D, Second<D, S>> variables;
  for (int l = 0; l < D; ++l)
    variables[static_cast<std::size_t>(l)] = Second<D, S>::variable(First<D, S>::variable(z[l], l), l);
  return variables;
}

}  // namespace detail

/// f(z) and its Jacobian at the state `z` of D numbers. `field(const T* z, T* f)` is callable for T = First<D, S> and
/// writes all D entries of f.
template <int D, class Field, class S>
[[nodiscard]] ValueJacobian<D, S> field_jacobian(const Field& field, const S* z) {
  static_assert(D > 0, "a vector field needs at least one dimension");
  const auto variables = detail::first_order_variables<D>(z);
  Vector<D, First<D, S>> f;
  field(variables.data(), f.data());
  ValueJacobian<D, S> result;
  for (std::size_t i = 0; i < D; ++i) {
    result.value[i] = f[i].value;
    for (std::size_t l = 0; l < D; ++l) result.jacobian[i * D + l] = f[i].derivatives[l];
  }
  return result;
}

/// Second derivatives of a vector field, contracted with the D numbers `weights`: entry (l, m) is
/// sum_i weights_i d2f_i/dz_l dz_m at `z`, exactly symmetric. `field(const T* z, T* f)` is callable for
/// T = Second<D, S>.
template <int D, class Field, class S>
[[nodiscard]] Square<D, S> second_derivatives(const Field& field, const S* z, const S* weights) {
  static_assert(D > 0, "a vector field needs at least one dimension");
  const auto variables = detail::second_order_variables<D>(z);
  Vector<D, Second<D, S>> f;
  field(variables.data(), f.data());
  Square<D, S> result;
  for (std::size_t l = 0; l < D; ++l) {
    for (std::size_t m = 0; m <= l; ++m) {
      S sum(0.0);
      for (std::size_t i = 0; i < D; ++i)
        sum += weights[i] * 0.5 * (f[i].derivatives[l].derivatives[m] + f[i].derivatives[m].derivatives[l]);
      result[l * D + m] = sum;
      result[m * D + l] = sum;
    }
  }
  return result;
}

/// A scalar function and its gradient at the state `z` of D numbers. `function(const T* z)` returns T for
/// T = First<D, S>.
template <int D, class Function, class S>
[[nodiscard]] ValueGradient<D, S> value_gradient(const Function& function, const S* z) {
  static_assert(D > 0, "a function needs at least one variable");
  const auto variables = detail::first_order_variables<D>(z);
  const First<D, S> value = function(variables.data());
  return {value.value, value.derivatives};
}

}  // namespace orbweaver::ad
