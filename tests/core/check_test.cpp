#include "orbweaver/core/petsc/check.hpp"

#include <source_location>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <petscmat.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/handle.hpp"

namespace orbweaver::core::check_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// A product of a 2 x 2 matrix with a vector of size 3, which PETSc refuses.
PetscErrorCode multiply_nonconforming() {
  Handle<Mat> mat;
  Handle<Vec> three;
  Handle<Vec> two;
  check(MatCreateSeqDense(PETSC_COMM_SELF, 2, 2, nullptr, mat.put()), "MatCreateSeqDense");
  check(MatAssemblyBegin(mat.get(), MAT_FINAL_ASSEMBLY), "MatAssemblyBegin");
  check(MatAssemblyEnd(mat.get(), MAT_FINAL_ASSEMBLY), "MatAssemblyEnd");
  check(VecCreateSeq(PETSC_COMM_SELF, 3, three.put()), "VecCreateSeq");
  check(VecCreateSeq(PETSC_COMM_SELF, 2, two.put()), "VecCreateSeq");
  return MatMult(mat.get(), three.get(), two.get());
}

TEST(Check, success_throws_nothing) {
  EXPECT_NO_THROW(check(0, "MatMult"));
  EXPECT_NO_THROW(check_mpi(MPI_SUCCESS, "MPI_Send"));
}

TEST(Check, message_holds_the_call_petscs_text_its_detail_and_the_place) {
  const auto line_of_call = std::source_location::current().line() + 2;
  try {
    check(multiply_nonconforming(), "MatMult");
    FAIL() << "nothing was thrown";
  } catch (const EnvironmentError& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith("MatMult failed: "), HasSubstr("Nonconforming object sizes"),
                                    HasSubstr("global dim 2 3"), HasSubstr("PETSc error 60"),
                                    HasSubstr("check_test.cpp:" + std::to_string(line_of_call))));
    EXPECT_EQ(error.status(), ExitStatus::environment_failed);
  }
}

TEST(Check, petsc_itself_prints_nothing) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  EXPECT_NE(multiply_nonconforming(), 0);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Check, an_unknown_code_still_makes_a_message) {
  try {
    check(static_cast<PetscErrorCode>(12345), "VecDot");
    FAIL() << "nothing was thrown";
  } catch (const EnvironmentError& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith("VecDot failed: "), HasSubstr("PETSc error 12345")));
  }
}

TEST(CheckMpi, message_holds_the_call_mpis_text_and_the_place) {
  const auto line_of_call = std::source_location::current().line() + 2;
  try {
    check_mpi(MPI_ERR_RANK, "MPI_Send");
    FAIL() << "nothing was thrown";
  } catch (const EnvironmentError& error) {
    EXPECT_THAT(error.what(), AllOf(StartsWith("MPI_Send failed: "), HasSubstr("MPI_ERR_RANK"),
                                    HasSubstr("check_test.cpp:" + std::to_string(line_of_call))));
  }
}

}  // namespace
}  // namespace orbweaver::core::check_test
