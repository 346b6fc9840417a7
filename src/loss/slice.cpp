#include "orbweaver/loss/slice.hpp"

#include "orbweaver/core/error.hpp"
#include "orbweaver/loss/dense.hpp"

namespace orbweaver::loss {

namespace {

/// What is left of a condition that earlier ones contain to rounding, relative to its length.
constexpr double dependent = 1e-12;

// The w of (I - 2vv') H (I - 2vv') = H - v w' - w v' for a symmetric H and a unit vector v.
template <class Matrix>
Eigen::VectorXd rank_two_partner(const Matrix& h, const Eigen::VectorXd& v) {
  Eigen::VectorXd w = 2.0 * (h * v);
  w -= v.dot(w) * v;
  return w;
}

}  // namespace

Slice::Slice(int unknowns, const Eigen::MatrixXd& conditions)
    : _unknowns(unknowns), _conditions(static_cast<int>(conditions.cols())), _given(conditions) {
  core::require(conditions.cols() == 0 || conditions.rows() == unknowns, "conditions need one entry an unknown");
  core::require(_conditions < unknowns, "more conditions than unknowns");
  for (int c = 0; c < _conditions; ++c) {
    Eigen::VectorXd column = conditions.col(c);
    const double scale = column.norm();
    for (const Eigen::VectorXd& v : _reflectors) column -= 2.0 * v.dot(column) * v;
    Eigen::VectorXd v = column;
    v.head(c).setZero();
    const double norm = v.norm();
    core::require(scale > 0.0 && norm > dependent * scale, "the conditions of a slice must be independent");
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
  reduce_symmetric(matrix, out);
  return out;
}

void Slice::reduce_symmetric(const core::Handle<Mat>& matrix, const core::Handle<Mat>& out) const {
  with_dense_array(matrix, [&](DenseMap h) {
    core::require(h.rows() == _unknowns && h.cols() == _unknowns, "a matrix of another size");
    with_dense_array(out, [&](DenseMap reduced) {
      core::require(reduced.rows() == free() && reduced.cols() == free(), "a reduced matrix of another size");
      if (_reflectors.size() == 1) {
        // (I - 2vv') H (I - 2vv') = H - v w' - w v' needs one pass over H and no copy of it.
        const Eigen::VectorXd& v = _reflectors.front();
        const Eigen::VectorXd w = rank_two_partner(h, v);
        for (int c = 0; c < free(); ++c)
          reduced.col(c) = h.col(c + 1).tail(free()) - w(c + 1) * v.tail(free()) - v(c + 1) * w.tail(free());
        return;
      }
      Eigen::MatrixXd work = h;
      for (const Eigen::VectorXd& v : _reflectors) {
        const Eigen::VectorXd w = rank_two_partner(work, v);
        for (int c = 0; c < _unknowns; ++c) work.col(c) -= w(c) * v + v(c) * w;
      }
      reduced = work.bottomRightCorner(free(), free());
    });
  });
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
