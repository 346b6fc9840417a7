#pragma once

#include "ladder.hpp"

namespace orbweaver::cost {

extern const Ladder resolution_ladder;

}  // namespace orbweaver::cost
