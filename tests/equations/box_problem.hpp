#pragma once

#include <random>
#include <vector>

#include <Eigen/Dense>

#include "box_scheme.hpp"

namespace orbweaver::test {

/// Random numbers for every part of a box scheme, and the same as one dense matrix.
class BoxProblem {
 public:
  struct Shape {
    int dimension = 2;
    int cells = 4;
    int borders = 1;
    bool closed = false;
    double strength = 0.3;  ///< of the blocks: from 2 on solutions grow and decay by large factors a cell
  };

  explicit BoxProblem(const Shape& shape) : _shape(shape), _stride(nodes() + (shape.closed ? 0 : 3)) {
    const auto [d, m, b, closed, strength] = shape;
    _blocks = random(d * d * m, strength);
    _columns = random(b * d * _stride, 1.0);
    _rows = random(b * d * _stride, 1.0);
    _corner = random(b * b, 1.0);
    _dense = Eigen::MatrixXd::Zero(size(), size());
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < m; ++j) {
        add(at(i, j), at(i, j), -difference);
        add(at(i, j), at(i, j + 1), difference);
        for (int l = 0; l < d; ++l)
          for (const int k : {j, j + 1}) add(at(i, j), at(l, k), -0.5 * _blocks[index((i * d + l) * m + j)]);
        for (int p = 0; p < b; ++p) add(at(i, j), border(p), _columns[index((p * d + i) * _stride + j)]);
      }
      for (int q = 0; q < b; ++q)
        for (int j = 0; j < nodes(); ++j) add(border(q), at(i, j), _rows[index((q * d + i) * _stride + j)]);
    }
    for (int q = 0; q < b; ++q)
      for (int p = 0; p < b; ++p) add(border(q), border(p), _corner[index(q * b + p)]);
    if (closed) return;
    left = Eigen::MatrixXd::Map(random(d * d, 1.0).data(), d, d);
    right = Eigen::MatrixXd::Map(random(d * d, 1.0).data(), d, d);
    for (int i = 0; i < d; ++i)
      for (int l = 0; l < d; ++l) {
        add(at(i, m), at(l, 0), left(i, l));
        add(at(i, m), at(l, m), right(i, l));
      }
  }

  /// With this rank's cells.
  void factor(equations::BoxScheme& box, core::Team* team = nullptr) const {
    const auto [d, m, b, closed, strength] = _shape;
    const core::Team::Part mine = equations::cells_of(team, m);
    equations::BoxScheme::Matrices matrices;
    matrices.cells = m;
    matrices.first = mine.begin;
    matrices.count = mine.end - mine.begin;
    matrices.borders = b;
    matrices.difference = difference;
    std::vector<double> blocks;
    for (int e = 0; e < d * d; ++e)
      blocks.insert(blocks.end(), _blocks.begin() + e * m + mine.begin, _blocks.begin() + e * m + mine.end);
    matrices.blocks = blocks.data();
    matrices.columns = _columns.data() + mine.begin;
    matrices.column_stride = matrices.stride = _stride;
    matrices.rows = _rows.data();
    matrices.corner = _corner.data();
    matrices.left = left;
    matrices.right = right;
    box.factor(matrices, team);
  }

  /// What remains of a random right-hand side, relative to matrix and solution.
  [[nodiscard]] double residual(const equations::BoxScheme& box, bool transposed) const {
    const Eigen::VectorXd side = right_side();
    const Eigen::VectorXd x = solved(box, side, transposed);
    const Eigen::VectorXd left_over = (transposed ? Eigen::VectorXd(_dense.transpose() * x) : _dense * x) - side;
    return left_over.lpNorm<Eigen::Infinity>() /
           (_dense.cwiseAbs().rowwise().sum().maxCoeff() * x.lpNorm<Eigen::Infinity>());
  }
  [[nodiscard]] Eigen::VectorXd solved(const equations::BoxScheme& box, const Eigen::VectorXd& side,
                                       bool transposed) const {
    std::vector<double> x(index(_shape.dimension * _stride + _shape.borders));
    const auto place = [&](int n) {
      const int i = n / nodes();
      return i < _shape.dimension ? index(i * _stride + n % nodes())
                                  : index(_shape.dimension * _stride + n - _shape.dimension * nodes());
    };
    for (int n = 0; n < size(); ++n) x[place(n)] = side(n);
    transposed ? box.solve_transposed(x.data()) : box.solve(x.data());
    Eigen::VectorXd out(size());
    for (int n = 0; n < size(); ++n) out(n) = x[place(n)];
    return out;
  }
  [[nodiscard]] Eigen::VectorXd right_side() const {
    Eigen::VectorXd side(size());
    for (int n = 0; n < size(); ++n) side(n) = std::cos(1.0 + 2.0 * n);
    return side;
  }

  Eigen::MatrixXd left, right;

 private:
  static constexpr double difference = 1.3;
  static std::size_t index(int n) { return static_cast<std::size_t>(n); }
  [[nodiscard]] int nodes() const { return _shape.closed ? _shape.cells : _shape.cells + 1; }
  [[nodiscard]] int size() const { return _shape.dimension * nodes() + _shape.borders; }
  [[nodiscard]] int at(int i, int j) const { return i * nodes() + j % nodes(); }
  [[nodiscard]] int border(int p) const { return _shape.dimension * nodes() + p; }
  void add(int row, int column, double value) { _dense(row, column) += value; }
  std::vector<double> random(int count, double scale) {
    std::normal_distribution<double> normal;
    std::vector<double> out(index(count));
    for (double& v : out) v = scale * normal(_generator);
    return out;
  }

  Shape _shape;
  int _stride;
  std::mt19937 _generator{7};
  std::vector<double> _blocks, _columns, _rows, _corner;
  Eigen::MatrixXd _dense;
};

}  // namespace orbweaver::test
