#pragma once

namespace orbweaver::survey {

/// Thrown through the work of a task: the run is to stop.
struct Interrupted {};

}  // namespace orbweaver::survey
