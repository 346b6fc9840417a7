#include "box_scheme.hpp"

#include <cmath>

#include "orbweaver/core/error.hpp"

namespace orbweaver::loss {

namespace {

// D: dimension of a node's block, a constant where it is a common one.
template <int D>
class Elimination : public BoxScheme {
 public:
  explicit Elimination(const Matrices& m)
      : _d(m.dimension),
        _nodes(m.nodes),
        _borders(m.columns.cols()),
        _steps(static_cast<std::size_t>(m.nodes)),
        _solved(static_cast<std::size_t>(m.nodes), Vector(m.dimension)) {
    eliminate(m);
    condense(m);
  }

  void solve(Eigen::VectorXd& x) const override {
    Vector carried = node(x, 0);
    Border border = x.tail(_borders);
    for (int j = 1; j < _nodes; ++j) {
      const Step& s = step(j);
      const Vector here = node(x, j);
      Vector& solved = _solved[static_cast<std::size_t>(j)];
      solved = s.invert_carried.lazyProduct(carried) + s.invert_here.lazyProduct(here);
      carried = (s.keep_carried.lazyProduct(carried) + s.keep_here.lazyProduct(here)).eval();
      border -= s.border_weight.lazyProduct(solved);
    }
    Eigen::VectorXd small(_d + _borders);
    small << carried, border;
    small = _condensed.solve(small);
    const Vector first = small.head(_d);
    const Border p = small.tail(_borders);
    Vector right = first;
    set_node(x, 0, first);
    for (int j = _nodes - 1; j >= 1; --j) {
      const Step& s = step(j);
      Vector y = _solved[static_cast<std::size_t>(j)] - s.to_first.lazyProduct(first) - s.to_next.lazyProduct(right);
      y -= s.to_border.lazyProduct(p);
      set_node(x, j, y);
      right = y;
    }
    x.tail(_borders) = p;
  }

  // `solve` backwards, each of its assignments transposed.
  void solve_transposed(Eigen::VectorXd& x) const override {
    Vector first = node(x, 0);
    Border p = x.tail(_borders);
    Vector right = Vector::Zero(_d);
    for (int j = 1; j < _nodes; ++j) {
      const Step& s = step(j);
      Vector& y = _solved[static_cast<std::size_t>(j)];
      y = node(x, j) + right;
      first -= s.to_first.transpose().lazyProduct(y);
      p -= s.to_border.transpose().lazyProduct(y);
      right = -s.to_next.transpose().lazyProduct(y);
    }
    Eigen::VectorXd small(_d + _borders);
    small << first + right, p;
    small = _condensed.transpose().solve(small);
    Vector carried = small.head(_d);
    const Border border = small.tail(_borders);
    for (int j = _nodes - 1; j >= 1; --j) {
      const Step& s = step(j);
      const Vector solved = _solved[static_cast<std::size_t>(j)] - s.border_weight.transpose().lazyProduct(border);
      set_node(x, j, s.invert_here.transpose().lazyProduct(solved) + s.keep_here.transpose().lazyProduct(carried));
      carried =
          (s.invert_carried.transpose().lazyProduct(solved) + s.keep_carried.transpose().lazyProduct(carried)).eval();
    }
    set_node(x, 0, carried);
    x.tail(_borders) = border;
  }

 private:
  using Block = Eigen::Matrix<double, D, D>;
  using Vector = Eigen::Matrix<double, D, 1>;
  using Border = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_borders, 1>;
  using Wide = Eigen::Matrix<double, D, Eigen::Dynamic, 0, D, most_borders>;
  using Tall = Eigen::Matrix<double, Eigen::Dynamic, D, 0, most_borders, D>;

  // y_j = invert (carried, here) - to_first y_0 - to_next y_(j+1) - to_border p, and what is carried on to node j + 1.
  struct Step {
    Block invert_carried, invert_here, keep_carried, keep_here, to_first, to_next;
    Wide to_border;
    Tall border_weight;  // of y_j in the border rows, after earlier nodes were eliminated
  };

  [[nodiscard]] const Step& step(int j) const { return _steps[static_cast<std::size_t>(j)]; }
  [[nodiscard]] Vector node(const Eigen::VectorXd& x, int j) const {
    Vector v(_d);
    for (int i = 0; i < _d; ++i) v(i) = x(static_cast<Eigen::Index>(i) * _nodes + j);
    return v;
  }
  void set_node(Eigen::VectorXd& x, int j, const Vector& v) const {
    for (int i = 0; i < _d; ++i) x(static_cast<Eigen::Index>(i) * _nodes + j) = v(i);
  }
  [[nodiscard]] Block half_block(const Matrices& m, int j) const {
    Block b(_d, _d);
    for (int i = 0; i < _d; ++i)
      for (int l = 0; l < _d; ++l) b(i, l) = 0.5 * m.blocks[static_cast<std::size_t>((i * _d + l) * _nodes + j)];
    return b;
  }
  [[nodiscard]] Wide node_columns(const Matrices& m, int j) const {
    Wide c(_d, _borders);
    for (int i = 0; i < _d; ++i) c.row(i) = m.columns.row(static_cast<Eigen::Index>(i) * _nodes + j);
    return c;
  }
  [[nodiscard]] Tall node_rows(const Matrices& m, int j) const {
    Tall r(_borders, _d);
    for (int i = 0; i < _d; ++i) r.col(i) = m.rows.col(static_cast<Eigen::Index>(i) * _nodes + j);
    return r;
  }

  // The carried equation first y_0 + next y_j + border p = .. is combined with that of box j, and y_j eliminated by QR.
  void eliminate(const Matrices& m) {
    const Block identity = Block::Identity(_d, _d) / m.spacing;
    _first = -identity - half_block(m, 0);
    _next = identity - half_block(m, 0);
    _border = node_columns(m, 0);
    for (int j = 1; j < _nodes; ++j) {
      Step& s = _steps[static_cast<std::size_t>(j)];
      const Block half = half_block(m, j);
      const Block ahead = identity - half;
      const Wide columns = node_columns(m, j);
      Eigen::Matrix<double, D == Eigen::Dynamic ? Eigen::Dynamic : 2 * D, D> stacked(2 * _d, _d);
      stacked.topRows(_d) = _next;
      stacked.bottomRows(_d) = -identity - half;
      const Eigen::HouseholderQR<decltype(stacked)> qr(stacked);
      using Square = Eigen::Matrix<double, D == Eigen::Dynamic ? Eigen::Dynamic : 2 * D,
                                   D == Eigen::Dynamic ? Eigen::Dynamic : 2 * D>;
      const Square q = qr.householderQ() * Square::Identity(2 * _d, 2 * _d);
      const Block r = qr.matrixQR().topRows(_d).template triangularView<Eigen::Upper>();
      const auto solve_r = r.template triangularView<Eigen::Upper>();
      s.invert_carried = solve_r.solve(Block(q.topLeftCorner(_d, _d).transpose()));
      s.invert_here = solve_r.solve(Block(q.bottomLeftCorner(_d, _d).transpose()));
      s.keep_carried = q.topRightCorner(_d, _d).transpose();
      s.keep_here = q.bottomRightCorner(_d, _d).transpose();
      s.to_first = s.invert_carried * _first;
      s.to_next = s.invert_here * ahead;
      s.to_border = s.invert_carried.lazyProduct(_border) + s.invert_here.lazyProduct(columns);
      _border = (s.keep_carried.lazyProduct(_border) + s.keep_here.lazyProduct(columns)).eval();
      _first = (s.keep_carried * _first).eval();
      _next = (s.keep_here * ahead).eval();
    }
  }

  // After the last node y_N = y_0: a system for y_0 and p alone.
  void condense(const Matrices& m) {
    Tall on_first = node_rows(m, 0);
    Eigen::MatrixXd corner = m.corner;
    Tall weight(_borders, _d);
    Tall inherited = Tall::Zero(_borders, _d);
    for (int j = 1; j < _nodes; ++j) {
      Step& s = _steps[static_cast<std::size_t>(j)];
      weight = node_rows(m, j) + inherited;
      s.border_weight = weight;
      on_first -= weight.lazyProduct(s.to_first);
      inherited = -weight.lazyProduct(s.to_next);
      corner -= weight.lazyProduct(s.to_border);
    }
    on_first += inherited;
    Eigen::MatrixXd small(_d + _borders, _d + _borders);
    small.topLeftCorner(_d, _d) = _first + _next;
    small.topRightCorner(_d, _borders) = _border;
    small.bottomLeftCorner(_borders, _d) = on_first;
    small.bottomRightCorner(_borders, _borders) = corner;
    if (!small.allFinite()) throw core::NumericalError("the box scheme of the loop met numbers that are not finite");
    _condensed.compute(small);
    if (!(std::abs(_condensed.matrixLU().diagonal().cwiseAbs().minCoeff()) > 0.0))
      throw core::NumericalError("the condensed box scheme of the loop is singular");
  }

  int _d;
  int _nodes;
  Eigen::Index _borders;
  std::vector<Step> _steps;
  mutable std::vector<Vector> _solved;  // scratch of the solves: g_j in a sweep forwards
  Block _first, _next;
  Wide _border;
  Eigen::PartialPivLU<Eigen::MatrixXd> _condensed;
};

}  // namespace

std::unique_ptr<BoxScheme> factor_box_scheme(const BoxScheme::Matrices& m) {
  core::require(m.dimension >= 1 && m.nodes >= 3, "a box scheme needs at least one coordinate and three nodes");
  core::require(m.rows.rows() == m.columns.cols(), "a box scheme needs as many border rows as columns");
  core::require(m.rows.rows() <= BoxScheme::most_borders, "a box scheme has at most four borders");
  switch (m.dimension) {
    case 2: return std::make_unique<Elimination<2>>(m);
    case 4: return std::make_unique<Elimination<4>>(m);
    case 6: return std::make_unique<Elimination<6>>(m);
    default: return std::make_unique<Elimination<Eigen::Dynamic>>(m);
  }
}

}  // namespace orbweaver::loss
