#include "orbweaver/numerics/decompositions.hpp"

template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;
template class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;
template class Eigen::ComplexEigenSolver<Eigen::MatrixXcd>;
template Eigen::ComplexEigenSolver<Eigen::MatrixXcd>& Eigen::ComplexEigenSolver<Eigen::MatrixXcd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXcd>&, bool);
template class Eigen::ComplexSchur<Eigen::MatrixXcd>;
template Eigen::ComplexSchur<Eigen::MatrixXcd>& Eigen::ComplexSchur<Eigen::MatrixXcd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXcd>&, bool);
template class Eigen::EigenSolver<Eigen::MatrixXd>;
template Eigen::EigenSolver<Eigen::MatrixXd>& Eigen::EigenSolver<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&, bool);
template class Eigen::HouseholderQR<Eigen::MatrixXd>;
template void Eigen::HouseholderSequence<Eigen::MatrixXd, Eigen::VectorXd>::evalTo(
    Eigen::MatrixXd&, Eigen::VectorXd&) const;
template void Eigen::HouseholderSequence<Eigen::MatrixXd, Eigen::VectorXd>::applyThisOnTheLeft(
    Eigen::MatrixXd&, Eigen::VectorXd&, bool) const;
template class Eigen::JacobiSVD<Eigen::MatrixXd>;
template class Eigen::JacobiSVD<Eigen::MatrixXcd>;
template class Eigen::LDLT<Eigen::MatrixXd>;
template class Eigen::PartialPivLU<Eigen::MatrixXcd>;
template class Eigen::PartialPivLU<Eigen::MatrixXd>;
template Eigen::PartialPivLU<Eigen::MatrixXd>::PartialPivLU(const Eigen::EigenBase<Eigen::MatrixXd>&);
