#include "lineage.hpp"

namespace orbweaver::survey {

double signed_arclength(const Lineage& lineage, double before_first, double position) {
  return lineage.side > 0 ? position : -2.0 * before_first - position;
}

}  // namespace orbweaver::survey
