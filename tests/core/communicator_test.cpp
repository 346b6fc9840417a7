#include "orbweaver/core/mpi/communicator.hpp"

#include <type_traits>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/check.hpp"

namespace orbweaver::core::communicator_test {
namespace {

int world_rank() {
  int rank = -1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int world_size() {
  int size = -1;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

int compare(MPI_Comm a, MPI_Comm b) {
  int result = MPI_UNEQUAL;
  check_mpi(MPI_Comm_compare(a, b, &result), "MPI_Comm_compare");
  return result;
}

int sum_of_ones(const Communicator& comm) {
  const int one = 1;
  int sum = 0;
  check_mpi(MPI_Allreduce(&one, &sum, 1, MPI_INT, MPI_SUM, comm.get()), "MPI_Allreduce");
  return sum;
}

// Counts how often a communicator is freed: MPI calls the deleter of an attribute when its communicator goes.
class FreeCounter {
 public:
  FreeCounter() { check_mpi(MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, &count, &_key, &_frees), "keyval"); }
  FreeCounter(const FreeCounter&) = delete;
  FreeCounter& operator=(const FreeCounter&) = delete;
  ~FreeCounter() { MPI_Comm_free_keyval(&_key); }
  void watch(const Communicator& comm) { check_mpi(MPI_Comm_set_attr(comm.get(), _key, this), "MPI_Comm_set_attr"); }
  [[nodiscard]] int frees() const { return _frees; }

 private:
  static int count(MPI_Comm, int, void*, void* frees) {
    ++*static_cast<int*>(frees);
    return MPI_SUCCESS;
  }
  int _key = MPI_KEYVAL_INVALID;
  int _frees = 0;
};

TEST(Communicator, is_a_duplicate_with_the_same_ranks) {
  const Communicator comm;
  EXPECT_EQ(compare(comm.get(), MPI_COMM_WORLD), MPI_CONGRUENT);
  EXPECT_EQ(comm.rank(), world_rank());
  EXPECT_EQ(comm.size(), world_size());
  EXPECT_EQ(comm.is_root(), world_rank() == 0);
  EXPECT_EQ(sum_of_ones(comm), world_size());
}

TEST(Communicator, of_self_has_one_rank) {
  const Communicator comm(MPI_COMM_SELF);
  EXPECT_EQ(comm.size(), 1);
  EXPECT_TRUE(comm.is_root());
}

TEST(Communicator, messages_do_not_cross_into_the_original) {
  const Communicator comm;
  const int next = (comm.rank() + 1) % comm.size();
  const int previous = (comm.rank() + comm.size() - 1) % comm.size();
  const int sent = 100 + comm.rank();
  MPI_Request request = MPI_REQUEST_NULL;
  check_mpi(MPI_Isend(&sent, 1, MPI_INT, next, 5, comm.get(), &request), "MPI_Isend");
  MPI_Barrier(MPI_COMM_WORLD);
  int arrived_in_world = 1;
  check_mpi(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &arrived_in_world, MPI_STATUS_IGNORE),
            "MPI_Iprobe");
  EXPECT_EQ(arrived_in_world, 0);
  int received = 0;
  check_mpi(MPI_Recv(&received, 1, MPI_INT, previous, 5, comm.get(), MPI_STATUS_IGNORE), "MPI_Recv");
  check_mpi(MPI_Wait(&request, MPI_STATUS_IGNORE), "MPI_Wait");
  EXPECT_EQ(received, 100 + previous);
}

TEST(Communicator, is_freed_exactly_once) {
  FreeCounter counter;
  {
    Communicator first;
    counter.watch(first);
    const Communicator second = std::move(first);
    EXPECT_EQ(counter.frees(), 0);
  }
  EXPECT_EQ(counter.frees(), 1);
}

TEST(Communicator, moving_keeps_rank_and_size_and_empties_the_source) {
  Communicator first;
  const MPI_Comm original = first.get();
  const Communicator second = std::move(first);
  EXPECT_EQ(first.get(), MPI_COMM_NULL);  // NOLINT(bugprone-use-after-move): the moved-from state is what is tested
  EXPECT_EQ(second.get(), original);
  EXPECT_EQ(second.rank(), world_rank());
  EXPECT_EQ(second.size(), world_size());
}

TEST(Communicator, move_assignment_frees_what_the_target_held) {
  FreeCounter counter;
  Communicator target(MPI_COMM_SELF);
  counter.watch(target);
  Communicator source;
  const MPI_Comm kept = source.get();
  target = std::move(source);
  EXPECT_EQ(counter.frees(), 1);
  EXPECT_EQ(target.get(), kept);
  EXPECT_EQ(target.size(), world_size());
}

TEST(Communicator, self_move_keeps_it) {
  FreeCounter counter;
  Communicator comm;
  counter.watch(comm);
  Communicator& same = comm;
  comm = std::move(same);
  EXPECT_EQ(counter.frees(), 0);
  EXPECT_EQ(sum_of_ones(comm), world_size());
}

TEST(Communicator, of_nothing_is_refused_with_mpis_own_words) {
  try {
    const Communicator comm(MPI_COMM_NULL);
    FAIL() << "nothing was thrown";
  } catch (const EnvironmentError& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith("MPI_Comm_dup failed: MPI_ERR_COMM"));
  }
}

TEST(Communicator, cannot_be_copied) {
  EXPECT_FALSE(std::is_copy_constructible_v<Communicator>);
  EXPECT_FALSE(std::is_copy_assignable_v<Communicator>);
}

}  // namespace
}  // namespace orbweaver::core::communicator_test
