#pragma once

// All that tasks take and give.

#include "branch_work.hpp"
#include "given_orbits.hpp"
#include "locate_work.hpp"
#include "locus_work.hpp"
#include "start_work.hpp"
#include "stored_work.hpp"
#include "sweep_work.hpp"
