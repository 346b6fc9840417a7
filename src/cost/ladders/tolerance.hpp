#pragma once

#include "ladder.hpp"

namespace orbweaver::cost {

extern const Ladder tolerance_ladder;

}  // namespace orbweaver::cost
