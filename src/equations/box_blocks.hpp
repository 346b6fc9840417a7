#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "box_scheme.hpp"
#include "index.hpp"

namespace orbweaver::equations {

/// What a SIMD register holds.
using Packet = double __attribute__((vector_size(BoxScheme::lanes * sizeof(double))));

inline double square_root(double v) { return std::sqrt(v); }
inline Packet square_root(Packet v) {
  Eigen::Map<Eigen::Array<double, BoxScheme::lanes, 1>> numbers(reinterpret_cast<double*>(&v));
  numbers = numbers.sqrt();
  return v;
}
inline double sum_of(const Packet& v) { return (v[0] + v[2]) + (v[1] + v[3]); }

/// Vectors of d numbers and matrices of d rows as rows of packets, the same for both storages of a BoxScheme. `Scalar`
/// is a Packet of one number of each of four stretches, or a double. A vector, or a column of a matrix, is one packet a
/// coordinate with lanes, four coordinates in each without, the last filled up with zeros. `Packets`: so many a vector,
/// 0 where that is known at run time.
template <class Scalar, int Packets>
class BoxBlocks {
 public:
  explicit BoxBlocks(int dimension) : _dimension(dimension) {}

  static constexpr int width = sizeof(Scalar) / sizeof(double);

  [[nodiscard]] int d() const { return Packets > 0 && width > 1 ? Packets : _dimension; }
  /// Packets of a vector, and of a matrix of d columns.
  [[nodiscard]] int n() const {
    return Packets > 0 ? Packets : (_dimension * width + BoxScheme::lanes - 1) / BoxScheme::lanes;
  }
  [[nodiscard]] int square() const { return d() * n(); }

  using Vector = std::conditional_t<(Packets > 0), std::array<Packet, at(std::max(Packets, 1))>, std::vector<Packet>>;
  [[nodiscard]] Vector vector() const {
    if constexpr (Packets > 0)
      return Vector{};
    else
      return Vector(at(n()));
  }
  static Scalar* scalars(Packet* v) { return reinterpret_cast<Scalar*>(v); }
  static const Scalar* scalars(const Packet* v) { return reinterpret_cast<const Scalar*>(v); }
  /// Coordinate i in stretch l.
  static double& number(Packet* v, int i, int l) { return reinterpret_cast<double*>(v)[i * width + l]; }
  static double number(const Packet* v, int i, int l) { return reinterpret_cast<const double*>(v)[i * width + l]; }

  /// Of every coordinate, known to the compiler where d is.
  template <class Function>
  void each(Function function) const {
    if constexpr (Packets > 0 && width > 1) [&]<int... c>(std::integer_sequence<int, c...>) {
        (function(std::integral_constant<int, c>{}), ...);
      }
    (std::make_integer_sequence<int, Packets>{});
    else for (int c = 0; c < d(); ++c) function(c);
  }

  /// sum += matrix v.
  void add(const Packet* __restrict matrix, const Packet* __restrict vector, Packet* __restrict sum) const {
    const Scalar* v = scalars(vector);
    int l = 0;
    if constexpr (Packets == 0)
      for (; l + 4 <= d(); l += 4) {
        const Packet* a = matrix + l * n();
        for (int i = 0; i < n(); ++i)
          sum[i] += (a[i] * v[l] + a[n() + i] * v[l + 1]) + (a[2 * n() + i] * v[l + 2] + a[3 * n() + i] * v[l + 3]);
      }
    for (; l < d(); ++l)
      for (int i = 0; i < n(); ++i) sum[i] += matrix[l * n() + i] * v[l];
  }
  /// out = matrix (carried, here), the matrix with 2 d columns. What does not wait for the step before comes first.
  void combine(const Packet* matrix, const Packet* carried, const Packet* here, Packet* out) const {
    Vector sum = vector();
    add(matrix + square(), here, sum.data());
    add(matrix, carried, sum.data());
    std::copy_n(sum.data(), n(), out);
  }
  /// out (d columns) = matrix times block.
  void multiply(const Packet* matrix, const Packet* block, Packet* out) const {
    for (int b = 0; b < d(); ++b) {
      Vector sum = vector();
      add(matrix, block + b * n(), sum.data());
      std::copy_n(sum.data(), n(), out + b * n());
    }
  }
  static Packet products(const Packet* a, const Packet* b, int count) {
    Packet sum = a[0] * b[0];
    for (int i = 1; i < count; ++i) sum += a[i] * b[i];
    return sum;
  }
  static Scalar total(const Packet& v) {
    if constexpr (width > 1)
      return v;
    else
      return sum_of(v);
  }
  /// out -= matrix' v.
  void subtract_transposed(const Packet* matrix, const Packet* v, Packet* out) const {
    for (int b = 0; b < d(); ++b) scalars(out)[b] -= total(products(matrix + b * n(), v, n()));
  }

 private:
  int _dimension;
};

}  // namespace orbweaver::equations
