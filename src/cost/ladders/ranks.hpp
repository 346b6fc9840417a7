#pragma once

#include "ladder.hpp"

namespace orbweaver::cost {

extern const Ladder ranks_ladder;

}  // namespace orbweaver::cost
