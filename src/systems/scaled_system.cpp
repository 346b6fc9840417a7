#include "orbweaver/systems/scaled_system.hpp"

#include <cmath>
#include <utility>

#include "orbweaver/core/error.hpp"
#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/model/recorded.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/systems/quad_system.hpp"

namespace orbweaver::systems {

namespace {

/// Room for the scaled arguments of one call.
double* room(std::size_t size, std::vector<double>& buffer) {
  if (buffer.size() < size) buffer.resize(size);
  return buffer.data();
}

Structure scaled_structure(Structure structure, const Scales& scales) {
  const auto scale = [&](std::vector<Symmetry>& symmetries) {
    for (Symmetry& symmetry : symmetries)
      for (Eigen::Index i = 0; i < symmetry.map.offset.size(); ++i)  // matrices mix equal scales only
        symmetry.map.offset(i) /= scales.coordinate(static_cast<std::size_t>(i));
  };
  scale(structure.equivariances);
  scale(structure.reversors);
  return structure;
}

class ScaledSystem : public System {
 public:
  ScaledSystem(std::shared_ptr<const System> system, const Scales& scales)
      : _system(std::move(system)), _scales(scales), _structure(scaled_structure(_system->structure(), scales)) {
    for (std::size_t i = 0; i < size(); ++i) _rate.push_back(scales.time / scales.coordinate(i));
  }

  [[nodiscard]] const ModelInfo& info() const override { return _system->info(); }
  [[nodiscard]] const Structure& structure() const override { return _structure; }
  [[nodiscard]] const std::map<std::string, double>& parameters() const override { return _system->parameters(); }
  [[nodiscard]] const Scales& scales() const override { return _scales; }
  [[nodiscard]] const FamilyScalars& family_scalars() const override { return _system->family_scalars(); }

  void field(std::size_t nodes, const double* z, double* f) const override {
    _system->field(nodes, in_units(nodes, z), f);
    multiply(nodes, f, _rate);
  }

  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    _system->field_jacobian(nodes, in_units(nodes, z), f, jacobian);
    multiply(nodes, f, _rate);
    for (std::size_t i = 0; i < size(); ++i)
      for (std::size_t l = 0; l < size(); ++l)
        multiply(nodes, jacobian + (i * size() + l) * nodes, _rate[i] * _scales.coordinate(l));
  }

  void second_derivatives(std::size_t nodes, const double* z, const double* weights,
                          double* contracted) const override {
    thread_local std::vector<double> buffer;
    double* scaled_weights = room(size() * nodes, buffer);
    std::copy(weights, weights + size() * nodes, scaled_weights);
    multiply(nodes, scaled_weights, _rate);
    _system->second_derivatives(nodes, in_units(nodes, z), scaled_weights, contracted);
    for (std::size_t l = 0; l < size(); ++l)
      for (std::size_t m = 0; m < size(); ++m)
        multiply(nodes, contracted + (l * size() + m) * nodes, _scales.coordinate(l) * _scales.coordinate(m));
  }

  void parameter_derivatives(const std::string& name, std::size_t nodes, const double* z,
                             double* derivatives) const override {
    _system->parameter_derivatives(name, nodes, in_units(nodes, z), derivatives);
    multiply(nodes, derivatives, _rate);
    for (std::size_t i = 0; i < size(); ++i) multiply(nodes, derivatives + i * nodes, parameter_scale(name));
  }

  [[nodiscard]] std::shared_ptr<const System> with_parameters(
      const std::map<std::string, double>& values) const override {
    return scaled(_system->with_parameters(values), _scales);
  }

  [[nodiscard]] double conserved(int k, std::span<const double> z) const override {
    return _system->conserved(k, {in_units(1, z.data()), size()}) / quantity(k);
  }

  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    conserved_gradients(k, 1, z.data(), gradient.data());
  }

  void conserved_gradients(int k, std::size_t nodes, const double* z, double* gradients) const override {
    _system->conserved_gradients(k, nodes, in_units(nodes, z), gradients);
    for (std::size_t i = 0; i < size(); ++i)
      multiply(nodes, gradients + i * nodes, _scales.coordinate(i) / quantity(k));
  }

  [[nodiscard]] double guard(int k, std::span<const double> z) const override {
    return _system->guard(k, {in_units(1, z.data()), size()});
  }

  [[nodiscard]] double action_density(std::span<const double> z) const override {
    return _system->action_density({in_units(1, z.data()), size()}) / _scales.energy();
  }

 protected:
  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(_structure.dimension); }
  [[nodiscard]] const System& system() const { return *_system; }
  [[nodiscard]] double rate(std::size_t i) const { return _rate[i]; }

 private:
  [[nodiscard]] double quantity(int k) const {
    const auto place = static_cast<std::size_t>(k);
    return place < _scales.conserved.size() ? _scales.conserved[place] : 1.0;
  }

  static void multiply(std::size_t nodes, double* values, double factor) {
    if (factor == 1.0) return;
    for (std::size_t j = 0; j < nodes; ++j) values[j] *= factor;
  }

  static void multiply(std::size_t nodes, double* nodal, const std::vector<double>& factors) {
    for (std::size_t i = 0; i < factors.size(); ++i) multiply(nodes, nodal + i * nodes, factors[i]);
  }

  /// Valid until the next call.
  [[nodiscard]] const double* in_units(std::size_t nodes, const double* z) const {
    thread_local std::vector<double> buffer;
    double* state = room(size() * nodes, buffer);
    for (std::size_t i = 0; i < size(); ++i) {
      const double scale = _scales.coordinate(i);
      for (std::size_t j = 0; j < nodes; ++j) state[i * nodes + j] = scale * z[i * nodes + j];
    }
    return state;
  }

  std::shared_ptr<const System> _system;
  Scales _scales;
  Structure _structure;
  std::vector<double> _rate;  // time / s_i
};

class ScaledQuadSystem : public ScaledSystem, public QuadSystem {
 public:
  using ScaledSystem::ScaledSystem;

  void linearize(const numerics::QuadVector& z, numerics::QuadVector& f,
                 numerics::QuadMatrix& jacobian) const override {
    core::require(z.size() == dimension(), "a state of another dimension");
    numerics::QuadVector state = z;
    for (std::size_t i = 0; i < size(); ++i) state(static_cast<Eigen::Index>(i)) *= scales().coordinate(i);
    dynamic_cast<const QuadSystem&>(system()).linearize(state, f, jacobian);
    for (std::size_t i = 0; i < size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      f(row) *= rate(i);
      for (std::size_t l = 0; l < size(); ++l)
        jacobian(row, static_cast<Eigen::Index>(l)) *= rate(i) * scales().coordinate(l);
    }
  }
};

class ScaledFormulaSystem final : public ScaledQuadSystem, public FormulaSystem {
 public:
  using ScaledQuadSystem::ScaledQuadSystem;

  // Scales stand as factors and divisors of their own, so that nothing is rounded where digits are many.
  [[nodiscard]] Formulas formulas() const override {
    using model::Recorded;
    Formulas formulas = dynamic_cast<const FormulaSystem&>(system()).formulas();
    const model::Graph plain = formulas.graph;
    model::Recording recording;
    std::vector<Recorded> inputs;
    for (std::size_t n = 0; n < size() * (1 + size()); ++n)
      inputs.push_back(recording.input(static_cast<int>(n)) *
                       scales().coordinate(n < size() ? n : (n - size()) / size()));
    std::vector<Recorded> parameters;
    for (std::size_t n = 0; n < formulas.parameters.size(); ++n)
      parameters.push_back(recording.parameter(static_cast<int>(n)));
    const auto told = [&](std::vector<int>& nodes, const auto& scale) {
      std::vector<Recorded> values = model::evaluate<Recorded>(plain, nodes, inputs, parameters);
      for (std::size_t n = 0; n < values.size(); ++n) nodes[n] = scale(n, values[n]).node();
    };
    told(formulas.field, [&](std::size_t n, Recorded f) { return f * scales().time / scales().coordinate(n); });
    told(formulas.variations,
         [&](std::size_t n, Recorded f) { return f * scales().time / scales().coordinate(n / size()); });
    for (std::size_t k = 0; k < formulas.conserved.size(); ++k) {
      const double unit = scales().conserved.empty() ? 1.0 : scales().conserved[k];
      std::vector<int> quantity{formulas.conserved[k]};
      told(quantity, [&](std::size_t, Recorded value) { return value / unit; });
      formulas.conserved[k] = quantity.front();
      told(formulas.conserved_gradients[k],
           [&](std::size_t n, Recorded slope) { return slope * scales().coordinate(n) / unit; });
    }
    formulas.graph = recording.graph();
    return formulas;
  }
};

void check(const System& system, const Scales& scales) {
  const auto d = static_cast<std::size_t>(system.dimension());
  core::require(system.scales().are_one(), "a system is scaled once");
  core::require(scales.coordinates.empty() || scales.coordinates.size() == d, "one scale a coordinate");
  core::require(scales.parameters.empty() || scales.parameters.size() == system.family_scalars().free.size(),
                "one scale a parameter that moves");
  core::require(scales.conserved.empty() || scales.conserved.size() == system.structure().conserved.size(),
                "one scale a conserved quantity");
  const auto is_scale = [](double scale) { return std::isfinite(scale) && scale > 0.0; };
  core::require(is_scale(scales.time) && std::all_of(scales.coordinates.begin(), scales.coordinates.end(), is_scale) &&
                    std::all_of(scales.conserved.begin(), scales.conserved.end(), is_scale) &&
                    std::all_of(scales.parameters.begin(), scales.parameters.end(), is_scale),
                "scales are positive");
  const std::vector<std::size_t> first = mixed_coordinates(system.structure());
  for (std::size_t i = 0; i < d; ++i) {
    core::require(!system.structure().is_angle(i) || scales.coordinate(i) == 1.0, "angles have the scale 1");
    core::require(scales.coordinate(i) == scales.coordinate(first[i]),
                  "coordinates that a symmetry mixes have one scale");
  }
}

}  // namespace

std::vector<std::size_t> mixed_coordinates(const Structure& structure) {
  std::vector<std::size_t> first(static_cast<std::size_t>(structure.dimension));
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = i;
  for (const std::vector<Symmetry>* symmetries : {&structure.equivariances, &structure.reversors})
    for (const Symmetry& symmetry : *symmetries)
      for (std::size_t i = 0; i < first.size(); ++i)
        for (std::size_t l = 0; l < first.size(); ++l) {
          if (symmetry.map.matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(l)) == 0.0) continue;
          const auto [lower, upper] = std::minmax(first[i], first[l]);
          if (lower != upper) std::replace(first.begin(), first.end(), std::size_t{upper}, std::size_t{lower});
        }
  return first;
}

std::shared_ptr<const System> scaled(std::shared_ptr<const System> system, const Scales& scales) {
  check(*system, scales);
  if (scales.are_one()) return system;
  const bool is_quad = dynamic_cast<const QuadSystem*>(system.get()) != nullptr;
  if (is_quad && dynamic_cast<const FormulaSystem*>(system.get()) != nullptr)
    return std::make_shared<const ScaledFormulaSystem>(std::move(system), scales);
  if (is_quad) return std::make_shared<const ScaledQuadSystem>(std::move(system), scales);
  return std::make_shared<const ScaledSystem>(std::move(system), scales);
}

}  // namespace orbweaver::systems
