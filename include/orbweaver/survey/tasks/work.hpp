#pragma once

// All that tasks take and give.

#include "orbweaver/survey/tasks/branch_work.hpp"
#include "orbweaver/survey/tasks/locate_work.hpp"
#include "orbweaver/survey/tasks/start_work.hpp"
#include "orbweaver/survey/tasks/sweep_work.hpp"
