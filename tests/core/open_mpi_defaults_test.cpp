#include "mpi/open_mpi_defaults.hpp"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace orbweaver::core::open_mpi_defaults_test {
namespace {

std::map<std::string, std::string> defaults_in(const std::map<std::string, std::string>& variables) {
  const auto defaults = open_mpi_defaults([&](const char* name) {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
  return {defaults.begin(), defaults.end()};
}

TEST(OpenMpiDefaults, AProcessAloneNeedsNothingOfAJob) {
  const auto alone = defaults_in({{"PATH", "/bin"}});
  EXPECT_EQ(alone.at("OMPI_MCA_ess_singleton_isolated"), "1");
  EXPECT_EQ(alone.at("OMPI_MCA_btl"), "self");
  // The folder of an isolated process has the same name in all of them: one would remove another's.
  EXPECT_EQ(alone.at("OMPI_MCA_orte_create_session_dirs"), "0");
  EXPECT_EQ(alone.at("OMPI_MCA_sharedfp"), "individual");
}

TEST(OpenMpiDefaults, RanksOnOneMachineLookForNoNetwork) {
  EXPECT_THAT(defaults_in({{"OMPI_COMM_WORLD_SIZE", "4"}, {"OMPI_COMM_WORLD_LOCAL_SIZE", "4"}}),
              testing::ElementsAre(testing::Pair("OMPI_MCA_pml", "ob1")));
}

TEST(OpenMpiDefaults, RanksOnSeveralMachinesAndOtherLaunchersAreLeftAlone) {
  EXPECT_THAT(defaults_in({{"OMPI_COMM_WORLD_SIZE", "4"}, {"OMPI_COMM_WORLD_LOCAL_SIZE", "2"}}), testing::IsEmpty());
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMIX_NAMESPACE", "PMI_RANK", "PMI_FD", "SLURM_JOB_ID"})
    EXPECT_THAT(defaults_in({{name, "1"}}), testing::IsEmpty()) << name;
}

}  // namespace
}  // namespace orbweaver::core::open_mpi_defaults_test
