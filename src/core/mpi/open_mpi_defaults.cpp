#include "open_mpi_defaults.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include <mpi.h>

namespace orbweaver::core {

namespace {

/// Set by mpirun, by other launchers that Open MPI understands, and within jobs of Slurm.
constexpr std::array launched{"OMPI_COMM_WORLD_SIZE", "PMIX_NAMESPACE", "PMIX_RANK",
                              "PMI_RANK",             "PMI_FD",         "SLURM_JOB_ID"};

bool all_on_one_machine(const Environment& environment) {
  const char* const all = environment("OMPI_COMM_WORLD_SIZE");
  const char* const here = environment("OMPI_COMM_WORLD_LOCAL_SIZE");
  return all != nullptr && here != nullptr && std::string_view(all) == here;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> open_mpi_defaults(const Environment& environment) {
  if (all_on_one_machine(environment)) return {{"OMPI_MCA_pml", "ob1"}};
  const auto is_set = [&](const char* name) { return environment(name) != nullptr; };
  if (std::any_of(launched.begin(), launched.end(), is_set)) return {};
  return {
      {"OMPI_MCA_ess_singleton_isolated", "1"},    // no daemon
      {"OMPI_MCA_orte_create_session_dirs", "0"},  // no folder, which all such processes would share
      {"OMPI_MCA_sharedfp", "individual"},         // files' shared pointers, not used here, would look for that folder
      {"OMPI_MCA_pml", "ob1"},
      {"OMPI_MCA_btl", "self"},
      {"HWLOC_COMPONENTS", "no_os,stop"},
  };
}

void set_open_mpi_defaults() {
#if defined(OMPI_MAJOR_VERSION) && OMPI_MAJOR_VERSION == 4
  for (const auto& [name, value] : open_mpi_defaults(std::getenv)) setenv(name.c_str(), value.c_str(), 0);
#endif
}

}  // namespace orbweaver::core
