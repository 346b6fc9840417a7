#pragma once

#include "restricted_problem.hpp"

namespace orbweaver::systems {

/// The circular restricted three-body problem in space.
template <class... Effects>
class Cr3bp : public RestrictedProblem<3, Effects...> {};

}  // namespace orbweaver::systems
