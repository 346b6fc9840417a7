#include "orbweaver/systems/reduced_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "linear_quantities.hpp"
#include "orbweaver/core/error.hpp"
#include "reduced_equations.hpp"
#include "reduced_structure.hpp"
#include "with_totals.hpp"

namespace orbweaver::systems {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Relative: a state's value of a quantity may be told in some digits.
constexpr double same_value = 1e-6;
/// What is gained by another frame is of order 1.
constexpr double less_skew = 1e-6;

/// The system without its linear quantities.
std::shared_ptr<const System> made(const std::shared_ptr<const System>& whole, const LinearQuantities& linear,
                                   const std::optional<Straightening>& straightening) {
  const auto frame_of = [linear, straightening](const std::shared_ptr<const GraphSystem>& of) {
    const Chart chart = chart_of(*of, linear, straightening);
    // In the frame that goes along the action is less by the values times what the frame moves, and which multiple of
    // the action's momenta a quantity is, is not known.
    return Frame{reduced_info(*of, linear, chart),
                 reduced_structure(*of, linear, chart),
                 {},
                 std::make_shared<const Reduction>(Reduction{of, linear, chart}),
                 of->frame().has_action && chart.values.isZero(0.0)};
  };
  const std::shared_ptr<const GraphSystem> graph = graph_system(whole);
  return std::make_shared<const GraphSystem>(graph,
                                             reduced_equations(*graph, linear, chart_of(*graph, linear, straightening)),
                                             std::vector<double>{}, whole->family_scalars(), frame_of, true);
}

const Reduction* reduction_of(const System& system) {
  const auto* found = dynamic_cast<const GraphSystem*>(&system);
  return found == nullptr ? nullptr : found->frame().reduction.get();
}

const Reduction& as_reduced(const System& system) {
  const Reduction* found = reduction_of(system);
  core::require(found != nullptr, "a reduced system has a whole one");
  return *found;
}

/// Coordinates that follow from the others and the totals: those of the largest terms at `place`, since one that is
/// small beside others would be the difference of large ones. Elimination with complete pivoting.
std::vector<int> redundant_at(const std::vector<LinearTotal>& totals, const VectorXd& place) {
  const auto k = static_cast<Index>(totals.size());
  const double largest = place.cwiseAbs().maxCoeff();
  const VectorXd sizes = largest > 0.0
                             ? VectorXd(place.cwiseAbs().cwiseMax(std::numeric_limits<double>::epsilon() * largest))
                             : VectorXd(VectorXd::Ones(place.size()));
  MatrixXd terms(k, place.size());
  for (Index a = 0; a < k; ++a) {
    terms.row(a) = totals[static_cast<std::size_t>(a)].weights.cwiseProduct(sizes);
    terms.row(a) /= terms.row(a).cwiseAbs().maxCoeff();
  }
  std::vector<int> redundant;
  for (Index a = 0; a < k; ++a) {
    Index row = 0, column = 0;
    terms.bottomRows(k - a).cwiseAbs().maxCoeff(&row, &column);
    terms.row(a).swap(terms.row(a + row));
    for (Index b = a + 1; b < k; ++b) terms.row(b) -= terms(b, column) / terms(a, column) * terms.row(a);
    terms.bottomRows(k - a - 1).col(column).setZero();
    redundant.push_back(static_cast<int>(column));
  }
  return redundant;
}

}  // namespace

std::shared_ptr<const System> without_totals(std::shared_ptr<const System> system,
                                             const std::vector<LinearTotal>& totals, const HeldTotals& held) {
  const auto d = static_cast<std::size_t>(system->dimension());
  LinearQuantities linear;
  linear.place = held.place.size() == d ? held.place : std::vector<double>(d, 0.0);
  const VectorXd place = Eigen::Map<const VectorXd>(linear.place.data(), static_cast<Index>(d));
  std::map<std::string, double> values;
  auto next = static_cast<int>(system->structure().conserved.size());
  for (const LinearTotal& total : totals) {
    linear.quantities.push_back(total.quantity >= 0 ? total.quantity : next++);
    const auto given = held.values.find(total.name);
    values[total.name] = given != held.values.end() ? given->second
                         : total.quantity >= 0      ? system->conserved(total.quantity, linear.place)
                                                    : total.weights.dot(place);
  }
  linear.motions = MatrixXd::Zero(static_cast<Index>(d), 0);
  linear.redundant = redundant_at(totals, place);
  const std::shared_ptr<const System> whole = with_totals(std::move(system), totals, values, held.moving);
  std::optional<Straightening> straightening;
  const Chart plain = chart_of(*whole, linear, {});
  if (skewness(*whole, linear, plain) > 0.0) straightening = straightening_of(*whole, linear, plain);
  return made(whole, linear, straightening);
}

std::shared_ptr<const System> reduced(std::shared_ptr<const System> system) {
  if (const std::vector<LinearTotal> totals = linear_totals(*system); !totals.empty()) {
    const FamilyScalars moving = system->family_scalars();
    return without_totals(std::move(system), totals, {.values = {}, .place = {}, .moving = moving});
  }
  if (system->structure().conserved.size() < 2) return system;
  const LinearSearch search = find_linear_quantities(*system);
  if (!search.obstacle.empty()) return system;
  LinearQuantities linear = search.found;
  const auto skew = [&](const LinearQuantities& choice) {
    return skewness(*system, choice, chart_of(*system, choice, {}));
  };
  // The frame in the middle of a free chain, say, keeps its mirror what it is.
  double least = skew(linear);
  const auto consider = [&](const LinearQuantities& choice) {
    const bool is_apart = std::none_of(choice.redundant.begin(), choice.redundant.end(), [&](int i) {
      return std::find(choice.frame.begin(), choice.frame.end(), i) != choice.frame.end();
    });
    if (least == 0 || !is_apart) return;
    const double found = skew(choice);
    if (found >= least - less_skew) return;
    linear = choice;
    least = found;
  };
  for (const LinearQuantities& frame : search.frames) consider(frame);
  for (const std::vector<int>& redundant : search.redundants) {
    LinearQuantities choice = linear;
    choice.redundant = redundant;
    consider(choice);
  }
  std::optional<Straightening> straightening;
  if (least > 0.0) straightening = straightening_of(*system, linear, chart_of(*system, linear, {}));
  return made(system, linear, straightening);
}

std::string why_not_reduced(const System& system) {
  return system.structure().conserved.size() < 2 ? "" : find_linear_quantities(system).obstacle;
}

const System* whole_of(const System& system) {
  const Reduction* found = reduction_of(system);
  return found == nullptr ? nullptr : found->whole.get();
}

std::vector<double> reduced_state(const System& system, std::span<const double> whole) {
  const Reduction& to = as_reduced(system);
  const VectorXd z = Eigen::Map<const VectorXd>(whole.data(), static_cast<Index>(whole.size()));
  for (std::size_t a = 0; a < to.linear.quantities.size(); ++a) {
    const int quantity = to.linear.quantities[a];
    const std::string& name = to.whole->structure().conserved[static_cast<std::size_t>(quantity)];
    const double value = to.whole->conserved(quantity, whole);
    const double held = to.chart.values(static_cast<Index>(a));
    const double size = to.chart.gradients.col(static_cast<Index>(a)).cwiseAbs().dot(z.cwiseAbs());
    if (std::abs(value - held) <= same_value * std::max(size, std::abs(held))) continue;
    throw core::InputError(fmt::format(
        "expected a state with {} = {:g}, which is held, got one with {:.10g}; {}", name, held, value,
        system.parameters().contains(name)
            ? fmt::format("give the system the parameter `{}: {:.10g}`", name, value)
            : fmt::format("change the state, or give the model a parameter `{}`, which is then the value held", name)));
  }
  const VectorXd y = to.chart.rates * z;
  return {y.begin(), y.end()};
}

std::vector<double> whole_state(const System& system, std::span<const double> state) {
  const Chart& chart = as_reduced(system).chart;
  const VectorXd z =
      chart.states * Eigen::Map<const VectorXd>(state.data(), static_cast<Index>(state.size())) + chart.origin;
  return {z.begin(), z.end()};
}

}  // namespace orbweaver::systems
