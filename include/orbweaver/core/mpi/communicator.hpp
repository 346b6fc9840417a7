#pragma once

#include <mpi.h>

namespace orbweaver::core {

/// A duplicate of an MPI communicator, freed with the object, so that Orbweaver's messages never meet anybody else's.
/// Making and destroying one is collective over the original.
class Communicator {
 public:
  /// Duplicates `original`. Throws EnvironmentError when MPI refuses.
  explicit Communicator(MPI_Comm original = MPI_COMM_WORLD);
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;
  Communicator(Communicator&& other) noexcept;
  Communicator& operator=(Communicator&& other) noexcept;
  ~Communicator();

  [[nodiscard]] MPI_Comm get() const noexcept { return _comm; }
  [[nodiscard]] int rank() const noexcept { return _rank; }
  [[nodiscard]] int size() const noexcept { return _size; }
  [[nodiscard]] bool is_root() const noexcept { return _rank == 0; }

 private:
  void free() noexcept;
  MPI_Comm _comm = MPI_COMM_NULL;
  int _rank = 0;
  int _size = 1;
};

}  // namespace orbweaver::core
