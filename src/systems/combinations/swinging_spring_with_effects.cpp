#include "orbweaver/systems/model/model_system.hpp"
#include "swinging_spring.hpp"

namespace orbweaver::systems {

template struct Registered<SwingingSpring<Damping<2>>>;
template struct Registered<SwingingSpring<Drive<2>>>;
template struct Registered<SwingingSpring<Damping<2>, Drive<2>>>;

}  // namespace orbweaver::systems
