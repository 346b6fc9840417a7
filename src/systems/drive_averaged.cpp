#include "orbweaver/systems/drive_averaged.hpp"

#include "graph_system.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/model/derivatives.hpp"
#include "orbweaver/numerics/two_pi.hpp"

namespace orbweaver::systems {

std::shared_ptr<const System> averaged_over_drive(const std::shared_ptr<const System>& system, int phases) {
  core::require(system->structure().driven, "the mean over a drive wants a driven system");
  const std::shared_ptr<const GraphSystem> driven = graph_system(system);
  Equations equations = driven->equations();
  model::Graph& graph = equations.graph;
  model::Direction at;
  for (int i = 0; i < driven->dimension(); ++i) at.inputs.push_back(graph.input(i));
  const auto mean_from = [&](const auto& self, int first, int step) -> std::vector<int> {
    if (step == phases) {
      at.inputs.back() = graph.constant(numerics::two_pi * first / phases);
      return model::substituted(graph, driven->equations().field, at);
    }
    std::vector<int> sums = self(self, first, 2 * step);
    const std::vector<int> others = self(self, first + step, 2 * step);
    for (std::size_t i = 0; i < sums.size(); ++i)
      sums[i] = graph.multiply(graph.constant(0.5), graph.add(sums[i], others[i]));
    return sums;
  };
  equations.field = mean_from(mean_from, 0, 1);
  return std::make_shared<const GraphSystem>(
      driven, std::move(equations), std::vector<double>{}, driven->family_scalars(),
      [](const std::shared_ptr<const GraphSystem>& whole) { return whole->frame(); });
}

}  // namespace orbweaver::systems
