#include "collocation_metric.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "held_energy.hpp"
#include "orbweaver/loop/curve/system_at.hpp"

#include "orbweaver/corrector/correct.hpp"

namespace orbweaver::continuation {

using equations::Collocation;

namespace {

/// Those that move along the family: behind T.
std::size_t parameters_of(const Collocation& e) { return e.system().family_scalars().free.size(); }

}  // namespace

double step_product(const Collocation& e, const std::vector<double>& a, const std::vector<double>& b,
                    const std::vector<double>& c, const std::vector<double>& d, double period_unit) {
  double sum = 0.0;
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j <= e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * e.grid().stride() + j);
      sum += e.node_weights()[static_cast<std::size_t>(j)] * (a[n] - b[n]) * (c[n] - d[n]);
    }
  const auto at_period = static_cast<std::size_t>(e.period_at());
  sum += (a[at_period] - b[at_period]) * (c[at_period] - d[at_period]) / (period_unit * period_unit);
  for (std::size_t p = at_period + 1; p <= at_period + parameters_of(e); ++p) sum += (a[p] - b[p]) * (c[p] - d[p]);
  return sum;
}

namespace {

/// Below this mean square of dz/ds the point is an equilibrium, which has no phase: an amplitude of 1e-8, far below any
/// first orbit.
constexpr double still = 1e-16;

/// dz/ds at the nodes.
std::vector<double> slope_at_nodes(const Collocation& e, const std::vector<double>& values) {
  const int stride = e.grid().stride();
  std::vector<double> y(static_cast<std::size_t>(e.dimension() * stride));
  std::vector<double> slope(y.size());
  e.grid().at_nodes(values.data(), y.data(), slope.data());
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j <= e.cells(); ++j)
      slope[static_cast<std::size_t>(i * stride + j)] += e.winding()[static_cast<std::size_t>(i)];
  return slope;
}

/// Into `weights`, one row of `size` numbers.
void phase_condition(const Collocation& e, const Prediction& prediction, double* weights) {
  const int stride = e.grid().stride();
  const auto size = static_cast<std::size_t>(e.size());
  const std::vector<double> slope = slope_at_nodes(e, prediction.values);
  double square = 0.0;
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j <= e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * stride + j);
      weights[n] = e.node_weights()[static_cast<std::size_t>(j)] * slope[n];
      square += weights[n] * slope[n];
    }
  for (std::size_t n = 0; n < size; ++n) weights[n] /= std::sqrt(square);
}

/// The derivative of the energy's mean over the nodes, by states and by parameters: on a family all of them have one
/// energy, and those by parameters alone differ from node to node.
void energy_condition(const Collocation& e, const Prediction& prediction, double* weights) {
  const loop::Loop loop = e.to_loop(prediction.values.data());
  const std::shared_ptr<const systems::System> system = loop::system_at(e.system(), loop);
  const int stride = e.grid().stride();
  const std::size_t nodes = static_cast<std::size_t>(e.cells()) + 1;
  const auto d = static_cast<std::size_t>(e.dimension());
  std::vector<double> z(d * static_cast<std::size_t>(stride));
  std::vector<double> slope(z.size());
  e.grid().at_nodes(prediction.values.data(), z.data(), slope.data());
  std::vector<double> states(nodes * d);
  std::vector<double> gradient(d);
  for (std::size_t j = 0; j < nodes; ++j) {
    const std::span<double> state = std::span(states).subspan(j * d, d);
    for (std::size_t i = 0; i < d; ++i)
      state[i] = z[i * static_cast<std::size_t>(stride) + j] + e.centre()[i] +
                 e.winding()[i] * static_cast<double>(j) * e.grid().spacing();
    system->conserved_gradient(0, state, gradient);
    for (std::size_t i = 0; i < d; ++i)
      weights[i * static_cast<std::size_t>(stride) + j] = e.node_weights()[j] * gradient[i];
  }
  const std::span<const double> share = std::span(e.node_weights()).first(nodes);
  for (std::size_t n = 0; n < loop.parameters.size(); ++n)
    weights[static_cast<std::size_t>(e.period_at()) + 1 + n] = energy_by_parameter(e.system(), loop, n, states, share);
}

}  // namespace

namespace {

/// No change along `direction`, in the product of steps; one row of `size` numbers.
void place_condition(const Collocation& e, const std::vector<double>& direction, double period_unit, double* weights) {
  const int stride = e.grid().stride();
  const auto size = static_cast<std::size_t>(e.size());
  const std::vector<double>& share = e.node_weights();
  double square = 0.0;
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j <= e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * stride + j);
      weights[n] = share[static_cast<std::size_t>(j)] * direction[n];
      square += weights[n] * direction[n];
    }
  const auto at_period = static_cast<std::size_t>(e.period_at());
  weights[at_period] = direction[at_period] / (period_unit * period_unit);
  square += weights[at_period] * direction[at_period];
  for (std::size_t p = at_period + 1; p <= at_period + parameters_of(e); ++p) {
    weights[p] = direction[p];
    square += weights[p] * weights[p];
  }
  for (std::size_t n = 0; n < size; ++n) weights[n] /= std::sqrt(square);
}

}  // namespace

std::vector<double> step_conditions(const Collocation& e, const Prediction& prediction, double period_unit) {
  const auto size = static_cast<std::size_t>(e.size());
  const auto at_period = static_cast<std::size_t>(e.period_at());
  std::vector<double> weights(static_cast<std::size_t>(e.borders()) * size, 0.0);
  place_condition(e, prediction.tangent, period_unit, weights.data());
  double* next = weights.data() + size;
  double* end = weights.data() + weights.size();
  if (!prediction.across.empty()) {
    end -= size;
    place_condition(e, prediction.across, period_unit, end);
  }
  using Hold = systems::FamilyScalars::Hold;
  const Hold hold = e.system().family_scalars().hold;
  if (hold == Hold::energy) energy_condition(e, prediction, next);
  if (hold == Hold::period) next[at_period] = 1.0;
  if (hold != Hold::nothing) next += size;
  if (next != end) phase_condition(e, prediction, next);
  return weights;
}

double rounding_floor(const Collocation& e, const Collocation::Quality& quality, double period) {
  return std::max(
      corrector::rounding_floor(e.grid().cutoff(), period, quality.size, quality.speed_rms, e.field_jacobian_rms()),
      nodal_rounding * quality.size * e.field_jacobian_rms());
}

void take_out_shift(const Collocation& e, Prediction& prediction, const std::vector<double>& last) {
  const int stride = e.grid().stride();
  const std::vector<double> slope = slope_at_nodes(e, last);
  const std::vector<double>& shift = slope;  // of z instead of y: near enough to move along
  double square = 0.0;
  double moved = 0.0;
  double turned = 0.0;
  for (int i = 0; i < e.dimension(); ++i)
    for (int j = 0; j <= e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * stride + j);
      const double weight = e.node_weights()[static_cast<std::size_t>(j)] * slope[n];
      square += weight * shift[n];
      moved += weight * (prediction.values[n] - last[n]);
      turned += weight * prediction.tangent[n];
    }
  if (!(square > still)) return;
  for (std::size_t n = 0; n < shift.size(); ++n) {
    prediction.values[n] -= moved / square * shift[n];
    prediction.tangent[n] -= turned / square * shift[n];
  }
}

bool is_upside_down(const Collocation& e, const std::vector<double>& a, const std::vector<double>& b) {
  double product = 0.0;
  for (int i = 0; i < e.dimension(); ++i) {
    double sum_a = 0.0;
    double sum_b = 0.0;
    double sum_ab = 0.0;
    for (int j = 0; j <= e.cells(); ++j) {
      const auto n = static_cast<std::size_t>(i * e.grid().stride() + j);
      const double share = e.node_weights()[static_cast<std::size_t>(j)];
      sum_a += share * a[n];
      sum_b += share * b[n];
      sum_ab += share * a[n] * b[n];
    }
    product += e.keeps_mean(i) ? sum_ab - sum_a * sum_b : sum_ab;
  }
  return product < 0.0;
}

}  // namespace orbweaver::continuation
