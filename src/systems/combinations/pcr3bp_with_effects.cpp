#include "orbweaver/systems/model/model_system.hpp"
#include "pcr3bp.hpp"

namespace orbweaver::systems {

template struct Registered<Pcr3bp<Radiation>>;
template struct Registered<Pcr3bp<Oblateness>>;
template struct Registered<Pcr3bp<Radiation, Oblateness>>;

}  // namespace orbweaver::systems
