#include "unused_options.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "orbweaver/core/log/log.hpp"

namespace orbweaver::drivers {

void warn_of_unused_options(const core::Session& session, const core::Communicator& comm) {
  const std::vector<std::string> unused = session.unused_options(comm.get());
  if (unused.empty() || !comm.is_root()) return;
  core::log_warning(
      fmt::format("options for PETSc that nothing has used: {}; misspelt, or of a solver that was not needed",
                  fmt::join(unused, " ")));
}

}  // namespace orbweaver::drivers
