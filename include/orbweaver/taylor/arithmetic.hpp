#pragma once

#include <cmath>

#include "orbweaver/ad/lanes.hpp"
#include "orbweaver/numerics/extended.hpp"

namespace orbweaver::taylor {

/// What the recurrences of Taylor series do with a number, without temporaries.
template <class Real>
struct Arithmetic;

/// Of doubles, one or as many as a vector register holds.
template <class Real>
struct InRegisters {
  static void set(Real& x, Real value) { x = value; }
  static void add(Real& out, Real a, Real b) { out = a + b; }
  static void subtract(Real& out, Real a, Real b) { out = a - b; }
  static void multiply(Real& out, Real a, Real b) { out = a * b; }
  static void divide(Real& out, Real a, Real b) { out = a / b; }
  static void negate(Real& out, Real a) { out = -a; }
  static void multiply(Real& out, Real a, long k) { out = a * static_cast<double>(k); }
  static void divide(Real& out, Real a, long k) { out = a / static_cast<double>(k); }

  /// Sums of products a_0 b_0, a_1 b_-1, ... of two arrays, the second one run through backwards.
  class Sum {
   public:
    void clear() { _sum = 0.0; }
    void add_products(const Real* a, const Real* b, int count) {
      for (int j = 0; j < count; ++j) _sum += a[j] * b[-j];
    }
    void subtract_products(const Real* a, const Real* b, int count) {
      for (int j = 0; j < count; ++j) _sum -= a[j] * b[-j];
    }
    void add(Real a) { _sum += a; }
    void twice() { _sum *= 2.0; }
    [[nodiscard]] Real value() const { return _sum; }

   private:
    Real _sum = 0.0;
  };
};

template <>
struct Arithmetic<ad::Lanes> : InRegisters<ad::Lanes> {};

template <>
struct Arithmetic<double> : InRegisters<double> {
  static bool is_zero(double x) { return x == 0.0; }
  static bool is_finite(double x) { return std::isfinite(x); }
  static double to_double(double x) { return x; }
};

template <>
struct Arithmetic<numerics::Extended> {
  using Real = numerics::Extended;
  static mpfr_ptr raw(Real& x) { return x.backend().data(); }
  static mpfr_srcptr raw(const Real& x) { return x.backend().data(); }

  static void set(Real& x, const Real& value) { mpfr_set(raw(x), raw(value), MPFR_RNDN); }
  static void set(Real& x, double value) { mpfr_set_d(raw(x), value, MPFR_RNDN); }
  static void add(Real& out, const Real& a, const Real& b) { mpfr_add(raw(out), raw(a), raw(b), MPFR_RNDN); }
  static void subtract(Real& out, const Real& a, const Real& b) { mpfr_sub(raw(out), raw(a), raw(b), MPFR_RNDN); }
  static void multiply(Real& out, const Real& a, const Real& b) { mpfr_mul(raw(out), raw(a), raw(b), MPFR_RNDN); }
  static void divide(Real& out, const Real& a, const Real& b) { mpfr_div(raw(out), raw(a), raw(b), MPFR_RNDN); }
  static void negate(Real& out, const Real& a) { mpfr_neg(raw(out), raw(a), MPFR_RNDN); }
  static void multiply(Real& out, const Real& a, long k) { mpfr_mul_si(raw(out), raw(a), k, MPFR_RNDN); }
  static void divide(Real& out, const Real& a, long k) { mpfr_div_si(raw(out), raw(a), k, MPFR_RNDN); }
  static bool is_zero(const Real& x) { return mpfr_zero_p(raw(x)) != 0; }
  static bool is_finite(const Real& x) { return mpfr_number_p(raw(x)) != 0; }
  static double to_double(const Real& x) { return mpfr_get_d(raw(x), MPFR_RNDN); }

  class Sum {
   public:
    void clear() { mpfr_set_zero(raw(_sum), 1); }
    void add_products(const Real* a, const Real* b, int count) {
      for (int j = 0; j < count; ++j) {
        mpfr_mul(raw(_product), raw(a[j]), raw(b[-j]), MPFR_RNDN);
        mpfr_add(raw(_sum), raw(_sum), raw(_product), MPFR_RNDN);
      }
    }
    void subtract_products(const Real* a, const Real* b, int count) {
      for (int j = 0; j < count; ++j) {
        mpfr_mul(raw(_product), raw(a[j]), raw(b[-j]), MPFR_RNDN);
        mpfr_sub(raw(_sum), raw(_sum), raw(_product), MPFR_RNDN);
      }
    }
    void add(const Real& a) { mpfr_add(raw(_sum), raw(_sum), raw(a), MPFR_RNDN); }
    void twice() { mpfr_mul_2ui(raw(_sum), raw(_sum), 1, MPFR_RNDN); }
    [[nodiscard]] const Real& value() const { return _sum; }

   private:
    Real _sum;
    Real _product;
  };
};

}  // namespace orbweaver::taylor
