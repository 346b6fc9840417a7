#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "orbweaver/systems/recorded_model.hpp"
#include "support/described.hpp"

namespace orbweaver::test {

/// Three oscillators that no symmetry is known of: with l and m linear forms of q,
///   H = |p|^2/2 + b (q1 p2 - q2 p1) + c (q2 p3 - q3 p2) + (q1^2 + 1.41^2 q2^2 + 1.73^2 q3^2)/2
///       + a sum l_n^3/3 + sum m_n^4/4.
class OscillatorsInFields {
 public:
  static constexpr int dimension = 6;
  static constexpr int quantities = 1;

  static systems::ModelInfo info() {
    return test::described("oscillators_in_fields", "three oscillators in magnetic fields",
                           {"q1", "q2", "q3", "p1", "p2", "p3"}, {"a", "b", "c"}, 0.0);
  }

  static systems::Structure structure(const systems::Bound&) {
    systems::Structure structure;
    structure.dimension = dimension;
    structure.conserved = {"energy"};
    structure.symplectic = true;
    return structure;
  }

  template <class P>
  class With {
   public:
    explicit With(const systems::BoundTo<P>& bound) : _a(bound["a"]), _b(bound["b"]), _c(bound["c"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      f[0] = z[3] - z[1] * _b;
      f[1] = z[4] + z[0] * _b - z[2] * _c;
      f[2] = z[5] + z[1] * _c;
      f[3] = -(z[0] + z[4] * _b);
      f[4] = -(z[1] * squares[1] - z[3] * _b + z[5] * _c);
      f[5] = -(z[2] * squares[2] - z[4] * _c);
      for (const auto& form : cubes) {
        const S l = of(form, z);
        for (int i = 0; i < 3; ++i) f[3 + i] = f[3 + i] - l * l * _a * form[i];
      }
      for (const auto& form : fourths) {
        const S m = of(form, z);
        for (int i = 0; i < 3; ++i) f[3 + i] = f[3 + i] - m * m * m * form[i];
      }
    }

    template <int, class S>
    S conserved(const S* z) const {
      S energy = (z[0] * z[4] - z[1] * z[3]) * _b + (z[1] * z[5] - z[2] * z[4]) * _c;
      for (int i = 0; i < 3; ++i) energy = energy + (z[3 + i] * z[3 + i] + z[i] * z[i] * squares[i]) * 0.5;
      for (const auto& form : cubes) energy = energy + of(form, z) * of(form, z) * of(form, z) * _a / 3.0;
      for (const auto& form : fourths) {
        const S square = of(form, z) * of(form, z);
        energy = energy + square * square * 0.25;
      }
      return energy;
    }

    template <class S>
    S action_density(const S* z) const {
      return z[3] * (z[3] - z[1] * _b) + z[4] * (z[4] + z[0] * _b - z[2] * _c) + z[5] * (z[5] + z[1] * _c);
    }

   private:
    static constexpr double squares[3] = {1.0, 1.41 * 1.41, 1.73 * 1.73};
    static constexpr double cubes[3][3] = {{1.0, 0.5, -0.3}, {0.2, -1.0, 0.6}, {-0.4, 0.3, 1.0}};
    static constexpr double fourths[4][3] = {{1.0, 0.2, 0.1}, {-0.3, 1.0, 0.4}, {0.25, -0.35, 1.0}, {0.6, 0.5, -0.7}};

    template <class S>
    static S of(const double (&form)[3], const S* z) {
      return z[0] * form[0] + z[1] * form[1] + z[2] * form[2];
    }

    P _a, _b, _c;
  };
};

inline std::shared_ptr<const systems::System> oscillators_in_fields(const std::map<std::string, double>& parameters) {
  return systems::recorded<OscillatorsInFields>(systems::bound_to(OscillatorsInFields::info(), parameters, {}));
}

}  // namespace orbweaver::test
