#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace orbweaver::core {

/// The value of an environment variable, null if it is not set.
using Environment = std::function<const char*(const char*)>;

/// Settings of Open MPI 4 that shorten its start for this program, as variables of the environment and their values. A
/// process that no launcher started needs no daemon, no folder of its job, no network and no map of the machine; ranks
/// on one machine need no search for networks, since they talk by its memory. Ranks on several machines get none.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> open_mpi_defaults(const Environment& environment);

/// Sets them where the environment says nothing. Before MPI_Init.
void set_open_mpi_defaults();

}  // namespace orbweaver::core
