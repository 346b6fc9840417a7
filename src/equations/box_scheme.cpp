#include "box_scheme.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "condensed_box.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::equations {

namespace {

/// What a SIMD register holds.
using Packet = double __attribute__((vector_size(BoxScheme::lanes * sizeof(double))));

double square_root(double v) { return std::sqrt(v); }
Packet square_root(Packet v) {
  for (int l = 0; l < BoxScheme::lanes; ++l) v[l] = std::sqrt(v[l]);
  return v;
}
double sum_of(const Packet& v) { return (v[0] + v[2]) + (v[1] + v[3]); }

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The elimination, the same for both storages. `Scalar` is a Packet of one number of each of four stretches, or a
/// double. A vector (d numbers) or a column of a matrix is a row of packets: one a coordinate with lanes, four
/// coordinates in each without, the last filled up with zeros. `Packets`: so many a vector, 0 where that is known at
/// run time.
template <class Scalar, int Packets>
class Elimination final : public BoxScheme {
 public:
  explicit Elimination(int dimension) : _dimension(dimension) {}

  void factor(const Matrices& m, core::Team* team) override {
    core::require(m.borders <= most_borders, "more borders than the box scheme is made for");
    core::require(m.count % width == 0, "the cells of a domain must fill the lanes of the box scheme");
    _team = team != nullptr && team->size() > m.cells ? nullptr : team;
    _cells = m.cells;
    _first_cell = m.first;
    _length = m.count / width;
    _borders = m.borders;
    _stride = m.stride;
    _closed = m.left.size() == 0;
    _steps.resize(at(_length * 6 * square()));
    _border_steps.resize(at(_length * _borders * 2 * n()));
    _solved.assign(at(_length * n()), Packet{});
    _packed.assign(at(_length * n()), Packet{});
    eliminate(m);
    condense(m);
  }

  void solve(double* x) const override {
    pack(x);
    Vector left_over = vector();
    Packet inner[most_borders] = {};
    forward(left_over.data(), inner);
    const int own = width * d();
    double* mine = own_part(_ends, own + _borders);
    take_apart(left_over.data(), mine);
    for (int p = 0; p < _borders; ++p) mine[own + p] = given_border(x, p) - sum_of(inner[p]);
    exchange("box scheme: what a stretch leaves", own + _borders, _ends);
    for (int k = 0; k < members(); ++k)
      std::copy_n(_ends.data() + k * (own + _borders), own, _condensate.data() + k * own);
    for (int i = 0; i < d() && !_closed; ++i) _condensate[at(members() * own + i)] = x[end_of(i)];
    gather_borders(own);
    _condensed.solve(_condensate);
    backward();
    unpack(x);
  }

  // `solve` backwards, each of its assignments transposed.
  void solve_transposed(double* x) const override {
    pack(x);
    Vector left = vector();
    Vector right = vector();
    Packet inner[most_borders] = {};
    forward_transposed(left.data(), right.data(), inner);
    const int half = width * d();
    const int own = 2 * half;
    double* mine = own_part(_ends, own + _borders);
    take_apart(left.data(), mine);
    take_apart(right.data(), mine + half);
    for (int p = 0; p < _borders; ++p) mine[own + p] = given_border(x, p) - sum_of(inner[p]);
    exchange("box scheme: what a stretch leaves, transposed", own + _borders, _ends);
    std::fill(_condensate.begin(), _condensate.end(), 0.0);
    for (int i = 0; i < d() && !_closed; ++i) _condensate[at(members() * half + i)] = x[end_of(i)];
    for (int k = 0; k < members() * width; ++k) {
      const double* from = _ends.data() + k / width * (own + _borders) + k % width * d();
      for (int i = 0; i < d(); ++i) {
        _condensate[at(node(k) + i)] += from[i];
        _condensate[at(node(k + 1) + i)] += from[half + i];
      }
    }
    gather_borders(own);
    _condensed.solve_transposed(_condensate);
    backward_transposed();
    unpack(x);
  }

 private:
  static constexpr int width = sizeof(Scalar) / sizeof(double);

  [[nodiscard]] int d() const { return Packets > 0 && width > 1 ? Packets : _dimension; }
  /// Packets of a vector, and of a matrix of d columns.
  [[nodiscard]] int n() const { return Packets > 0 ? Packets : (_dimension * width + lanes - 1) / lanes; }
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

  /// y_j = invert (carried, here) - to_left y_left - to_next y_(j+1) - to_border p, and what is carried on is
  /// keep (carried, here).
  struct Step {
    Packet* invert;
    Packet* keep;
    Packet* to_left;
    Packet* to_next;
  };
  [[nodiscard]] Step step(int j) const {
    Packet* s = _steps.data() + static_cast<std::ptrdiff_t>(j) * 6 * square();
    return {s, s + 2 * square(), s + 4 * square(), s + 5 * square()};
  }
  [[nodiscard]] Packet* to_border(int j, int p) const { return &_border_steps[at((j * _borders + p) * 2 * n())]; }
  /// Of y_j in a border row, after earlier nodes of the stretch were eliminated.
  [[nodiscard]] Packet* weight(int j, int q) const { return to_border(j, q) + n(); }

  // --- small products ---

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

  // --- the team ---

  [[nodiscard]] int members() const { return _team != nullptr ? _team->size() : 1; }
  [[nodiscard]] int member() const { return _team != nullptr ? _team->rank() : 0; }
  /// This member's part of `values`, so many a member.
  double* own_part(std::vector<double>& values, int each) const {
    values.resize(at(members() * each));
    return values.data() + member() * each;
  }
  void exchange(const char* place, int each, std::vector<double>& values) const {
    if (_team != nullptr) _team->divide(place, members(), each, values.data(), [](int, int) {});
  }
  /// Where the first node of stretch k of all, or its relation, stands in the condensed system.
  [[nodiscard]] int node(int k) const { return k % _condensed.nodes() * d(); }
  [[nodiscard]] int own_node(int l) const { return node(member() * width + l); }
  [[nodiscard]] int border_at() const { return _condensed.nodes() * d(); }
  [[nodiscard]] std::ptrdiff_t end_of(int i) const { return static_cast<std::ptrdiff_t>(i) * _stride + _cells; }
  [[nodiscard]] double* border_of(double* x) const { return x + static_cast<std::ptrdiff_t>(d()) * _stride; }

  /// The first member has the right-hand sides of the border rows.
  [[nodiscard]] double given_border(double* x, int p) const { return member() == 0 ? border_of(x)[p] : 0.0; }
  void gather_borders(int own) const {
    for (int p = 0; p < _borders; ++p) {
      double sum = _ends[at(own + p)];
      for (int k = 1; k < members(); ++k) sum += _ends[at(k * (own + _borders) + own + p)];
      _condensate[at(border_at() + p)] = sum;
    }
  }

  // --- nodal values: coordinate after coordinate outside, node after node here ---

  void take_apart(const Packet* v, double* out) const {
    for (int l = 0; l < width; ++l)
      for (int i = 0; i < d(); ++i) out[l * d() + i] = number(v, i, l);
  }
  void pack(const double* x) const {
    for (int i = 0; i < d(); ++i) {
      const double* from = x + static_cast<std::ptrdiff_t>(i) * _stride + _first_cell;
      for (int j = 0; j < _length; ++j) scalars(&_packed[at(j * n())])[i] = side_by_side(from + j);
    }
  }
  void unpack(double* x) const {
    for (int i = 0; i < d(); ++i) {
      double* to = x + static_cast<std::ptrdiff_t>(i) * _stride + _first_cell;
      for (int j = 0; j < _length; ++j)
        for (int l = 0; l < width; ++l) to[l * _length + j] = number(&_packed[at(j * n())], i, l);
      if (!_closed) x[end_of(i)] = _condensate[at(members() * width * d() + i)];
    }
    for (int p = 0; p < _borders; ++p) border_of(x)[p] = _condensate[at(border_at() + p)];
    if (_team != nullptr) exchange_nodes(x);
  }
  void exchange_nodes(double* x) const {
    std::vector<double> nodes(at(d() * _cells));
    const auto entry = [&](int i, int j) -> double& { return x[static_cast<std::ptrdiff_t>(i) * _stride + j]; };
    _team->divide("box scheme: solution", _cells, d(), nodes.data(), [&](int begin, int end) {
      for (int j = begin; j < end; ++j)
        for (int i = 0; i < d(); ++i) nodes[at(j * d() + i)] = entry(i, j);
    });
    for (int j = 0; j < _cells; ++j)
      for (int i = 0; i < d(); ++i) entry(i, j) = nodes[at(j * d() + i)];
  }
  /// One number of each stretch.
  [[nodiscard]] Scalar side_by_side(const double* first) const {
    if constexpr (width > 1)
      return Packet{first[0], first[_length], first[2 * _length], first[3 * _length]};
    else
      return *first;
  }

  // --- solves ---

  void forward(Packet* left_over, Packet* inner) const {
    Vector carried = vector();
    std::copy_n(_packed.data(), n(), carried.data());
    for (int j = 1; j < _length; ++j) {
      const Step s = step(j);
      const Packet* here = &_packed[at(j * n())];
      Packet* solved = &_solved[at(j * n())];
      combine(s.invert, carried.data(), here, solved);
      combine(s.keep, carried.data(), here, carried.data());
      for (int p = 0; p < _borders; ++p) inner[p] += products(weight(j, p), solved, n());
    }
    std::copy_n(carried.data(), n(), left_over);
  }

  void backward() const {
    Vector left = vector();
    Vector right = vector();
    for (int l = 0; l < width; ++l)
      for (int i = 0; i < d(); ++i) {
        number(left.data(), i, l) = -_condensate[at(own_node(l) + i)];
        number(right.data(), i, l) = -_condensate[at(own_node(l + 1) + i)];
      }
    for (int j = _length - 1; j >= 1; --j) {
      const Step s = step(j);
      Vector y = vector();
      std::copy_n(&_solved[at(j * n())], n(), y.data());
      for (int p = 0; p < _borders; ++p)
        for (int i = 0; i < n(); ++i) y[at(i)] -= to_border(j, p)[i] * _condensate[at(border_at() + p)];
      add(s.to_left, left.data(), y.data());
      add(s.to_next, right.data(), y.data());
      std::copy_n(y.data(), n(), &_packed[at(j * n())]);
      for (int i = 0; i < n(); ++i) right[at(i)] = -y[at(i)];
    }
    for (int i = 0; i < n(); ++i) _packed[at(i)] = -left[at(i)];
  }

  void forward_transposed(Packet* left, Packet* right, Packet* inner) const {
    std::copy_n(_packed.data(), n(), left);
    for (int j = 1; j < _length; ++j) {
      const Step s = step(j);
      Packet* y = &_solved[at(j * n())];
      for (int i = 0; i < n(); ++i) y[i] = _packed[at(j * n() + i)] + right[i];
      std::fill_n(right, n(), Packet{});
      subtract_transposed(s.to_left, y, left);
      subtract_transposed(s.to_next, y, right);
      for (int p = 0; p < _borders; ++p) inner[p] += products(to_border(j, p), y, n());
    }
  }

  void backward_transposed() const {
    Vector carried = vector();
    Vector solved = vector();
    Vector before = vector();
    for (int l = 0; l < width; ++l)
      for (int i = 0; i < d(); ++i) number(carried.data(), i, l) = _condensate[at((member() * width + l) * d() + i)];
    for (int j = _length - 1; j >= 1; --j) {
      const Step s = step(j);
      std::copy_n(&_solved[at(j * n())], n(), solved.data());
      for (int p = 0; p < _borders; ++p)
        for (int i = 0; i < n(); ++i) solved[at(i)] -= weight(j, p)[i] * _condensate[at(border_at() + p)];
      const auto back = [&](int column) {
        return total(products(s.invert + column * n(), solved.data(), n()) +
                     products(s.keep + column * n(), carried.data(), n()));
      };
      for (int b = 0; b < d(); ++b) {
        scalars(before.data())[b] = back(b);
        scalars(&_packed[at(j * n())])[b] = back(d() + b);
      }
      carried = before;
    }
    std::copy_n(carried.data(), n(), _packed.data());
  }

  // --- elimination ---

  /// w (y_(j+1) - y_j) - (B_j / 2) (y_j + y_(j+1)) = here y_j + ahead y_(j+1).
  void load_blocks(const Matrices& m, int j, Packet* here, Packet* ahead) const {
    for (int b = 0; b < d(); ++b) {
      Scalar* on_here = scalars(here + b * n());
      Scalar* on_ahead = scalars(ahead + b * n());
      for (int i = 0; i < d(); ++i)
        on_here[i] = on_ahead[i] =
            -0.5 * side_by_side(m.blocks + static_cast<std::ptrdiff_t>(i * d() + b) * m.count + j);
      on_here[b] -= m.difference;
      on_ahead[b] += m.difference;
    }
  }
  /// Border p's numbers at a cell or node.
  void load(const double* from, int stride, int p, Packet* out) const {
    for (int i = 0; i < d(); ++i)
      scalars(out)[i] = side_by_side(from + static_cast<std::ptrdiff_t>(p * d() + i) * stride);
  }

  /// A Householder reflection of the entries from c on of columns of 2 d numbers, each half in n packets.
  struct Reflection {
    Scalar scale;
    Scalar pivot;  // 1 / R(c, c)
  };
  [[nodiscard]] Packet* reflector(int c) { return &_reflectors[at(2 * c * n())]; }
  /// So many columns at once, one behind the other: their sums do not wait for each other.
  template <int Count>
  void reflect(int c, Packet* columns) {
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
  /// QR of the d columns of `_panel`: reflectors, and R above the diagonal there, zeros elsewhere in its packets.
  void reduce() {
    for (int c = 0; c < d(); ++c) {
      Packet* column = &_panel[at(2 * c * n())];
      Packet* v = reflector(c);
      std::copy_n(column, 2 * n(), v);
      std::fill_n(scalars(v), c, Scalar{});
      std::fill(scalars(column) + c, scalars(column + n()), Scalar{});
      Scalar& first = scalars(v)[c];
      const Scalar norm = square_root(total(products(v, v, 2 * n())));
      const Scalar alpha = first > 0.0 ? -norm : norm;
      _reflections[at(c)] = {1.0 / (alpha * (alpha - first)), 1.0 / alpha};
      first -= alpha;
      int b = c + 1;
      for (; b + 4 <= d(); b += 4) reflect<4>(c, &_panel[at(2 * b * n())]);
      for (; b < d(); ++b) reflect<1>(c, &_panel[at(2 * b * n())]);
    }
  }
  /// Columns from b on of invert = R^-1 (first rows of Q') and of keep, the other rows.
  template <int Count>
  void invert(int b, const Step& s) {
    const int length = 2 * n();
    Packet* q = _columns.data();
    std::fill_n(q, Count * length, Packet{});
    for (int k = 0; k < Count; ++k) scalars(q + k * length + (b + k < d() ? 0 : n()))[(b + k) % d()] += 1.0;
    for (int c = 0; c < d(); ++c) reflect<Count>(c, q);
    for (int a = d() - 1; a >= 0; --a) {
      const Packet* r = &_panel[at(a * length)];
      Scalar x[Count];
      for (int k = 0; k < Count; ++k) x[k] = scalars(q + k * length)[a] *= _reflections[at(a)].pivot;
      for (int i = 0; i * lanes < a * width; ++i)
        for (int k = 0; k < Count; ++k) q[k * length + i] -= r[i] * x[k];
    }
    for (int k = 0; k < Count; ++k) {
      std::copy_n(q + k * length, n(), s.invert + (b + k) * n());
      std::copy_n(q + k * length + n(), n(), s.keep + (b + k) * n());
    }
  }

  // The relation carried along, first y_left + next y_j + border p = .., is combined with that of cell j, and y_j
  // eliminated by QR.
  void eliminate(const Matrices& m) {
    for (std::vector<Packet>* matrix : {&_first, &_next, &_here, &_ahead, &_kept})
      matrix->assign(at(square()), Packet{});
    _border.assign(at(_borders * n()), Packet{});
    for (std::vector<Packet>* columns : {&_panel, &_reflectors}) columns->assign(at(2 * square()), Packet{});
    _reflections.resize(at(d()));
    _columns.resize(at(8 * n()));
    Vector column = vector();
    load_blocks(m, 0, _first.data(), _next.data());
    for (int p = 0; p < _borders; ++p) load(m.columns, m.column_stride, p, &_border[at(p * n())]);
    for (int j = 1; j < _length; ++j) {
      const Step s = step(j);
      load_blocks(m, j, _here.data(), _ahead.data());
      for (int b = 0; b < d(); ++b) {
        std::copy_n(&_next[at(b * n())], n(), &_panel[at(2 * b * n())]);
        std::copy_n(&_here[at(b * n())], n(), &_panel[at((2 * b + 1) * n())]);
      }
      reduce();
      int b = 0;
      for (; b + 4 <= 2 * d(); b += 4) invert<4>(b, s);
      if (b < 2 * d()) invert<2>(b, s);
      multiply(s.invert, _first.data(), s.to_left);
      multiply(s.invert + square(), _ahead.data(), s.to_next);
      multiply(s.keep, _first.data(), _kept.data());
      multiply(s.keep + square(), _ahead.data(), _next.data());
      _first.swap(_kept);
      for (int p = 0; p < _borders; ++p) {
        load(m.columns + j, m.column_stride, p, column.data());
        combine(s.invert, &_border[at(p * n())], column.data(), to_border(j, p));
        combine(s.keep, &_border[at(p * n())], column.data(), &_border[at(p * n())]);
      }
    }
  }

  /// The relations that the stretches leave, and their shares of the border rows, as CondensedBox takes them.
  void condense(const Matrices& m) {
    const int relation = CondensedBox::relation_size(d(), _borders);
    const int each = width * relation + _borders * _borders;
    std::vector<double>& relations = _relations;
    double* mine = own_part(relations, each);
    const auto give = [&](const std::vector<Packet>& columns, int count, int offset) {
      for (int l = 0; l < width; ++l)
        for (int b = 0; b < count; ++b)
          for (int i = 0; i < d(); ++i) mine[l * relation + offset + b * d() + i] = number(&columns[at(b * n())], i, l);
    };
    give(_first, d(), 0);
    give(_next, d(), d() * d());
    give(_border, _borders, 2 * d() * d());
    Vector on_left = vector();
    Vector inherited = vector();
    for (int q = 0; q < _borders; ++q) {
      Packet corner[most_borders] = {};
      load(m.rows + _first_cell, m.stride, q, on_left.data());
      std::fill_n(inherited.data(), n(), Packet{});
      for (int j = 1; j < _length; ++j) {
        const Step s = step(j);
        Packet* w = weight(j, q);
        std::fill_n(w, n(), Packet{});
        load(m.rows + _first_cell + j, m.stride, q, w);
        for (int i = 0; i < n(); ++i) w[i] += inherited[at(i)];
        std::fill_n(inherited.data(), n(), Packet{});
        subtract_transposed(s.to_left, w, on_left.data());
        subtract_transposed(s.to_next, w, inherited.data());
        for (int p = 0; p < _borders; ++p) corner[p] += products(w, to_border(j, p), n());
      }
      for (int p = 0; p < _borders; ++p)
        mine[width * relation + p * _borders + q] =
            (member() == 0 ? m.corner[q * _borders + p] : 0.0) - sum_of(corner[p]);
      for (int l = 0; l < width; ++l) {
        double* to = mine + l * relation + (2 * d() + _borders) * d() + q;
        for (int i = 0; i < d(); ++i) {
          to[i * _borders] = number(on_left.data(), i, l);
          to[(d() + i) * _borders] = number(inherited.data(), i, l);
        }
      }
    }
    exchange("box scheme: condensed", each, relations);
    _condensed.factor(d(), members(), width, relations, m);
    _condensate.resize(at(_condensed.size()));
  }

  int _dimension;
  int _cells = 0;
  int _first_cell = 0;
  int _length = 0;  // of a stretch
  int _borders = 0;
  int _stride = 0;
  bool _closed = false;
  core::Team* _team = nullptr;
  mutable std::vector<Packet> _steps, _border_steps;
  std::vector<Packet> _first, _next, _border;  // of the relation carried along
  std::vector<Packet> _here, _ahead, _kept, _panel, _reflectors, _columns;
  std::vector<Reflection> _reflections;
  std::vector<double> _relations;
  CondensedBox _condensed;
  mutable std::vector<Packet> _solved, _packed;
  mutable std::vector<double> _ends, _condensate;
};

}  // namespace

// Sizes known to the compiler are those of the systems at hand. Known at run time, a solve takes 58 us where it takes
// 27 (line, d = 8, 201 cells).
std::unique_ptr<BoxScheme> BoxScheme::of_dimension(int dimension, Storage storage) {
  if (storage == Storage::line) {
    if (dimension <= lanes) return std::make_unique<Elimination<double, 1>>(dimension);
    if (dimension <= 2 * lanes) return std::make_unique<Elimination<double, 2>>(dimension);
    return std::make_unique<Elimination<double, 0>>(dimension);
  }
  switch (dimension) {
    case 2: return std::make_unique<Elimination<Packet, 2>>(dimension);
    case 3: return std::make_unique<Elimination<Packet, 3>>(dimension);
    case 4: return std::make_unique<Elimination<Packet, 4>>(dimension);
    case 6: return std::make_unique<Elimination<Packet, 6>>(dimension);
    default: return std::make_unique<Elimination<Packet, 0>>(dimension);
  }
}

core::Team::Part cells_of(const core::Team* team, int cells) {
  if (team == nullptr || team->size() > cells) return {0, cells};
  return team->part_of(team->rank(), cells);
}

}  // namespace orbweaver::equations
