#pragma once

namespace orbweaver::core {

/// What a process of the program takes of the memory that `ulimit -v` (addresses) and `-d` (data) allow, before it
/// holds an orbit, in bytes: libraries, MPI, PETSc, and the buffer that OpenBLAS takes at its first large product.
/// Measured for a survey of the double pendulum with Open MPI 4.1 and OpenBLAS 0.3.21, alone: 418 and 150 MiB; of two
/// ranks each 475 and 159, of eight 533 and 159.
struct AddressSpace {
  double addresses = 0.0;
  double data = 0.0;
};
[[nodiscard]] AddressSpace space_of_a_rank();

/// What the limits of this process allow; infinite where there is none.
[[nodiscard]] AddressSpace space_allowed();

/// Throws EnvironmentError, with the numbers needed, where the limits of this process allow less than that.
void require_space_of_a_rank();

/// Has OpenBLAS take its buffer now, or throws EnvironmentError with the number needed: left to itself it repeats for
/// ever what is refused. Once MPI has started, before anything uses BLAS. With another BLAS it does nothing.
void take_blas_buffer();

}  // namespace orbweaver::core
