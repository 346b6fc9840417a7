#include "orbweaver/spectrum/log_volume.hpp"

#include <cstddef>

#include "orbweaver/loss/linearization.hpp"

namespace orbweaver::spectrum {

double log_volume(const systems::System& system, const loop::Loop& loop) {
  const loss::Linearization there(system, loop, loss::Linearization::Order::jacobian);
  double sum = 0.0;
  for (int i = 0; i < there.dimension(); ++i) {
    const double* entries = there.field_jacobian(i, i);
    for (int j = 0; j < there.nodes(); ++j) sum += there.density()[static_cast<std::size_t>(j)] * entries[j];
  }
  return loop.period * sum / there.nodes();
}

}  // namespace orbweaver::spectrum
