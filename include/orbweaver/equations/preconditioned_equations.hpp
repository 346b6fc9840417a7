#pragma once

namespace orbweaver::equations {

/// Equations F(u) = 0 with a preconditioner that is built at one point and used at others.
class PreconditionedEquations {
 public:
  virtual ~PreconditionedEquations() = default;
  /// Numbers in u and in F(u).
  [[nodiscard]] virtual int size() const = 0;
  virtual void residual(const double* u, double* r) const = 0;
  /// Builds the preconditioner at `u`.
  virtual void factor(const double* u) = 0;
  /// In place: r -> approximate solution of the linearised equations.
  virtual void precondition(double* r) const = 0;
};

}  // namespace orbweaver::equations
