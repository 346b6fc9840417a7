#include "linearized_formulas.hpp"

#include <vector>

#include "orbweaver/core/error.hpp"
#include "orbweaver/model/evaluate.hpp"

namespace orbweaver::systems {

void linearize_formulas(const Formulas& formulas, const numerics::QuadVector& z, numerics::QuadVector& f,
                        numerics::QuadMatrix& jacobian) {
  using numerics::Quad;
  const Eigen::Index d = formulas.dimension;
  core::require(z.size() == d, "a state of another dimension");
  std::vector<Quad> inputs(z.data(), z.data() + d);
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index c = 0; c < d; ++c) inputs.emplace_back(i == c ? 1.0 : 0.0);
  const std::vector<Quad> parameters(formulas.values.begin(), formulas.values.end());
  std::vector<int> outputs = formulas.field;
  outputs.insert(outputs.end(), formulas.variations.begin(), formulas.variations.end());
  const std::vector<Quad> values = model::evaluate<Quad>(formulas.graph, outputs, inputs, parameters);

  f.resize(d);
  jacobian.resize(d, d);
  auto value = values.begin();
  for (Eigen::Index i = 0; i < d; ++i) f(i) = *value++;
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index c = 0; c < d; ++c) jacobian(i, c) = *value++;
}

}  // namespace orbweaver::systems
