#include "orbweaver/numerics/decompositions.hpp"

template class Eigen::EigenSolver<Eigen::MatrixXd>;
template class Eigen::HouseholderQR<Eigen::MatrixXd>;
template class Eigen::JacobiSVD<Eigen::MatrixXd>;
template class Eigen::JacobiSVD<Eigen::MatrixXcd>;
template class Eigen::LDLT<Eigen::MatrixXd>;
template class Eigen::PartialPivLU<Eigen::MatrixXcd>;
template class Eigen::PartialPivLU<Eigen::MatrixXd>;
