#pragma once

#include "restricted_problem.hpp"

namespace orbweaver::systems {

/// The planar circular restricted three-body problem.
template <class... Effects>
class Pcr3bp : public RestrictedProblem<2, Effects...> {};

}  // namespace orbweaver::systems
