#pragma once

#include <cstddef>

#include "orbweaver/ad/lanes.hpp"

namespace orbweaver::spectrum {

/// Square matrices of size D (0: of a size given at run time), row by row, several side by side in the lanes of
/// registers. Results may not overlap what they are made of unless said.
template <std::size_t D>
class LaneMatrices {
 public:
  using Lanes = ad::Lanes;

  explicit LaneMatrices(std::size_t dimension) : _dimension(dimension) {}
  [[nodiscard]] std::size_t dimension() const { return D == 0 ? _dimension : D; }
  [[nodiscard]] std::size_t size() const { return dimension() * dimension(); }

  void set_identity(Lanes* a) const {
    const std::size_t d = dimension();
    for (std::size_t n = 0; n < d * d; ++n) a[n] = 0.0;
    for (std::size_t n = 0; n < d; ++n) a[n * d + n] = 1.0;
  }

  /// c = a b.
  void multiply(const Lanes* a, const Lanes* b, Lanes* c) const {
    const std::size_t d = dimension();
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t l = 0; l < d; ++l) {
        Lanes sum = a[i * d] * b[l];
        for (std::size_t m = 1; m < d; ++m) sum += a[i * d + m] * b[m * d + l];
        c[i * d + l] = sum;
      }
  }
  /// c += a b.
  void add_product(const Lanes* a, const Lanes* b, Lanes* c) const {
    const std::size_t d = dimension();
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t l = 0; l < d; ++l) {
        Lanes sum = c[i * d + l];
        for (std::size_t m = 0; m < d; ++m) sum += a[i * d + m] * b[m * d + l];
        c[i * d + l] = sum;
      }
  }
  /// y = a x.
  void apply(const Lanes* a, const Lanes* x, Lanes* y) const {
    const std::size_t d = dimension();
    for (std::size_t i = 0; i < d; ++i) {
      Lanes sum = a[i * d] * x[0];
      for (std::size_t m = 1; m < d; ++m) sum += a[i * d + m] * x[m];
      y[i] = sum;
    }
  }
  /// The inverse in place, without exchange of rows: for matrices near the identity, in whatever units the coordinates
  /// are (a diagonal scaling changes no pivot).
  void invert(Lanes* a) const {
    const std::size_t d = dimension();
    for (std::size_t k = 0; k < d; ++k) {
      const Lanes pivot = 1.0 / a[k * d + k];
      a[k * d + k] = 1.0;
      for (std::size_t l = 0; l < d; ++l) a[k * d + l] *= pivot;
      for (std::size_t i = 0; i < d; ++i) {
        if (i == k) continue;
        const Lanes factor = a[i * d + k];
        a[i * d + k] = 0.0;
        for (std::size_t l = 0; l < d; ++l) a[i * d + l] -= factor * a[k * d + l];
      }
    }
  }

 private:
  std::size_t _dimension;
};

}  // namespace orbweaver::spectrum
