#pragma once

namespace orbweaver::corrector {

/// Registers the TAO types "orbweaver_rprop" and "orbweaver_rprop_extrapolated" (once a process).
void register_rprop();

}  // namespace orbweaver::corrector
