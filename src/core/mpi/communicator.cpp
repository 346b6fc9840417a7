#include "orbweaver/core/mpi/communicator.hpp"

#include <utility>

#include "orbweaver/core/mpi/check_mpi.hpp"

namespace orbweaver::core {

Communicator::Communicator(MPI_Comm original) {
  check_mpi(MPI_Comm_dup(original, &_comm), "MPI_Comm_dup");
  check_mpi(MPI_Comm_rank(_comm, &_rank), "MPI_Comm_rank");
  check_mpi(MPI_Comm_size(_comm, &_size), "MPI_Comm_size");
}

Communicator::Communicator(Communicator&& other) noexcept
    : _comm(std::exchange(other._comm, MPI_COMM_NULL)), _rank(other._rank), _size(other._size) {}

Communicator& Communicator::operator=(Communicator&& other) noexcept {
  if (this != &other) {
    free();
    _comm = std::exchange(other._comm, MPI_COMM_NULL);
    _rank = other._rank;
    _size = other._size;
  }
  return *this;
}

Communicator::~Communicator() { free(); }

void Communicator::free() noexcept {
  int finalized = 0;
  MPI_Finalized(&finalized);
  if (_comm != MPI_COMM_NULL && finalized == 0) MPI_Comm_free(&_comm);
  _comm = MPI_COMM_NULL;
}

}  // namespace orbweaver::core
