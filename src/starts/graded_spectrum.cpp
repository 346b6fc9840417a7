#include "graded_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/numerics/eigenvalues.hpp"
#include "orbweaver/numerics/quad.hpp"

namespace orbweaver::starts {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using numerics::Quad;
using numerics::QuadMatrix;

/// Of the largest modulus, for each dimension: rounding of the QR iteration in double precision.
constexpr double qr_rounding = std::numeric_limits<double>::epsilon();
/// Of an eigenvalue: what rounding of its own may be.
constexpr double known_eigenvalue = 1e-9;

/// The smallest real one does not count: it may be on its way through zero, as at a branch point, where its rounding is
/// that of the others.
bool is_graded(const Eigen::VectorXcd& values) {
  std::vector<double> moduli;
  double smallest = std::numeric_limits<double>::infinity();
  for (const std::complex<double>& value : values) {
    const double modulus = std::abs(value);
    if (value.imag() == 0.0 && modulus < smallest)
      std::swap(smallest, moduli.emplace_back(modulus));
    else
      moduli.push_back(modulus);
  }
  const auto least = std::min_element(moduli.begin(), moduli.end());
  return least != moduli.end() &&
         static_cast<double>(values.size()) * qr_rounding * values.cwiseAbs().maxCoeff() > known_eigenvalue * *least;
}

std::optional<GradedSpectrum> in_quadruple_precision(const MatrixXd& matrix, bool with_vectors) {
  const Eigen::EigenSolver<QuadMatrix> solver(matrix.cast<Quad>(), true);
  if (solver.info() != Eigen::Success) return std::nullopt;
  const Index d = matrix.rows();
  // A P = P D with real blocks in D: a pair's vectors are the sum and difference of its columns, times 1 and i.
  const QuadMatrix right = solver.pseudoEigenvectors();
  const QuadMatrix left = right.partialPivLu().inverse();
  GradedSpectrum out{Eigen::VectorXcd(d), VectorXd(d), Eigen::MatrixXcd()};
  if (with_vectors) out.vectors.resize(d, d);
  for (Index i = 0; i < d; ++i) {
    const Quad& im = solver.eigenvalues()(i).imag();
    out.values(i) = {solver.eigenvalues()(i).real().convert_to<double>(), im.convert_to<double>()};
    const Index first = im < 0 ? i - 1 : i;  // the one above the real axis comes first
    // In quadruple precision: units of coordinates may be far from one another.
    numerics::QuadVector v = right.col(first).cwiseAbs();
    numerics::QuadVector w = left.row(first).transpose().cwiseAbs();
    if (im != 0) {
      for (Index l = 0; l < d; ++l) {
        v(l) = sqrt(right(l, first) * right(l, first) + right(l, first + 1) * right(l, first + 1));
        w(l) = sqrt(left(first, l) * left(first, l) + left(first + 1, l) * left(first + 1, l)) / 2;
      }
    }
    const Quad size = w.dot(matrix.cwiseAbs().cast<Quad>() * v);
    out.sizes(i) = size.convert_to<double>();
    if (!with_vectors) continue;
    const Quad length = v.norm();
    for (Index l = 0; l < d; ++l) {
      const Quad imaginary = im == 0 ? Quad(0) : Quad((im < 0 ? -1 : 1) * right(l, first + 1));
      out.vectors(l, i) = {Quad(right(l, first) / length).convert_to<double>(),
                           Quad(imaginary / length).convert_to<double>()};
    }
  }
  // Beside a Jordan block there is no end to them.
  const double largest = out.values.cwiseAbs().maxCoeff();
  for (double& size : out.sizes) size = size < largest ? size : largest;
  return out;
}

}  // namespace

std::optional<GradedSpectrum> graded_spectrum(const MatrixXd& matrix, bool with_vectors) {
  std::optional<numerics::Eigensystem> system = numerics::eigensystem(matrix, with_vectors);
  if (!system) return std::nullopt;
  if (is_graded(system->values))
    if (auto graded = in_quadruple_precision(matrix, with_vectors)) return graded;
  const double largest = system->values.cwiseAbs().maxCoeff();
  return GradedSpectrum{std::move(system->values), VectorXd::Constant(matrix.rows(), largest),
                        std::move(system->vectors)};
}

}  // namespace orbweaver::starts
