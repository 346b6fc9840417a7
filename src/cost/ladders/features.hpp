#pragma once

#include "ladder.hpp"

namespace orbweaver::cost {

extern const Ladder features_ladder;

}  // namespace orbweaver::cost
