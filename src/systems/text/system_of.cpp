#include "orbweaver/systems/text/system_of.hpp"

#include <utility>

#include "found_structure.hpp"
#include "graph_system.hpp"
#include "orbweaver/systems/model/checks.hpp"

namespace orbweaver::systems {

namespace {

std::shared_ptr<const System> made(BuiltModel model, std::vector<int> conserved, Structure structure,
                                   const std::vector<double>& values, const Bound& bound) {
  Equations equations{std::move(model.graph), std::move(model.parameters), std::move(model.field),
                      std::move(conserved),   std::move(model.guards),     model.action};
  return std::make_shared<const GraphSystem>(std::move(equations),
                                             Frame{std::move(model.info), std::move(structure), {}, {}}, values,
                                             std::move(model.sizes), bound.scalars);
}

std::vector<double> values_of(const BuiltModel& model, const Bound& bound) {
  std::vector<double> values;
  for (const std::string& name : model.parameters) values.push_back(bound[name]);
  return values;
}

}  // namespace

std::shared_ptr<const System> system_of(BuiltModel model, const Bound& bound) {
  const std::vector<double> values = values_of(model, bound);
  std::vector<int> conserved;
  Structure structure = found_structure(model, values, bound.scalars.free, conserved);
  check(structure, model.info, structure.dimension, static_cast<int>(structure.conserved.size()));
  return made(std::move(model), std::move(conserved), std::move(structure), values, bound);
}

std::shared_ptr<const System> system_of(BuiltModel model, Structure structure, const Bound& bound) {
  const auto quantities = static_cast<int>(model.quantities.size());
  check(structure, model.info, static_cast<int>(model.field.size()), quantities);
  if (model.guards.empty()) check_without_guards(structure);
  if (model.action < 0) check_without_action_density(structure);
  const std::vector<double> values = values_of(model, bound);
  std::vector<int> conserved;
  for (const BuiltModel::Quantity& quantity : model.quantities) conserved.push_back(quantity.node);
  // All quantities are the structure's while it is asked which of them the field keeps.
  Structure whole = structure;
  whole.conserved.resize(static_cast<std::size_t>(quantities));
  const std::shared_ptr<const System> asked = made(model, conserved, std::move(whole), values, bound);
  check_unnamed(structure, quantities, [&](int k, const double* z, double* f, double* gradient) {
    asked->field(1, z, f);
    asked->conserved_gradients(k, 1, z, gradient);
  });
  conserved.resize(structure.conserved.size());
  return made(std::move(model), std::move(conserved), std::move(structure), values, bound);
}

}  // namespace orbweaver::systems
