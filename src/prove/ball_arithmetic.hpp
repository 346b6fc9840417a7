#pragma once

#include "ball.hpp"
#include "orbweaver/taylor/arithmetic.hpp"

namespace orbweaver::taylor {

template <>
struct Arithmetic<prove::Ball> {
  using Real = prove::Ball;
  static long bits() { return prove::WorkingBits::in_force(); }

  static void set(Real& x, const Real& value) { arb_set(x.get(), value.get()); }
  static void set(Real& x, double value) { arb_set_d(x.get(), value); }
  static void add(Real& out, const Real& a, const Real& b) { arb_add(out.get(), a.get(), b.get(), bits()); }
  static void subtract(Real& out, const Real& a, const Real& b) { arb_sub(out.get(), a.get(), b.get(), bits()); }
  static void multiply(Real& out, const Real& a, const Real& b) { arb_mul(out.get(), a.get(), b.get(), bits()); }
  static void divide(Real& out, const Real& a, const Real& b) { arb_div(out.get(), a.get(), b.get(), bits()); }
  static void negate(Real& out, const Real& a) { arb_neg(out.get(), a.get()); }
  static void multiply(Real& out, const Real& a, long k) { arb_mul_si(out.get(), a.get(), k, bits()); }
  static void divide(Real& out, const Real& a, long k) { arb_div_si(out.get(), a.get(), k, bits()); }

  class Sum {
   public:
    void clear() { arb_zero(_sum.get()); }
    void add_products(const Real* a, const Real* b, int count) {
      if (count > 0) arb_dot(_sum.get(), _sum.get(), 0, a->get(), 1, b->get(), -1, count, bits());
    }
    void subtract_products(const Real* a, const Real* b, int count) {
      if (count > 0) arb_dot(_sum.get(), _sum.get(), 1, a->get(), 1, b->get(), -1, count, bits());
    }
    void add(const Real& a) { arb_add(_sum.get(), _sum.get(), a.get(), bits()); }
    void twice() { arb_mul_2exp_si(_sum.get(), _sum.get(), 1); }
    [[nodiscard]] const Real& value() const { return _sum; }

   private:
    static_assert(sizeof(Real) == sizeof(arb_struct), "Arb takes an array of balls for one of its own");
    Real _sum;
  };
};

}  // namespace orbweaver::taylor
