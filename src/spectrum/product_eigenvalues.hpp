#pragma once

#include <complex>
#include <vector>

#include <Eigen/Dense>

namespace orbweaver::spectrum {

/// Eigenvalues of the product A_(n-1) ... A_0 of square matrices, each with digits of its own however far apart their
/// moduli are: orthogonal iteration around the cycle, the eigenvalues that it does not part by modulus solved together
/// (after Bojanczyk, Golub and Van Dooren, The periodic Schur decomposition, 1992, without their shifts). `symplectic`:
/// the product is similar to a symplectic matrix; k = mu + 1/mu is returned, one a pair. Largest modulus first, then
/// largest imaginary part.
[[nodiscard]] std::vector<std::complex<double>> product_eigenvalues(const std::vector<Eigen::MatrixXd>& factors,
                                                                    bool symplectic);

}  // namespace orbweaver::spectrum
