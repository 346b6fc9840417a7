#pragma once

#include <Eigen/Dense>

/// Eigen's decompositions of dynamic matrices, compiled once (src/numerics/decompositions.cpp): each takes the compiler
/// five to twenty seconds. Who decomposes a matrix includes this header; the code is Eigen's own.
extern template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;
extern template class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
extern template class Eigen::ComplexEigenSolver<Eigen::MatrixXcd>;
extern template Eigen::ComplexEigenSolver<Eigen::MatrixXcd>& Eigen::ComplexEigenSolver<Eigen::MatrixXcd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXcd>&, bool);
extern template class Eigen::ComplexSchur<Eigen::MatrixXcd>;
extern template Eigen::ComplexSchur<Eigen::MatrixXcd>& Eigen::ComplexSchur<Eigen::MatrixXcd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXcd>&, bool);
extern template class Eigen::EigenSolver<Eigen::MatrixXd>;
extern template Eigen::EigenSolver<Eigen::MatrixXd>& Eigen::EigenSolver<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&, bool);
extern template class Eigen::HouseholderQR<Eigen::MatrixXd>;
extern template void Eigen::HouseholderSequence<Eigen::MatrixXd, Eigen::VectorXd>::evalTo(
    Eigen::MatrixXd&, Eigen::VectorXd&) const;
extern template void Eigen::HouseholderSequence<Eigen::MatrixXd, Eigen::VectorXd>::applyThisOnTheLeft(
    Eigen::MatrixXd&, Eigen::VectorXd&, bool) const;
extern template class Eigen::JacobiSVD<Eigen::MatrixXd>;
extern template class Eigen::JacobiSVD<Eigen::MatrixXcd>;
extern template class Eigen::LDLT<Eigen::MatrixXd>;
extern template class Eigen::PartialPivLU<Eigen::MatrixXcd>;
extern template class Eigen::PartialPivLU<Eigen::MatrixXd>;
extern template Eigen::PartialPivLU<Eigen::MatrixXd>::PartialPivLU(const Eigen::EigenBase<Eigen::MatrixXd>&);
