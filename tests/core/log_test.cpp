#include "orbweaver/core/log/log.hpp"

#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <mpi.h>

namespace orbweaver::core::log_test {
namespace {

std::string stderr_of(const std::function<void()>& body) {
  ::testing::internal::CaptureStderr();
  body();
  return ::testing::internal::GetCapturedStderr();
}

std::string all_levels() {
  return stderr_of([] {
    log_debug("d");
    log_info("i");
    log_warning("w");
    log_error("e");
  });
}

// The state before start_logging can be met only once, so this test must stay first.
TEST(Log, before_its_start_warnings_and_errors_are_printed) { EXPECT_EQ(all_levels(), "orbweaver: w\norbweaver: e\n"); }

TEST(Log, one_rank_needs_no_rank_prefix) {
  start_logging(LogLevel::info, 0, 1);
  EXPECT_EQ(all_levels(), "orbweaver: i\norbweaver: w\norbweaver: e\n");
}

TEST(Log, several_ranks_name_themselves_and_only_rank_0_informs) {
  start_logging(LogLevel::info, 0, 3);
  EXPECT_EQ(all_levels(), "orbweaver[0]: i\norbweaver[0]: w\norbweaver[0]: e\n");
  start_logging(LogLevel::info, 2, 3);
  EXPECT_EQ(all_levels(), "orbweaver[2]: w\norbweaver[2]: e\n");
}

TEST(Log, debug_lets_every_rank_speak) {
  start_logging(LogLevel::debug, 1, 2);
  EXPECT_EQ(all_levels(), "orbweaver[1]: d\norbweaver[1]: i\norbweaver[1]: w\norbweaver[1]: e\n");
}

TEST(Log, level_holds_back_what_is_below_it) {
  start_logging(LogLevel::error, 1, 2);
  EXPECT_EQ(all_levels(), "orbweaver[1]: e\n");
  start_logging(LogLevel::quiet, 0, 1);
  EXPECT_EQ(all_levels(), "");
}

TEST(Log, braces_in_a_message_are_text) {
  start_logging(LogLevel::info, 0, 1);
  EXPECT_EQ(stderr_of([] { log_info("{} {0} {x}"); }), "orbweaver: {} {0} {x}\n");
}

TEST(Log, nothing_goes_to_stdout) {
  start_logging(LogLevel::debug, 0, 1);
  ::testing::internal::CaptureStdout();
  (void)all_levels();
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

TEST(Log, each_real_rank_prefixes_its_own_lines) {
  int rank = -1;
  int ranks = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  start_logging(LogLevel::info, rank, ranks);
  const std::string prefix = ranks > 1 ? "orbweaver[" + std::to_string(rank) + "]: " : "orbweaver: ";
  EXPECT_EQ(stderr_of([] { log_warning("here"); }), prefix + "here\n");
}

}  // namespace
}  // namespace orbweaver::core::log_test
