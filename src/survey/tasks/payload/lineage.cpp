#include "lineage.hpp"

namespace orbweaver::survey {

double signed_arclength(const Lineage& lineage, double before_first, double position) {
  return lineage.side > 0 ? position : -(before_first + position);
}

}  // namespace orbweaver::survey
