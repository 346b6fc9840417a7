#include "second_derivatives.hpp"

namespace orbweaver::starts {

Eigen::MatrixXd second_derivatives(const systems::System& system, int k, const Eigen::VectorXd& point,
                                   const Eigen::VectorXd& steps) {
  const Eigen::Index d = point.size();
  Eigen::MatrixXd second(d, d);
  Eigen::VectorXd z = point;
  Eigen::VectorXd above(d);
  Eigen::VectorXd below(d);
  for (Eigen::Index i = 0; i < d; ++i) {
    z(i) = point(i) + steps(i);
    system.conserved_gradients(k, 1, z.data(), above.data());
    z(i) = point(i) - steps(i);
    system.conserved_gradients(k, 1, z.data(), below.data());
    z(i) = point(i);
    second.col(i) = (above - below) / (2.0 * steps(i));
  }
  return second;
}

}  // namespace orbweaver::starts
