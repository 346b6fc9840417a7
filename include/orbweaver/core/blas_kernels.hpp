#pragma once

namespace orbweaver::core {

/// OpenBLAS 0.3.21 does not know newer CPUs and falls back to its oldest kernels (SSE3), which halves the speed of
/// dense linear algebra. Where that has happened on a CPU with AVX2 or AVX-512, this sets OPENBLAS_CORETYPE and has
/// OpenBLAS choose again, or, where it cannot be asked to, starts the same program again; otherwise, or where the user
/// has set it, it does nothing. Call first thing in main: results then do not depend on how the program was started.
/// With another BLAS it does nothing.
void prefer_fitting_blas_kernels(char** argv);

}  // namespace orbweaver::core
