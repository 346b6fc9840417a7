// Field evaluation: ns a node, one scalar at a time and in lanes, over the nodes of a loop.
#include <cmath>
#include <random>

#include <benchmark/benchmark.h>

#include "support/dual_derivatives.hpp"
#include "orbweaver/systems/registry.hpp"
#include "orbweaver/systems/system.hpp"

namespace orbweaver::benchmarks {

namespace {

constexpr std::size_t nodes = 256;

const std::vector<double>& states() {
  static const std::vector<double> z = [] {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(-3.0, 3.0);
    std::vector<double> out(4 * nodes);
    for (double& x : out) x = uniform(generator);
    return out;
  }();
  return z;
}

// The double pendulum with unit parameters, as a model writes it.
struct UnitPendulum {
  template <class S>
  void operator()(const S* z, S* f) const {
    using std::cos;
    using std::sin;
    const S d = z[0] - z[1];
    const S sin_d = sin(d);
    const S cos_d = cos(d);
    const S share = S(1.0) / (sin_d * sin_d + 1.0);
    const S sin_1 = sin(z[0]);
    const S sin_2 = sin(z[1]);
    const S swing_1 = z[2] * z[2];
    const S swing_2 = z[3] * z[3];
    f[0] = z[2];
    f[1] = z[3];
    f[2] = (sin_2 * cos_d - sin_1 * 2.0 - sin_d * (swing_1 * cos_d + swing_2)) * share;
    f[3] = ((sin_1 * cos_d - sin_2) * 2.0 + sin_d * (swing_1 * 2.0 + swing_2 * cos_d)) * share;
  }
};

void report(benchmark::State& state) {
  state.counters["per_node"] = benchmark::Counter(
      static_cast<double>(nodes), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void gather(std::size_t j, double* z) {
  for (std::size_t i = 0; i < 4; ++i) z[i] = states()[i * nodes + j];
}

void field_scalar(benchmark::State& state) {
  double z[4];
  double f[4];
  for (auto _ : state)
    for (std::size_t j = 0; j < nodes; ++j) {
      gather(j, z);
      UnitPendulum{}(z, f);
      benchmark::DoNotOptimize(f);
    }
  report(state);
}

void field_jacobian_scalar(benchmark::State& state) {
  double z[4];
  for (auto _ : state)
    for (std::size_t j = 0; j < nodes; ++j) {
      gather(j, z);
      benchmark::DoNotOptimize(ad::field_jacobian<4>(UnitPendulum{}, z));
    }
  report(state);
}

void second_derivatives_scalar(benchmark::State& state) {
  double z[4];
  for (auto _ : state)
    for (std::size_t j = 0; j < nodes; ++j) {
      gather(j, z);
      benchmark::DoNotOptimize(ad::second_derivatives<4>(UnitPendulum{}, z, z));
    }
  report(state);
}

template <class Evaluate>
void nodal(benchmark::State& state, const Evaluate& evaluate) {
  const auto system = systems::make_system("double_pendulum");
  std::vector<double> f(4 * nodes);
  std::vector<double> matrices(16 * nodes);
  for (auto _ : state) {
    evaluate(*system, f.data(), matrices.data());
    benchmark::ClobberMemory();
  }
  report(state);
}

void field_lanes(benchmark::State& state) {
  nodal(state, [](const systems::System& s, double* f, double*) { s.field(nodes, states().data(), f); });
}
void field_jacobian_lanes(benchmark::State& state) {
  nodal(state, [](const systems::System& s, double* f, double* m) { s.field_jacobian(nodes, states().data(), f, m); });
}
void second_derivatives_lanes(benchmark::State& state) {
  nodal(state, [](const systems::System& s, double*, double* m) {
    s.second_derivatives(nodes, states().data(), states().data(), m);
  });
}
void energy_gradients_lanes(benchmark::State& state) {
  nodal(state,
        [](const systems::System& s, double* f, double*) { s.conserved_gradients(0, nodes, states().data(), f); });
}

template <class Function>
void wave_lanes(benchmark::State& state, const Function& function) {
  double out[nodes];
  for (auto _ : state) {
    for (std::size_t j = 0; j < nodes; j += ad::Lanes::width)
      function(ad::Lanes::load(&states()[j], ad::Lanes::width)).store(&out[j], ad::Lanes::width);
    benchmark::DoNotOptimize(out);
  }
  report(state);
}
void sine_lanes(benchmark::State& state) {
  wave_lanes(state, [](ad::Lanes x) { return sin(x); });
}
void sine_and_cosine_lanes(benchmark::State& state) {
  wave_lanes(state, [](ad::Lanes x) { return sin(x) + cos(x); });
}

BENCHMARK(field_scalar);
BENCHMARK(field_lanes);
BENCHMARK(field_jacobian_scalar);
BENCHMARK(field_jacobian_lanes);
BENCHMARK(second_derivatives_scalar);
BENCHMARK(second_derivatives_lanes);
BENCHMARK(energy_gradients_lanes);
BENCHMARK(sine_lanes);
BENCHMARK(sine_and_cosine_lanes);

}  // namespace

}  // namespace orbweaver::benchmarks
