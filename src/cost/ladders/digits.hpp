#pragma once

#include "ladder.hpp"

namespace orbweaver::cost {

extern const Ladder digits_ladder;

}  // namespace orbweaver::cost
