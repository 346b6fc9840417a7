#include "box_scheme.hpp"

#include <cmath>

#include "orbweaver/core/error.hpp"

namespace orbweaver::equations {

namespace {

// D: dimension of a node's block, a constant where it is a common one.
template <int D>
class Elimination : public BoxScheme {
 public:
  Elimination(const Matrices& m, core::Team* team)
      : _d(m.dimension),
        _nodes(m.nodes),
        _begin(m.first),
        _end(m.first + m.boxes),
        _team(team),
        _borders(m.columns.cols()),
        _steps(static_cast<std::size_t>(m.nodes)),
        _solved(static_cast<std::size_t>(m.nodes), Vector(m.dimension)) {
    eliminate(m);
    condense(m);
  }

  void solve(Eigen::VectorXd& x) const override {
    Vector carried = node(x, _begin);
    Border border = given_border(x);
    for (int j = _begin + 1; j < _end; ++j) {
      const Step& s = step(j);
      const Vector here = node(x, j);
      Vector& solved = _solved[static_cast<std::size_t>(j)];
      solved = s.invert_carried.lazyProduct(carried) + s.invert_here.lazyProduct(here);
      carried = (s.keep_carried.lazyProduct(carried) + s.keep_here.lazyProduct(here)).eval();
      border -= s.border_weight.lazyProduct(solved);
    }
    Eigen::MatrixXd left(_d + _borders, members());
    left.col(member()) << carried, border;
    exchange("box scheme: what a stretch leaves", left);
    const Eigen::VectorXd small = _condensed.solve(condensed_side(left));
    const Vector first = small.segment(member() * _d, _d);
    const Border p = small.tail(_borders);
    Vector right = small.segment(next_member() * _d, _d);
    set_node(x, _begin, first);
    for (int j = _end - 1; j > _begin; --j) {
      const Step& s = step(j);
      Vector y = _solved[static_cast<std::size_t>(j)] - s.to_first.lazyProduct(first) - s.to_next.lazyProduct(right);
      y -= s.to_border.lazyProduct(p);
      set_node(x, j, y);
      right = y;
    }
    x.tail(_borders) = p;
    exchange_nodes(x);
  }

  // `solve` backwards, each of its assignments transposed.
  void solve_transposed(Eigen::VectorXd& x) const override {
    Vector first = node(x, _begin);
    Border p = given_border(x);
    Vector right = Vector::Zero(_d);
    for (int j = _begin + 1; j < _end; ++j) {
      const Step& s = step(j);
      Vector& y = _solved[static_cast<std::size_t>(j)];
      y = node(x, j) + right;
      first -= s.to_first.transpose().lazyProduct(y);
      p -= s.to_border.transpose().lazyProduct(y);
      right = -s.to_next.transpose().lazyProduct(y);
    }
    Eigen::MatrixXd left(2 * _d + _borders, members());
    left.col(member()) << first, right, p;
    exchange("box scheme: what a stretch leaves, transposed", left);
    Eigen::MatrixXd sums(_d + _borders, members());
    for (Eigen::Index k = 0; k < members(); ++k)
      sums.col((k + 1) % members()).head(_d) = left.col((k + 1) % members()).head(_d) + left.col(k).segment(_d, _d);
    sums.bottomRows(_borders) = left.bottomRows(_borders);
    const Eigen::VectorXd small = _condensed.transpose().solve(condensed_side(sums));
    Vector carried = small.segment(member() * _d, _d);
    const Border border = small.tail(_borders);
    for (int j = _end - 1; j > _begin; --j) {
      const Step& s = step(j);
      const Vector solved = _solved[static_cast<std::size_t>(j)] - s.border_weight.transpose().lazyProduct(border);
      set_node(x, j, s.invert_here.transpose().lazyProduct(solved) + s.keep_here.transpose().lazyProduct(carried));
      carried =
          (s.invert_carried.transpose().lazyProduct(solved) + s.keep_carried.transpose().lazyProduct(carried)).eval();
    }
    set_node(x, _begin, carried);
    x.tail(_borders) = border;
    exchange_nodes(x);
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

  [[nodiscard]] Eigen::Index members() const { return _team != nullptr ? _team->size() : 1; }
  [[nodiscard]] Eigen::Index member() const { return _team != nullptr ? _team->rank() : 0; }
  [[nodiscard]] Eigen::Index next_member() const { return (member() + 1) % members(); }
  /// Columns, one a member.
  void exchange(const char* place, Eigen::MatrixXd& columns) const {
    if (_team != nullptr)
      _team->divide(place, static_cast<int>(columns.cols()), static_cast<int>(columns.rows()), columns.data(),
                    [](int, int) {});
  }
  void exchange_nodes(Eigen::VectorXd& x) const {
    if (_team == nullptr) return;
    Eigen::MatrixXd nodes(_d, _nodes);
    _team->divide("box scheme: solution", _nodes, _d, nodes.data(), [&](int begin, int end) {
      for (int j = begin; j < end; ++j) nodes.col(j) = node(x, j);
    });
    for (int j = 0; j < _nodes; ++j)
      if (j < _begin || j >= _end) set_node(x, j, nodes.col(j));
  }
  /// What the first member begins its sum over the border rows with; the others begin with zero.
  [[nodiscard]] Border given_border(const Eigen::VectorXd& x) const {
    if (member() == 0) return x.tail(_borders);
    return Border::Zero(_borders);
  }
  /// From a column (node, border) a member to the right-hand side of the condensed system.
  [[nodiscard]] Eigen::VectorXd condensed_side(const Eigen::MatrixXd& columns) const {
    Eigen::VectorXd small(members() * _d + _borders);
    small.tail(_borders) = columns.col(0).tail(_borders);
    for (Eigen::Index k = 0; k < members(); ++k) {
      small.segment(k * _d, _d) = columns.col(k).head(_d);
      if (k > 0) small.tail(_borders) += columns.col(k).tail(_borders);
    }
    return small;
  }
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
      for (int l = 0; l < _d; ++l)
        b(i, l) = 0.5 * m.blocks[static_cast<std::size_t>((i * _d + l) * m.boxes + j - m.first)];
    return b;
  }
  [[nodiscard]] Wide node_columns(const Matrices& m, int j) const {
    Wide c(_d, _borders);
    for (int i = 0; i < _d; ++i) c.row(i) = m.columns.row(static_cast<Eigen::Index>(i) * m.boxes + j - m.first);
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
    _first = -identity - half_block(m, _begin);
    _next = identity - half_block(m, _begin);
    _border = node_columns(m, _begin);
    for (int j = _begin + 1; j < _end; ++j) {
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

  // What a stretch leaves: first y_begin + next y_end + border p = .., and its share of the border rows.
  struct Rest {
    Eigen::MatrixXd relation;     // d x (2 d + borders)
    Eigen::MatrixXd border_rows;  // borders x (2 d + borders)
  };

  [[nodiscard]] Rest rest_of(const Matrices& m) {
    Tall on_first = node_rows(m, _begin);
    Eigen::MatrixXd corner = m.corner;
    if (member() > 0) corner.setZero();
    Tall weight(_borders, _d);
    Tall inherited = Tall::Zero(_borders, _d);
    for (int j = _begin + 1; j < _end; ++j) {
      Step& s = _steps[static_cast<std::size_t>(j)];
      weight = node_rows(m, j) + inherited;
      s.border_weight = weight;
      on_first -= weight.lazyProduct(s.to_first);
      inherited = -weight.lazyProduct(s.to_next);
      corner -= weight.lazyProduct(s.to_border);
    }
    Rest rest{Eigen::MatrixXd(_d, 2 * _d + _borders), Eigen::MatrixXd(_borders, 2 * _d + _borders)};
    rest.relation << _first, _next, _border;
    rest.border_rows << on_first, inherited, corner;
    return rest;
  }

  // After the last node y_N = y_0: a system for the first nodes of all stretches and p.
  void condense(const Matrices& m) {
    const Rest mine = rest_of(m);
    const Eigen::Index rows = _d + _borders;
    const Eigen::Index columns = 2 * _d + _borders;
    Eigen::MatrixXd all(rows * columns, members());
    Eigen::Map<Eigen::MatrixXd>(all.col(member()).data(), rows, columns) << mine.relation, mine.border_rows;
    exchange("box scheme: condensed", all);
    const Eigen::Index inner = members() * _d;
    Eigen::MatrixXd small = Eigen::MatrixXd::Zero(inner + _borders, inner + _borders);
    for (Eigen::Index k = 0; k < members(); ++k) {
      const Eigen::Map<const Eigen::MatrixXd> part(all.col(k).data(), rows, columns);
      const Eigen::Index here = k * _d;
      const Eigen::Index next = (k + 1) % members() * _d;
      small.block(here, here, _d, _d) += part.topLeftCorner(_d, _d);
      small.block(here, next, _d, _d) += part.block(0, _d, _d, _d);
      small.block(here, inner, _d, _borders) = part.topRightCorner(_d, _borders);
      small.block(inner, here, _borders, _d) += part.bottomLeftCorner(_borders, _d);
      small.block(inner, next, _borders, _d) += part.block(_d, _d, _borders, _d);
      small.bottomRightCorner(_borders, _borders) += part.bottomRightCorner(_borders, _borders);
    }
    if (!small.allFinite()) throw core::NumericalError("the box scheme of the loop met numbers that are not finite");
    _condensed.compute(small);
    if (!(std::abs(_condensed.matrixLU().diagonal().cwiseAbs().minCoeff()) > 0.0))
      throw core::NumericalError("the condensed box scheme of the loop is singular");
  }

  int _d;
  int _nodes;
  int _begin;  // this member's boxes and nodes
  int _end;
  core::Team* _team;
  Eigen::Index _borders;
  std::vector<Step> _steps;
  mutable std::vector<Vector> _solved;  // scratch of the solves: g_j in a sweep forwards
  Block _first, _next;
  Wide _border;
  Eigen::PartialPivLU<Eigen::MatrixXd> _condensed;
};

}  // namespace

core::Team::Part boxes_of(const core::Team* team, int nodes) {
  if (team == nullptr || team->size() > nodes) return {0, nodes};
  return team->part_of(team->rank(), nodes);
}

std::unique_ptr<BoxScheme> factor_box_scheme(const BoxScheme::Matrices& m, core::Team* team) {
  core::require(m.dimension >= 1 && m.nodes >= 3, "a box scheme needs at least one coordinate and three nodes");
  core::require(m.rows.rows() == m.columns.cols(), "a box scheme needs as many border rows as columns");
  core::require(m.rows.rows() <= BoxScheme::most_borders, "a box scheme has at most four borders");
  const core::Team::Part mine = boxes_of(team, m.nodes);
  core::require(m.first == mine.begin && m.boxes == mine.end - mine.begin, "a box scheme needs this rank's boxes");
  if (m.boxes == m.nodes) team = nullptr;
  switch (m.dimension) {
    case 2: return std::make_unique<Elimination<2>>(m, team);
    case 4: return std::make_unique<Elimination<4>>(m, team);
    case 6: return std::make_unique<Elimination<6>>(m, team);
    default: return std::make_unique<Elimination<Eigen::Dynamic>>(m, team);
  }
}

}  // namespace orbweaver::equations
