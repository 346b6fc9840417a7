#pragma once

#include <algorithm>
#include <vector>

#include "box_blocks.hpp"

namespace orbweaver::equations {

/// The elimination of one node from two relations, (first, y_j, ..) and (.., y_j, next): a QR by Householder
/// reflections of the 2 d x d matrix of what stands before y_j.
template <class Scalar, int Packets>
class BoxReduction : private BoxBlocks<Scalar, Packets> {
  using Blocks = BoxBlocks<Scalar, Packets>;
  using Blocks::d, Blocks::n, Blocks::square, Blocks::each, Blocks::scalars, Blocks::products, Blocks::total,
      Blocks::width;

 public:
  explicit BoxReduction(int dimension)
      : Blocks(dimension), _panel(at(6 * square())), _reflectors(at(2 * square())), _reflections(at(d())) {}

  /// With Q R = (above, below): invert (d x 2 d) is R^-1 of the first rows of Q', keep its other rows. All of d rows,
  /// by columns.
  void run(const Packet* above, const Packet* below, Packet* invert, Packet* keep) {
    for (int b = 0; b < d(); ++b) {
      std::copy_n(above + b * n(), n(), column(b));
      std::copy_n(below + b * n(), n(), column(b) + n());
    }
    std::fill(column(d()), column(0) + 6 * square(), Packet{});
    for (int b = 0; b < 2 * d(); ++b) scalars(column(d() + b) + b / d() * n())[b % d()] += 1.0;
    reduce();
    int b = 0;
    for (; b + 4 <= 2 * d(); b += 4) take<4>(b, invert, keep);
    if (b < 2 * d()) take<2>(b, invert, keep);
  }

 private:
  static constexpr int lanes = BoxScheme::lanes;

  /// A Householder reflection of the entries from c on of columns of 2 d numbers, each half in n packets.
  struct Reflection {
    Scalar scale;
    Scalar pivot;  // 1 / R(c, c)
  };
  [[nodiscard]] Packet* reflector(int c) { return &_reflectors[at(2 * c * n())]; }
  [[nodiscard]] Packet* column(int b) { return &_panel[at(2 * b * n())]; }
  /// So many columns at once, one behind the other: their sums do not wait for each other.
  template <int Count>
  [[gnu::always_inline]] void reflect(int c, Packet* columns) {
    const int length = 2 * n();
    const Packet* v = reflector(c);
    Packet sums[Count] = {};
    for (int a = c * width / lanes; a < length; ++a)
      for (int b = 0; b < Count; ++b) sums[b] += v[a] * columns[b * length + a];
    Scalar parts[Count];
    for (int b = 0; b < Count; ++b) parts[b] = _reflections[at(c)].scale * total(sums[b]);
    for (int a = c * width / lanes; a < length; ++a)
      for (int b = 0; b < Count; ++b) columns[b * length + a] -= v[a] * parts[b];
  }
  /// The columns from b on, up to the last of `_panel`.
  [[gnu::always_inline]] void reflect_from(int b, int c) {
    for (; b + 4 <= 3 * d(); b += 4) reflect<4>(c, column(b));
    switch (3 * d() - b) {
      case 3: reflect<3>(c, column(b)); break;
      case 2: reflect<2>(c, column(b)); break;
      case 1: reflect<1>(c, column(b)); break;
      default: break;
    }
  }
  /// QR of the first d columns of `_panel`: R above the diagonal there, zeros elsewhere in its packets, Q' behind.
  void reduce() {
    each([&](auto c) {
      Packet* v = reflector(c);
      std::copy_n(column(c), 2 * n(), v);
      std::fill_n(scalars(v), c, Scalar{});
      std::fill(scalars(column(c)) + c, scalars(column(c) + n()), Scalar{});
      Scalar& first = scalars(v)[c];
      const Scalar norm = square_root(total(products(v, v, 2 * n())));
      const Scalar alpha = first > 0.0 ? -norm : norm;
      _reflections[at(c)] = {1.0 / (alpha * (alpha - first)), 1.0 / alpha};
      first -= alpha;
      reflect_from(c + 1, c);
    });
  }
  /// So many columns, from b on.
  template <int Count>
  void take(int b, Packet* invert, Packet* keep) {
    const int length = 2 * n();
    Packet* q = column(d() + b);
    each([&](auto c) {
      const int a = d() - 1 - c;
      const Packet* r = column(a);
      Scalar x[Count];
      for (int k = 0; k < Count; ++k) x[k] = scalars(q + k * length)[a] *= _reflections[at(a)].pivot;
      for (int i = 0; i * lanes < a * width; ++i)
        for (int k = 0; k < Count; ++k) q[k * length + i] -= r[i] * x[k];
    });
    for (int k = 0; k < Count; ++k) {
      std::copy_n(q + k * length, n(), invert + (b + k) * n());
      std::copy_n(q + k * length + n(), n(), keep + (b + k) * n());
    }
  }

  std::vector<Packet> _panel;       // of 3 d columns: the matrix, and the identity that becomes Q'
  std::vector<Packet> _reflectors;  // of d columns
  std::vector<Reflection> _reflections;
};

}  // namespace orbweaver::equations
