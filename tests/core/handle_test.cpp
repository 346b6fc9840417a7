#include "orbweaver/core/petsc/handle.hpp"

#include <source_location>
#include <string>
#include <type_traits>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <petscksp.h>
#include <slepceps.h>

#include "orbweaver/core/petsc/check.hpp"

namespace orbweaver::core::handle_test {
namespace {

void create(Vec* vec) { check(VecCreateSeq(PETSC_COMM_SELF, 3, vec), "VecCreateSeq"); }
void create(Mat* mat) { check(MatCreateSeqDense(PETSC_COMM_SELF, 2, 2, nullptr, mat), "MatCreateSeqDense"); }
void create(KSP* ksp) { check(KSPCreate(PETSC_COMM_SELF, ksp), "KSPCreate"); }
void create(EPS* eps) { check(EPSCreate(PETSC_COMM_SELF, eps), "EPSCreate"); }

// Holds a reference of its own, so that the object outlives the handles under test and its count can be read.
template <class T>
class Witness {
 public:
  explicit Witness(T object) : _object(object) { check(PetscObjectReference(base()), "PetscObjectReference"); }
  Witness(const Witness&) = delete;
  Witness& operator=(const Witness&) = delete;
  ~Witness() { PetscObjectDestroy(reinterpret_cast<PetscObject*>(&_object)); }

  [[nodiscard]] int references_besides_own() const {
    PetscInt count = 0;
    check(PetscObjectGetReference(base(), &count), "PetscObjectGetReference");
    return static_cast<int>(count) - 1;
  }

 private:
  [[nodiscard]] PetscObject base() const { return reinterpret_cast<PetscObject>(_object); }
  T _object;
};

template <class T>
class HandleOf : public ::testing::Test {
 protected:
  static Handle<T> make() {
    Handle<T> handle;
    create(handle.put());
    return handle;
  }
};

using Objects = ::testing::Types<Vec, Mat, KSP, EPS>;
TYPED_TEST_SUITE(HandleOf, Objects);

TYPED_TEST(HandleOf, destroys_its_object_exactly_once) {
  auto handle = this->make();
  const Witness<TypeParam> witness(handle.get());
  EXPECT_EQ(witness.references_besides_own(), 1);
  {
    const Handle<TypeParam> owner = std::move(handle);
    EXPECT_EQ(witness.references_besides_own(), 1);
  }
  EXPECT_EQ(witness.references_besides_own(), 0);
  handle.reset();
  EXPECT_EQ(witness.references_besides_own(), 0);
}

TYPED_TEST(HandleOf, move_construction_empties_the_source) {
  auto source = this->make();
  const auto object = source.get();
  const Handle<TypeParam> target = std::move(source);
  EXPECT_TRUE(source.empty());  // NOLINT(bugprone-use-after-move): the moved-from state is what is tested
  EXPECT_EQ(target.get(), object);
}

TYPED_TEST(HandleOf, move_assignment_destroys_what_the_target_held) {
  auto target = this->make();
  auto source = this->make();
  const Witness<TypeParam> old_object(target.get());
  const Witness<TypeParam> new_object(source.get());
  target = std::move(source);
  EXPECT_EQ(old_object.references_besides_own(), 0);
  EXPECT_EQ(new_object.references_besides_own(), 1);
  EXPECT_TRUE(source.empty());  // NOLINT(bugprone-use-after-move): the moved-from state is what is tested
}

TYPED_TEST(HandleOf, self_move_keeps_the_object) {
  auto handle = this->make();
  const auto object = handle.get();
  const Witness<TypeParam> witness(object);
  Handle<TypeParam>& same = handle;
  handle = std::move(same);
  EXPECT_EQ(handle.get(), object);
  EXPECT_EQ(witness.references_besides_own(), 1);
}

TYPED_TEST(HandleOf, put_destroys_what_the_handle_held) {
  auto handle = this->make();
  const Witness<TypeParam> witness(handle.get());
  create(handle.put());
  EXPECT_EQ(witness.references_besides_own(), 0);
  EXPECT_FALSE(handle.empty());
}

TYPED_TEST(HandleOf, share_adds_a_reference_and_gives_it_back) {
  const auto handle = this->make();
  const Witness<TypeParam> witness(handle.get());
  {
    const auto second = Handle<TypeParam>::share(handle.get());
    EXPECT_EQ(second.get(), handle.get());
    EXPECT_EQ(witness.references_besides_own(), 2);
  }
  EXPECT_EQ(witness.references_besides_own(), 1);
}

TYPED_TEST(HandleOf, cannot_be_copied) {
  EXPECT_FALSE(std::is_copy_constructible_v<Handle<TypeParam>>);
  EXPECT_FALSE(std::is_copy_assignable_v<Handle<TypeParam>>);
  EXPECT_TRUE(std::is_nothrow_move_constructible_v<Handle<TypeParam>>);
  EXPECT_TRUE(std::is_nothrow_move_assignable_v<Handle<TypeParam>>);
}

TEST(Handle, empty_one_throws_and_names_the_caller) {
  const Handle<Vec> handle;
  EXPECT_TRUE(handle.empty());
  const auto line_of_call = std::source_location::current().line() + 2;
  try {
    (void)handle.get();
    FAIL() << "nothing was thrown";
  } catch (const MisuseError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("empty handle"));
    EXPECT_THAT(error.what(), ::testing::EndsWith("handle_test.cpp:" + std::to_string(line_of_call) + ")"));
  }
}

TEST(Handle, moved_from_one_throws) {
  Handle<Vec> source;
  create(source.put());
  const Handle<Vec> target = std::move(source);
  EXPECT_THROW((void)source.get(), MisuseError);  // NOLINT(bugprone-use-after-move)
}

TEST(Handle, null_cannot_be_shared) { EXPECT_THROW((void)Handle<Vec>::share(nullptr), MisuseError); }

TEST(Handle, resetting_an_empty_one_does_nothing) {
  Handle<Vec> handle;
  handle.reset();
  EXPECT_TRUE(handle.empty());
}

}  // namespace
}  // namespace orbweaver::core::handle_test
