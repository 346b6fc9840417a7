#include "same_input.hpp"

#include <fmt/format.h>

#include "failure.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/systems/plugins.hpp"

namespace orbweaver::drivers {

void require_same_input(const core::Communicator& comm, const std::string& scene) {
  std::string builds;
  for (const systems::Plugin* plugin : systems::loaded_plugins()) builds += plugin->build + "\n";
  const std::string scene_of_root = core::agreed(comm.get(), scene);
  const std::string builds_of_root = core::agreed(comm.get(), builds);
  agree(comm, [&] {
    if (scene != scene_of_root)
      throw core::InputError(fmt::format(
          "rank {} reads another scene than rank 0: give all ranks the same file and options", comm.rank()));
    if (builds != builds_of_root)
      throw core::InputError(fmt::format(
          "rank {} loads another build of a plugin than rank 0: give all ranks the same file", comm.rank()));
  });
}

}  // namespace orbweaver::drivers
