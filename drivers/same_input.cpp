#include "same_input.hpp"

#include <fmt/format.h>

#include "failure.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/collective.hpp"

namespace orbweaver::drivers {

void require_same_input(const core::Communicator& comm, const std::string& scene) {
  const std::string scene_of_root = core::agreed(comm.get(), scene);
  agree(comm, [&] {
    if (scene != scene_of_root)
      throw core::InputError(fmt::format(
          "rank {} reads another scene than rank 0: give all ranks the same file and options", comm.rank()));
  });
}

}  // namespace orbweaver::drivers
