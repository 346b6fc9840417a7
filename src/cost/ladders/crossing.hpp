#pragma once

#include "ladder.hpp"

namespace orbweaver::cost {

extern const Ladder crossing_ladder;

}  // namespace orbweaver::cost
