#include "orbweaver/core/petsc/callback.hpp"

#include <stdexcept>

#include <gtest/gtest.h>
#include <petscmat.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/check.hpp"
#include "orbweaver/core/petsc/handle.hpp"

namespace orbweaver::core::callback_test {
namespace {

// A matrix-free operator whose product throws while `broken`, and copies otherwise.
struct Operator {
  CallbackGuard guard;
  bool broken = true;
  int calls = 0;
};

PetscErrorCode multiply(Mat mat, Vec x, Vec y) {
  Operator* self = nullptr;
  MatShellGetContext(mat, &self);
  return self->guard.run([&] {
    ++self->calls;
    if (self->broken) throw NumericalError("NaN at node 7");
    check(VecCopy(x, y), "VecCopy");
  });
}

class CallbackThroughPetsc : public ::testing::Test {
 protected:
  CallbackThroughPetsc() {
    check(MatCreateShell(PETSC_COMM_SELF, 2, 2, 2, 2, &_operator, _mat.put()), "MatCreateShell");
    check(MatShellSetOperation(_mat.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply)), "MatShellSetOperation");
    check(VecCreateSeq(PETSC_COMM_SELF, 2, _x.put()), "VecCreateSeq");
    check(VecCreateSeq(PETSC_COMM_SELF, 2, _y.put()), "VecCreateSeq");
    check(VecSet(_x.get(), 3.0), "VecSet");
  }
  PetscErrorCode product() { return MatMult(_mat.get(), _x.get(), _y.get()); }

  Operator _operator;
  Handle<Mat> _mat;
  Handle<Vec> _x;
  Handle<Vec> _y;
};

TEST_F(CallbackThroughPetsc, exception_comes_out_after_the_call_with_its_type_and_text) {
  EXPECT_EQ(product(), PETSC_ERR_USER);
  EXPECT_EQ(_operator.calls, 1);
  try {
    _operator.guard.rethrow();
    FAIL() << "nothing was thrown";
  } catch (const NumericalError& error) {
    EXPECT_STREQ(error.what(), "NaN at node 7");
  }
}

TEST_F(CallbackThroughPetsc, an_exception_is_rethrown_once) {
  EXPECT_NE(product(), 0);
  EXPECT_THROW(_operator.guard.rethrow(), NumericalError);
  EXPECT_NO_THROW(_operator.guard.rethrow());
}

TEST_F(CallbackThroughPetsc, the_operator_works_again_after_a_failure) {
  EXPECT_NE(product(), 0);
  EXPECT_THROW(_operator.guard.rethrow(), NumericalError);
  _operator.broken = false;
  ASSERT_EQ(product(), 0);
  EXPECT_NO_THROW(_operator.guard.rethrow());
  PetscReal norm = 0.0;
  check(VecNorm(_y.get(), NORM_1, &norm), "VecNorm");
  EXPECT_EQ(norm, 6.0);
}

TEST(CallbackGuard, carries_exceptions_of_any_type) {
  CallbackGuard guard;
  EXPECT_EQ(guard.run([] { throw 42; }), PETSC_ERR_USER);
  EXPECT_THROW(guard.rethrow(), int);
}

TEST(CallbackGuard, success_returns_zero_and_stores_nothing) {
  CallbackGuard guard;
  EXPECT_EQ(guard.run([] {}), 0);
  EXPECT_NO_THROW(guard.rethrow());
}

}  // namespace
}  // namespace orbweaver::core::callback_test
