#include "known_plans.hpp"

#include <cstddef>
#include <vector>

#include <fftw3.h>

namespace orbweaver::loop {

void recall_plans(int nodes) {
  static std::vector<bool> told(known_plans().size(), false);
  for (std::size_t n = 0; n < told.size(); ++n) {
    const KnownPlans& known = known_plans()[n];
    if (told[n] || nodes < known.from || nodes > known.to) continue;
    told[n] = true;
    static_cast<void>(fftw_import_wisdom_from_string(known.wisdom));
  }
}

}  // namespace orbweaver::loop
