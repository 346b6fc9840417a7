#include "double_pendulum.hpp"
#include "orbweaver/systems/model/model_system.hpp"

namespace orbweaver::systems {

template struct Registered<DoublePendulum<RodInertia>>;

}  // namespace orbweaver::systems
