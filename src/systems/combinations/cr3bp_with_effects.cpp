#include "cr3bp.hpp"
#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

template struct Registered<Cr3bp<Radiation, Oblateness>>;

}  // namespace orbweaver::systems
