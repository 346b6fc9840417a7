#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "box_blocks.hpp"
#include "box_reduction.hpp"
#include "box_scheme.hpp"
#include "condensed_box.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"

namespace orbweaver::equations {

/// Some tenths of a millisecond of an elimination.
inline constexpr int cells_between_questions = 256;

/// The elimination, the same for both storages.
template <class Scalar, int Packets>
class BoxElimination final : public BoxScheme, private BoxBlocks<Scalar, Packets> {
  using Blocks = BoxBlocks<Scalar, Packets>;
  using Blocks::d, Blocks::n, Blocks::square, Blocks::vector, Blocks::scalars, Blocks::number, Blocks::add,
      Blocks::combine, Blocks::multiply, Blocks::products, Blocks::total, Blocks::subtract_transposed, Blocks::width;
  using typename Blocks::Vector;

 public:
  explicit BoxElimination(int dimension) : Blocks(dimension), _reduction(dimension) {}

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
    _solved.resize(at(_length * n()));  // zeros where numbers do not fill a packet, from the first on
    _packed.resize(at(_length * n()));
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

  // The relation carried along, first y_left + next y_j + border p = .., is combined with that of cell j, and y_j
  // eliminated by QR.
  void eliminate(const Matrices& m) {
    for (std::vector<Packet>* matrix : {&_first, &_next, &_here, &_ahead, &_kept})
      matrix->assign(at(square()), Packet{});
    _border.assign(at(_borders * n()), Packet{});
    Vector on_border = vector();
    load_blocks(m, 0, _first.data(), _next.data());
    for (int p = 0; p < _borders; ++p) load(m.columns, m.column_stride, p, &_border[at(p * n())]);
    for (int j = 1; j < _length; ++j) {
      if (j % cells_between_questions == 0) core::interruption_point();
      const Step s = step(j);
      load_blocks(m, j, _here.data(), _ahead.data());
      _reduction.run(_next.data(), _here.data(), s.invert, s.keep);
      multiply(s.invert, _first.data(), s.to_left);
      multiply(s.invert + square(), _ahead.data(), s.to_next);
      multiply(s.keep, _first.data(), _kept.data());
      multiply(s.keep + square(), _ahead.data(), _next.data());
      _first.swap(_kept);
      for (int p = 0; p < _borders; ++p) {
        load(m.columns + j, m.column_stride, p, on_border.data());
        combine(s.invert, &_border[at(p * n())], on_border.data(), to_border(j, p));
        combine(s.keep, &_border[at(p * n())], on_border.data(), &_border[at(p * n())]);
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

  int _cells = 0;
  int _first_cell = 0;
  int _length = 0;  // of a stretch
  int _borders = 0;
  int _stride = 0;
  bool _closed = false;
  core::Team* _team = nullptr;
  mutable std::vector<Packet> _steps, _border_steps;
  std::vector<Packet> _first, _next, _border;  // of the relation carried along
  std::vector<Packet> _here, _ahead, _kept;
  BoxReduction<Scalar, Packets> _reduction;
  std::vector<double> _relations;
  CondensedBox _condensed;
  mutable std::vector<Packet> _solved, _packed;
  mutable std::vector<double> _ends, _condensate;
};

}  // namespace orbweaver::equations
