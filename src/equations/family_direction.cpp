#include "orbweaver/equations/family_direction.hpp"

#include <algorithm>

#include "index.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/equations/anderson.hpp"

namespace orbweaver::equations {

namespace {

/// J v = e, e a unit in one condition.
class DirectionEquations final : public PreconditionedEquations {
 public:
  DirectionEquations(const Collocation& equations, int condition) : _equations(equations), _condition(condition) {}
  [[nodiscard]] int size() const override { return _equations.size(); }
  void residual(const double* v, double* r) const override {
    _equations.apply_jacobian(v, r);
    r[_equations.period_at() + _condition] -= 1.0;
  }
  void factor(const double*) override {}
  void precondition(double* r) const override { _equations.precondition(r); }

 private:
  const Collocation& _equations;
  int _condition;
};

}  // namespace

std::vector<double> family_direction(Collocation& equations, const std::vector<double>& u, int condition) {
  equations.factor(u.data());
  DirectionEquations linear(equations, condition);
  AndersonSolver solver;
  std::vector<double> direction(at(equations.size()), 0.0);
  AndersonSolver::Options options;
  // One linear system: a direction needs no more digits than its branch has, and may be long next to a fold.
  options.tolerance = 1e-9;
  options.rounding = 1e-10;
  options.divergence = 1e6;
  options.scaled_from = equations.period_at();
  options.border_scale = std::min(1.0, equations.quality(u.data()).amplitude);
  options.fresh_iterations = 40;
  const AndersonSolver::Result result = solver.solve(linear, direction, false, options);
  if (!result.converged) throw core::NumericalError("the direction of the family could not be computed");
  return direction;
}

}  // namespace orbweaver::equations
