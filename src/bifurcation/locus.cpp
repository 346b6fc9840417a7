#include "orbweaver/bifurcation/locus.hpp"

#include "orbweaver/spectrum/floquet.hpp"

namespace orbweaver::bifurcation {

continuation::LocusTest locus_test(const systems::System& surface, const loop::Isotropy& isotropy, const Event& event,
                                   core::Team* team) {
  continuation::LocusTest test;
  if (event.kind == Event::Kind::test_function) {
    test.value = [&surface, isotropy, function = event.function, team](const loop::Loop& loop) {
      spectrum::FloquetOptions options;
      options.team = team;
      const spectrum::Stability stability = spectrum::floquet(surface, loop, isotropy, options);
      if (function.kind == TestFunction::Kind::sector)
        return index_deviation(surface.structure(), stability, function.sector).value;
      return evaluate(function, surface.structure(), stability).value;
    };
    return test;
  }
  test.projection = [&surface, kind = event.kind](const loop::Loop& loop, const loop::Tangent& along) {
    const continuation::CurvePoint point{0.0, loop, along};
    const double second = along.scalars[surface.family_scalars().free.size()];
    if (kind == Event::Kind::fold_period) return std::array<double, 2>{period_slope(point), second};
    // The second parameter's own part of the energy's change leaves the pair parallel where it is.
    const double first = kind == Event::Kind::fold_energy ? energy_slope(surface, point) : parameter_slope(point);
    return std::array<double, 2>{first, second};
  };
  return test;
}

}  // namespace orbweaver::bifurcation
