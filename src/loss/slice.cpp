#include "orbweaver/loss/slice.hpp"

#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::loss {

Slice::Slice(int unknowns, const Eigen::MatrixXd& conditions)
    : _unknowns(unknowns), _conditions(static_cast<int>(conditions.cols())) {
  core::require(conditions.cols() == 0 || conditions.rows() == unknowns, "conditions need one entry an unknown");
  core::require(_conditions < unknowns, "more conditions than unknowns");
  for (int c = 0; c < _conditions; ++c) {
    Eigen::VectorXd column = conditions.col(c);
    const double scale = column.norm();
    for (const Eigen::VectorXd& v : _reflectors) column -= 2.0 * v.dot(column) * v;
    Eigen::VectorXd v = column;
    v.head(c).setZero();
    const double norm = v.norm();
    core::require(scale > 0.0 && norm > 1e-12 * scale, "the conditions of a slice must be independent");
    v(c) += v(c) >= 0.0 ? norm : -norm;
    _reflectors.push_back(v.normalized());
  }
}

Eigen::VectorXd Slice::expand(const Eigen::VectorXd& x) const {
  core::require(x.size() == free(), "one value a free unknown is needed");
  Eigen::VectorXd u(_unknowns);
  u.head(_conditions).setZero();
  u.tail(free()) = x;
  for (auto v = _reflectors.rbegin(); v != _reflectors.rend(); ++v) u -= 2.0 * v->dot(u) * *v;
  return u;
}

Eigen::VectorXd Slice::reduce(const Eigen::VectorXd& u) const {
  core::require(u.size() == _unknowns, "one value an unknown is needed");
  Eigen::VectorXd x = u;
  for (const Eigen::VectorXd& v : _reflectors) x -= 2.0 * v.dot(x) * v;
  return x.tail(free());
}

core::Handle<Mat> Slice::reduce_symmetric(const core::Handle<Mat>& matrix) const {
  core::Handle<Mat> out = create_dense(free(), free());
  with_dense_array(matrix, [&](DenseMap h) {
    core::require(h.rows() == _unknowns && h.cols() == _unknowns, "a matrix of another size");
    Eigen::MatrixXd work = h;
    for (const Eigen::VectorXd& v : _reflectors) {
      Eigen::VectorXd w = 2.0 * (work * v);
      w -= v.dot(w) * v;
      work.noalias() -= v * w.transpose();
      work.noalias() -= w * v.transpose();
    }
    with_dense_array(out, [&](DenseMap reduced) { reduced = work.bottomRightCorner(free(), free()); });
  });
  return out;
}

core::Handle<Mat> Slice::reduce_columns(const core::Handle<Mat>& matrix) const {
  core::Handle<Mat> out;
  with_dense_array(matrix, [&](DenseMap j) {
    core::require(j.cols() == _unknowns, "a matrix of another size");
    Eigen::MatrixXd work = j;
    for (const Eigen::VectorXd& v : _reflectors) {
      const Eigen::VectorXd w = 2.0 * (work * v);
      work.noalias() -= w * v.transpose();
    }
    out = create_dense(static_cast<int>(j.rows()), free());
    with_dense_array(out, [&](DenseMap reduced) { reduced = work.rightCols(free()); });
  });
  return out;
}

}  // namespace orbweaver::loss
