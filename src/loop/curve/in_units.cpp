#include "orbweaver/loop/curve/in_units.hpp"

namespace orbweaver::loop {

Loop in_units(Loop loop, const systems::Scales& scales) {
  if (scales.are_one()) return loop;
  loop.period *= scales.time;
  const auto d = static_cast<std::size_t>(loop.dimension);
  for (std::size_t n = 0; n < loop.modes.size(); ++n) loop.modes[n] *= scales.coordinate(n % d);
  for (std::size_t n = 0; n < loop.parameters.size(); ++n) loop.parameters[n] *= scales.parameter(n);
  return loop;
}

Loop in_scales(Loop loop, const systems::Scales& scales) {
  if (scales.are_one()) return loop;
  loop.period /= scales.time;
  const auto d = static_cast<std::size_t>(loop.dimension);
  for (std::size_t n = 0; n < loop.modes.size(); ++n) loop.modes[n] /= scales.coordinate(n % d);
  for (std::size_t n = 0; n < loop.parameters.size(); ++n) loop.parameters[n] /= scales.parameter(n);
  return loop;
}

}  // namespace orbweaver::loop
