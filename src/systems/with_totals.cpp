#include "with_totals.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "graph_system.hpp"

namespace orbweaver::systems {

std::shared_ptr<const System> with_totals(const std::shared_ptr<const System>& system,
                                          const std::vector<LinearTotal>& totals,
                                          const std::map<std::string, double>& values, const FamilyScalars& moving) {
  constexpr double any = std::numeric_limits<double>::infinity();
  const std::shared_ptr<const GraphSystem> whole = graph_system(system);
  Equations equations = whole->equations();
  model::Graph& graph = equations.graph;
  Frame frame = whole->frame();
  std::vector<double> added;
  std::vector<std::string> told;
  for (const LinearTotal& total : totals) {
    const std::string text = sum_text(frame.info.state_names, total.weights);
    if (total.quantity < 0) {
      int sum = graph.constant(0.0);
      for (int i = 0; i < whole->dimension(); ++i)
        sum = graph.add(sum, graph.multiply(graph.input(i), graph.constant(total.weights(i))));
      equations.conserved.push_back(sum);
      frame.structure.conserved.push_back(total.name);
      told.push_back(fmt::format("{} = {}", total.name, text));
    }
    if (whole->parameters().contains(total.name)) continue;
    added.push_back(values.at(total.name));
    equations.parameters.push_back(total.name);
    frame.info.parameters.push_back(
        {total.name, added.back(), -any, any, false, "1", "the total " + text + ", which is kept"});
  }
  if (!told.empty()) frame.info.meaning += fmt::format("; found to be kept: {}", fmt::join(told, ", "));
  return std::make_shared<const GraphSystem>(whole, std::move(equations), added, moving,
                                             [frame](const std::shared_ptr<const GraphSystem>&) { return frame; });
}

}  // namespace orbweaver::systems
