#pragma once

#include "ladder.hpp"

namespace orbweaver::cost {

extern const Ladder solvers_ladder;

}  // namespace orbweaver::cost
