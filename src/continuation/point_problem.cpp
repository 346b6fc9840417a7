#include "point_problem.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "collocation_problem.hpp"
#include "loop_problem.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::continuation {

double tail_limit(double amplitude, double size, const Options& options) {
  // Every harmonic carries rounding of the size of the loop: no cutoff takes a tail below that.
  const double rounding = std::numeric_limits<double>::epsilon() * size;
  return std::max(options.tail_tolerance * std::min(1.0, amplitude), rounding);
}

std::vector<double> PointProblem::conditions_with(const Prediction& prediction, int held_scalar) {
  std::vector<double> conditions = conditions_at(prediction);
  std::fill_n(conditions.begin(), prediction.values.size(), 0.0);
  conditions[scalars_at() + static_cast<std::size_t>(held_scalar)] = 1.0;
  return conditions;
}

std::unique_ptr<PointProblem> make_point_problem(const FamilyOf& family, const Options& options, ProblemState& state) {
  using corrector::Method;
  const Method method = options.corrector.method;
  if (method == Method::automatic || method == Method::collocation) {
    const std::string obstacle = CollocationProblem::obstacle(family, options.cutoff_to);
    if (obstacle.empty()) return std::make_unique<CollocationProblem>(family, options, state);
    if (method == Method::collocation)
      throw core::InputError(
          fmt::format("the corrector `collocation` does not apply to loops of {} with the isotropy `{}`: {}; use "
                      "`automatic`, which "
                      "takes collocation where it applies, or `newton-krylov`",
                      family.system.info().name, loop::to_text(family.isotropy), obstacle));
  }
  return std::make_unique<LoopProblem>(family, options, state);
}

}  // namespace orbweaver::continuation
