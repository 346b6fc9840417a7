#include "orbweaver/core/error.hpp"

#include <source_location>
#include <string>
#include <type_traits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace orbweaver::core::error_test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

template <class Thrown>
ExitStatus status_of_thrown() {
  try {
    throw Thrown("what was wrong");
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "what was wrong");
    return error.status();
  }
}

TEST(Error, each_kind_carries_the_exit_status_that_the_readme_promises) {
  EXPECT_EQ(static_cast<int>(status_of_thrown<NumericalError>()), 1);
  EXPECT_EQ(static_cast<int>(status_of_thrown<InputError>()), 2);
  EXPECT_EQ(static_cast<int>(status_of_thrown<EnvironmentError>()), 3);
  EXPECT_EQ(static_cast<int>(ExitStatus::done), 0);
  EXPECT_EQ(static_cast<int>(ExitStatus::stopped_early), 4);
}

TEST(Error, misuse_is_no_outcome_that_a_program_handles) {
  EXPECT_FALSE((std::is_base_of_v<Error, MisuseError>));
  EXPECT_TRUE((std::is_base_of_v<std::logic_error, MisuseError>));
}

std::string misuse_message(const std::source_location where) {
  try {
    require(false, "the cutoff must be positive", where);
  } catch (const MisuseError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Misuse, message_names_the_function_file_and_line_of_the_call) {
  const auto here = std::source_location::current();
  EXPECT_THAT(misuse_message(here), AllOf(StartsWith("the cutoff must be positive"), HasSubstr("TestBody"),
                                          EndsWith("error_test.cpp:" + std::to_string(here.line()) + ")")));
}

TEST(Misuse, location_defaults_to_the_call_of_require) {
  const auto line_of_call = std::source_location::current().line() + 2;
  try {
    require(false, "never");
    FAIL() << "nothing was thrown";
  } catch (const MisuseError& error) {
    EXPECT_THAT(error.what(), EndsWith("error_test.cpp:" + std::to_string(line_of_call) + ")"));
  }
}

TEST(Misuse, a_condition_that_holds_throws_nothing) { EXPECT_NO_THROW(require(true, "never")); }

}  // namespace
}  // namespace orbweaver::core::error_test
