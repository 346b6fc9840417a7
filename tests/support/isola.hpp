#pragma once

#include <cmath>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// Limit cycles on closed curves in lam: with s = x^2 + (y - k x^2)^2 - 1 in units of R they are s^2 + (lam/L)^2 = a,
/// and, where q is 1, those of (s - 0.8)^2 + (lam/L)^2 = 1 + a too; each once around in 2 pi/(w (1 + c s)). Across them
/// u and v turn half as fast: on a cycle they grow at the rate g + lam/L along a direction that comes back reversed, so
/// that its period doubles where that is 0. No symmetry is declared; the field has some.
class Isola {
 public:
  static constexpr int dimension = 4;
  static constexpr int quantities = 0;

  static systems::ModelInfo info() {
    systems::ModelInfo info = test::described("isola", "limit cycles on closed curves", {"x", "y", "u", "v"},
                                              {"lam", "a", "R", "L", "w", "k", "c", "q", "g"}, 0.0);
    for (systems::Parameter& parameter : info.parameters)
      if (parameter.name == "R" || parameter.name == "L" || parameter.name == "w") parameter.standard = 1.0;
    info.parameters.back().standard = -1.0;
    return info;
  }

  static systems::Structure structure(const systems::Bound&) { return test::dissipative_structure(dimension); }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound)
        : _lam(bound["lam"]),
          _a(bound["a"]),
          _r(bound["R"]),
          _l(bound["L"]),
          _w(bound["w"]),
          _k(bound["k"]),
          _c(bound["c"]),
          _q(bound["q"]),
          _g(bound["g"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::sqrt;
      const P lam = _lam / _l;
      const S x = z[0] / _r;
      const S y = z[1] / _r - x * x * _k;
      const S s = x * x + y * y - 1.0;
      const S turn = s * _c + 1.0;
      const S second = (s - 0.8) * (s - 0.8) + lam * lam - _a - 1.0;
      const S growth = (_a - s * s - lam * lam) * (second * _q + 1.0);
      const S dx = (x * growth - y * turn) * _w;
      const S dy = (y * growth + x * turn) * _w;
      f[0] = dx * _r;
      f[1] = (dy + x * dx * _k * 2.0) * _r;
      const S u = z[2] / _r;
      const S v = z[3] / _r;
      const S radius = sqrt(s + 1.0);
      const S along = lam - u * u - v * v + _g;
      const S mean = (along - 1.0) * 0.5;
      const S half = (along + 1.0) * 0.5;
      f[2] = (mean * u + half * (x * u + y * v) / radius - v * turn * 0.5) * _w * _r;
      f[3] = (mean * v + half * (y * u - x * v) / radius + u * turn * 0.5) * _w * _r;
    }

   private:
    P _lam, _a, _r, _l, _w, _k, _c, _q, _g;
  };
};

}  // namespace orbweaver::test
