#include "orbweaver/loop/grid/fourier.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fftw3.h>

#include "grid/known_plans.hpp"
#include "grid/long_transform.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"

namespace orbweaver::loop {

struct FourierGrid::Plans {
  double* real = nullptr;
  fftw_complex* complex = nullptr;
  fftw_plan forward = nullptr;
  fftw_plan backward = nullptr;

  // Each is made when it is first needed: planning takes a millisecond where the plan is not known. FFTW_ESTIMATE
  // leaves the arrays alone.
  void transform_forward(int nodes) {
    if (nodes >= long_transform) core::interruption_point();
    if (forward == nullptr) {
      recall_plans(nodes);
      forward = fftw_plan_dft_r2c_1d(nodes, real, complex, FFTW_ESTIMATE);
    }
    fftw_execute(forward);
  }
  void transform_backward(int nodes) {
    if (nodes >= long_transform) core::interruption_point();
    if (backward == nullptr) {
      recall_plans(nodes);
      backward = fftw_plan_dft_c2r_1d(nodes, complex, real, FFTW_ESTIMATE);
    }
    fftw_execute(backward);
  }
};

namespace {

bool has_small_factors(int n) {
  for (const int p : {2, 3, 5, 7})
    while (n % p == 0) n /= p;
  return n == 1;
}

}  // namespace

FourierGrid::FourierGrid(int nodes) : _nodes(nodes), _plans(std::make_unique<Plans>()) {
  const auto n = static_cast<std::size_t>(nodes);
  _plans->real = fftw_alloc_real(n);
  _plans->complex = fftw_alloc_complex(n / 2 + 1);
}

FourierGrid::~FourierGrid() {
  if (_plans->forward != nullptr) fftw_destroy_plan(_plans->forward);
  if (_plans->backward != nullptr) fftw_destroy_plan(_plans->backward);
  fftw_free(_plans->real);
  fftw_free(_plans->complex);
}

const FourierGrid& FourierGrid::of_size(int nodes) {
  core::require(nodes >= 2, "a Fourier grid needs at least two nodes");
  static std::map<int, std::unique_ptr<FourierGrid>> grids;
  std::unique_ptr<FourierGrid>& grid = grids[nodes];
  if (!grid) grid.reset(new FourierGrid(nodes));
  return *grid;
}

int FourierGrid::nodes_for(int cutoff) {
  core::require(cutoff >= 1, "a loop needs a cutoff of at least one harmonic");
  return nodes_at_least(2 * (2 * cutoff + 1));
}

int FourierGrid::nodes_at_least(int least) {
  int nodes = std::max(2, least + least % 2);
  while (!has_small_factors(nodes)) nodes += 2;
  return nodes;
}

void FourierGrid::synthesize(int cutoff, int dimension, const double* modes, double* nodal) const {
  core::require(2 * cutoff < _nodes, "too few nodes for this cutoff");
  const auto n = static_cast<std::size_t>(_nodes);
  const auto d = static_cast<std::size_t>(dimension);
  for (std::size_t i = 0; i < d; ++i) {
    std::fill_n(&_plans->complex[0][0], 2 * (n / 2 + 1), 0.0);
    _plans->complex[0][0] = modes[i];
    for (int k = 1; k <= cutoff; ++k) {
      const auto kk = static_cast<std::size_t>(k);
      _plans->complex[kk][0] = 0.5 * modes[(2 * kk - 1) * d + i];
      _plans->complex[kk][1] = -0.5 * modes[2 * kk * d + i];
    }
    _plans->transform_backward(_nodes);
    std::copy_n(_plans->real, n, nodal + i * n);
  }
}

void FourierGrid::synthesize_derivative(int cutoff, int dimension, const double* modes, double* nodal) const {
  core::require(2 * cutoff < _nodes, "too few nodes for this cutoff");
  const auto n = static_cast<std::size_t>(_nodes);
  const auto d = static_cast<std::size_t>(dimension);
  for (std::size_t i = 0; i < d; ++i) {
    std::fill_n(&_plans->complex[0][0], 2 * (n / 2 + 1), 0.0);
    for (int k = 1; k <= cutoff; ++k) {
      const auto kk = static_cast<std::size_t>(k);
      _plans->complex[kk][0] = 0.5 * k * modes[2 * kk * d + i];
      _plans->complex[kk][1] = 0.5 * k * modes[(2 * kk - 1) * d + i];
    }
    _plans->transform_backward(_nodes);
    std::copy_n(_plans->real, n, nodal + i * n);
  }
}

void FourierGrid::sums(const double* g, int highest, double* cosines, double* sines) const {
  core::require(2 * highest <= _nodes, "a grid has no sums beyond half its nodes");
  std::copy_n(g, static_cast<std::size_t>(_nodes), _plans->real);
  _plans->transform_forward(_nodes);
  for (int m = 0; m <= highest; ++m) {
    cosines[m] = _plans->complex[m][0];
    sines[m] = -_plans->complex[m][1];
  }
}

void FourierGrid::analyze(int cutoff, int dimension, const double* nodal, double* modes) const {
  core::require(2 * cutoff < _nodes, "too few nodes for this cutoff");
  const auto d = static_cast<std::size_t>(dimension);
  const auto n = static_cast<std::size_t>(_nodes);
  for (std::size_t i = 0; i < d; ++i) {
    std::copy_n(nodal + i * n, n, _plans->real);
    _plans->transform_forward(_nodes);
    modes[i] = _plans->complex[0][0] / _nodes;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(cutoff); ++k) {
      modes[(2 * k - 1) * d + i] = 2.0 * _plans->complex[k][0] / _nodes;
      modes[2 * k * d + i] = -2.0 * _plans->complex[k][1] / _nodes;
    }
  }
}

}  // namespace orbweaver::loop
