#include "clock.hpp"

#include <vector>

#include <mpi.h>

namespace simulated {

namespace {

using namespace std::chrono;

constexpr nanoseconds slack = microseconds(55);

// All ranks live in one process and share its variables.
nanoseconds& slept() {
  static std::vector<nanoseconds> of_rank;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (of_rank.size() <= static_cast<std::size_t>(rank)) of_rank.resize(static_cast<std::size_t>(rank) + 1);
  return of_rank[static_cast<std::size_t>(rank)];
}

}  // namespace

nanoseconds now() noexcept { return duration_cast<nanoseconds>(duration<double>(MPI_Wtime())); }

void sleep(nanoseconds duration) {
  slept() += duration + slack;
  smpi_usleep(static_cast<useconds_t>(duration_cast<microseconds>(duration + slack).count()));
}

int processor_time(timespec* time) {
  const nanoseconds at = now();  // first: another rank may run within the call, and lengthen the vector
  const nanoseconds used = at - slept();
  time->tv_sec = duration_cast<seconds>(used).count();
  time->tv_nsec = (used % seconds(1)).count();
  return 0;
}

}  // namespace simulated
