#pragma once

#include <functional>
#include <memory>

#include <Eigen/Dense>

namespace orbweaver::equations {

/// GMRES on a square matrix that is given by its products, preconditioned from the right. Overridable under an options
/// prefix.
class ShellGmres {
 public:
  using In = Eigen::Ref<const Eigen::VectorXd>;
  using Out = Eigen::Ref<Eigen::VectorXd>;
  using Action = std::function<void(const In& x, Out y)>;
  struct Actions {
    Action multiply;
    Action precondition;
    Action multiply_transposed{};  ///< where transposed systems are solved
    Action precondition_transposed{};
  };
  /// Of the residual, both: it is enough that one is met.
  struct Accuracy {
    double relative = 0.0;  ///< to the right side
    double absolute = 0.0;
  };
  struct Result {
    Eigen::VectorXd x;
    int iterations = 0;
    double residual = 0.0;  ///< as GMRES carries it along
  };

  ShellGmres(int size, const char* options_prefix, Actions actions);
  ~ShellGmres();
  ShellGmres(const ShellGmres&) = delete;
  ShellGmres& operator=(const ShellGmres&) = delete;

  /// As far as GMRES comes: whether that is enough is for the caller to say.
  [[nodiscard]] Result solve(const Eigen::VectorXd& right_side, Accuracy accuracy, bool transposed = false);

 private:
  struct Solver;
  std::unique_ptr<Solver> _solver;
};

}  // namespace orbweaver::equations
