#include "found_structure.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/model/derivatives.hpp"
#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/model/rounded.hpp"
#include "orbweaver/numerics/random.hpp"
#include "trial_states.hpp"

namespace orbweaver::systems {

namespace {

using model::Rounded;
using Numbers = std::vector<Rounded>;

constexpr std::uint64_t seed = 20261128;
/// Rounding that is bound to first order, times this.
constexpr double margin = 16.0;

/// Whether a number is not 0, rounding allowed for.
bool differs(const Rounded& x) { return std::abs(x.value()) > margin * x.error(); }

class Trials {
 public:
  Trials(BuiltModel& model, const std::vector<double>& values, const std::vector<std::string>& free)
      : _model(model), _values(values), _d(model.field.size()) {
    for (const std::string& name : model.parameters)
      _is_free.push_back(std::find(free.begin(), free.end(), name) != free.end());
  }

  /// Whether the nodes are 0 wherever they are finite, which they are somewhere. `effects`: for all values of effects'
  /// parameters.
  [[nodiscard]] bool vanish(const std::vector<int>& nodes, bool effects = false) {
    bool zero = true;
    const bool seen = each(nodes, effects, [&](const Numbers& values) {
      zero = zero && std::none_of(values.begin(), values.end(), differs);
    });
    return seen && zero;
  }

  /// Whether the node is nowhere above 0, for all values of effects' parameters.
  [[nodiscard]] bool is_never_positive(int node) {
    bool never = true;
    const bool seen = each({node}, true, [&](const Numbers& values) {
      never = never && !(differs(values.front()) && values.front().value() > 0.0);
    });
    return seen && never;
  }

 private:
  template <class Look>
  bool each(const std::vector<int>& nodes, bool effects, const Look& look) {
    numerics::Random random(seed);
    bool seen = false;
    for (const double size : trial_sizes)
      for (int n = 0; n < states_a_size; ++n) {
        Numbers z, p;
        for (std::size_t i = 0; i < _d; ++i) z.emplace_back(size * random());
        for (std::size_t k = 0; k < _values.size(); ++k) p.emplace_back(value(k, effects, random));
        const Numbers found =
            model::evaluate<Rounded>(_model.graph, nodes, std::span<const Rounded>(z), std::span<const Rounded>(p));
        const bool is_finite = std::all_of(found.begin(), found.end(), [](const Rounded& x) {
          return std::isfinite(x.value()) && std::isfinite(x.error());
        });
        if (!is_finite) continue;
        seen = true;
        look(found);
      }
    return seen;
  }

  /// Of parameter k: as it is bound, or some value of its range.
  [[nodiscard]] double value(std::size_t k, bool effects, numerics::Random& random) const {
    const double chance = std::abs(random());
    const std::string& name = _model.parameters[k];
    bool moves = _is_free[k];
    const Parameter* own = nullptr;
    const auto look_for = [&](const std::vector<Parameter>& parameters, bool is_effect) {
      for (const Parameter& parameter : parameters)
        if (parameter.name == name) {
          own = &parameter;
          moves = moves || (effects && is_effect);
        }
    };
    look_for(_model.info.parameters, false);
    for (const Effect& effect : _model.info.effects) look_for(effect.parameters, true);
    if (!moves || own == nullptr) return _values[k];
    const double lower = std::isfinite(own->lower) ? own->lower : _values[k] - 1.0;
    const double upper = std::isfinite(own->upper) ? own->upper : std::max(_values[k], lower) + 1.0;
    return lower + (upper - lower) * (0.1 + 0.8 * std::min(chance, 1.0));
  }

  BuiltModel& _model;
  const std::vector<double>& _values;
  std::size_t _d;
  std::vector<bool> _is_free;
};

/// f(S z) - S' f(z), or with f(R z) + R' f(z).
std::vector<int> defect(BuiltModel& model, const BuiltModel::Image& image) {
  model::Graph& graph = model.graph;
  const std::vector<int> moved = model::substituted(graph, model.field, {.inputs = image.nodes, .parameters = {}});
  std::vector<int> nodes;
  for (std::size_t i = 0; i < model.field.size(); ++i) {
    const std::vector<int> one{image.nodes[i]};
    const int rate = model::derivatives_along(graph, one, {.inputs = model.field, .parameters = {}}).front();
    const int turned = rate < 0 ? graph.constant(0.0) : rate;
    nodes.push_back(image.reverses ? graph.add(moved[i], turned) : graph.subtract(moved[i], turned));
  }
  return nodes;
}

/// Matrix and offset of an image; throws where it is not affine with numbers that parameters do not move.
AffineMap affine_of(BuiltModel& model, const BuiltModel::Image& image, const std::vector<double>& values) {
  const auto d = static_cast<int>(model.field.size());
  const std::vector<int> slopes = model::jacobian(model.graph, image.nodes, d);
  const std::vector<bool> within = model::needed_for(model.graph, slopes);
  for (std::size_t n = 0; n < within.size(); ++n)
    if (within[n] && model.graph.nodes()[n].operation == model::Operation::input)
      throw core::InputError(
          fmt::format("{}: expected an affine map of the coordinates, got one that is not", image.place));
  const std::vector<double> origin(static_cast<std::size_t>(d), 0.0);
  const std::vector<double> matrix =
      model::evaluate<double>(model.graph, slopes, std::span<const double>(origin), std::span<const double>(values));
  const std::vector<double> offset = model::evaluate<double>(model.graph, image.nodes, std::span<const double>(origin),
                                                             std::span<const double>(values));
  AffineMap map;
  map.matrix =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(matrix.data(), d, d);
  map.offset = Eigen::Map<const Eigen::VectorXd>(offset.data(), d);
  return map;
}

}  // namespace

Structure found_structure(BuiltModel& model, const std::vector<double>& values, const std::vector<std::string>& free,
                          std::vector<int>& conserved) {
  Trials trials(model, values, free);
  model::Graph& graph = model.graph;
  Structure structure;
  structure.dimension = static_cast<int>(model.field.size());
  structure.angles = model.angles;
  structure.guards = model.named_guards;
  structure.driven = model.is_driven;
  const bool acts = model.power >= 0 && !trials.vanish({model.power}, true);
  for (const BuiltModel::Quantity& quantity : model.quantities) {
    const std::vector<int> one{quantity.node};
    const int rate = model::derivatives_along(graph, one, {.inputs = model.field, .parameters = {}}).front();
    const bool is_kept = rate < 0 || (!(acts && quantity.name == "energy") && trials.vanish({rate}));
    if (is_kept) {
      structure.conserved.push_back(quantity.name);
      conserved.push_back(quantity.node);
    } else if (!acts && model.effects.empty()) {
      throw core::InputError(
          fmt::format("{}: expected that the field keeps `{}`, got one that does not; mend the formula or leave it out",
                      model.place, quantity.name));
    }
  }
  const bool is_hamiltonian = model.is_canonical || (model.action >= 0 && !structure.conserved.empty());
  structure.dissipative = !is_hamiltonian && model.growth >= 0 && !trials.vanish({model.growth}, true);
  structure.symplectic = is_hamiltonian && !acts;
  structure.decays = acts && !model.is_driven && trials.is_never_positive(model.power);
  const auto is_known = [&](const BuiltModel::Image& image) {
    const std::vector<Symmetry>& known = image.reverses ? structure.reversors : structure.equivariances;
    return std::any_of(known.begin(), known.end(), [&](const Symmetry& own) { return own.name == image.name; });
  };
  for (const BuiltModel::Image& image : model.images) {
    if (is_known(image)) continue;
    AffineMap map = affine_of(model, image, values);
    if (!trials.vanish(defect(model, image))) {
      if (image.if_it_holds || !model.effects.empty()) continue;
      throw core::InputError(
          fmt::format("{}: expected that the field keeps `{}`, got one that does not{}; mend it, or leave it out",
                      image.place, image.name, image.reverses ? " turn round with it" : ""));
    }
    (image.reverses ? structure.reversors : structure.equivariances).push_back({image.name, std::move(map)});
  }
  return structure;
}

}  // namespace orbweaver::systems
