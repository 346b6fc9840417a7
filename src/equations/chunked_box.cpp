#include "chunked_box.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include "orbweaver/core/error.hpp"

namespace orbweaver::equations {

namespace {

using Lane = double __attribute__((vector_size(ChunkedBox::lanes * sizeof(double))));

Lane square_root(Lane v) {
  for (int l = 0; l < ChunkedBox::lanes; ++l) v[l] = std::sqrt(v[l]);
  return v;
}

/// out (rows x columns) = a (rows x inner) b (inner x columns), row-major.
template <int Rows, int Inner, int Columns>
void multiply(const Lane* a, const Lane* b, Lane* out) {
  for (int i = 0; i < Rows; ++i)
    for (int j = 0; j < Columns; ++j) {
      Lane sum = a[i * Inner] * b[j];
      for (int l = 1; l < Inner; ++l) sum += a[i * Inner + l] * b[l * Columns + j];
      out[i * Columns + j] = sum;
    }
}

template <int D>
class Elimination final : public ChunkedBox {
 public:
  void factor(const Matrices& m) override {
    _cells = m.cells;
    _stride = m.stride;
    _length = m.cells / lanes;
    _borders = m.borders;
    const auto steps = static_cast<std::size_t>(_length);
    _steps.resize(steps);
    _border_steps.resize(steps * static_cast<std::size_t>(_borders));
    _solved.resize(steps * D);
    _packed.resize((steps + 1) * D);
    eliminate(m);
    condense(m);
  }

  void solve(double* x) const override {
    Lane carried[D];
    pack(x);
    double* border = x + static_cast<std::ptrdiff_t>(D) * _stride;
    Lane inner[2] = {};
    forward(carried, inner);
    double* small = _small.data();
    for (int l = 0; l < lanes; ++l)
      for (int i = 0; i < D; ++i) small[l * D + i] = carried[i][l];
    for (int i = 0; i < D; ++i) small[lanes * D + i] = x[static_cast<std::ptrdiff_t>(i) * _stride + _cells];
    for (int p = 0; p < _borders; ++p) {
      double sum = 0.0;
      for (int l = 0; l < lanes; ++l) sum += inner[p][l];
      small[(lanes + 1) * D + p] = border[p] - sum;
    }
    solve_small();
    backward(x);
    for (int p = 0; p < _borders; ++p) border[p] = _small[static_cast<std::size_t>((lanes + 1) * D + p)];
  }

 private:
  /// y_j = invert (carried, here) - to_left y_left - to_next y_(j+1) - to_border p, and what is carried on.
  struct Step {
    Lane invert[2 * D * D];
    Lane keep[2 * D * D];
    Lane to_left[D * D];
    Lane to_next[D * D];
  };
  struct BorderStep {
    Lane to_border[D];
    Lane weight[D];  // of y_j in the border row, after earlier nodes of the chunk were eliminated
  };
  [[nodiscard]] BorderStep& border_step(int j, int p) {
    return _border_steps[static_cast<std::size_t>(j * _borders + p)];
  }
  [[nodiscard]] const BorderStep& border_step(int j, int p) const {
    return _border_steps[static_cast<std::size_t>(j * _borders + p)];
  }

  /// Nodal values of all chunks side by side: _packed[j * D + i].
  void pack(const double* x) const {
    auto* out = reinterpret_cast<double*>(_packed.data());
    for (int i = 0; i < D; ++i)
      for (int l = 0; l < lanes; ++l) {
        const double* from = x + static_cast<std::ptrdiff_t>(i) * _stride + static_cast<std::ptrdiff_t>(l) * _length;
        for (int j = 0; j < _length; ++j) out[(j * D + i) * lanes + l] = from[j];
      }
  }

  void forward(Lane* carried, Lane* inner) const {
    for (int i = 0; i < D; ++i) carried[i] = _packed[static_cast<std::size_t>(i)];
    for (int j = 1; j < _length; ++j) {
      const Step& s = _steps[static_cast<std::size_t>(j)];
      Lane both[2 * D];
      for (int i = 0; i < D; ++i) {
        both[i] = carried[i];
        both[D + i] = _packed[static_cast<std::size_t>(j * D + i)];
      }
      multiply<D, 2 * D, 1>(s.invert, both, &_solved[static_cast<std::size_t>(j * D)]);
      multiply<D, 2 * D, 1>(s.keep, both, carried);
      for (int p = 0; p < _borders; ++p)
        for (int i = 0; i < D; ++i)
          inner[p] += border_step(j, p).weight[i] * _solved[static_cast<std::size_t>(j * D + i)];
    }
  }

  void backward(double* x) const {
    const double* small = _small.data();
    Lane left[D];
    Lane right[D];
    Lane border[2];
    for (int p = 0; p < _borders; ++p)
      for (int l = 0; l < lanes; ++l) border[p][l] = small[(lanes + 1) * D + p];
    for (int i = 0; i < D; ++i)
      for (int l = 0; l < lanes; ++l) {
        left[i][l] = small[l * D + i];
        right[i][l] = small[(l + 1) * D + i];
      }
    for (int i = 0; i < D; ++i) _packed[static_cast<std::size_t>(i)] = left[i];
    for (int j = _length - 1; j >= 1; --j) {
      const Step& s = _steps[static_cast<std::size_t>(j)];
      Lane y[D];
      for (int i = 0; i < D; ++i) {
        Lane sum = _solved[static_cast<std::size_t>(j * D + i)];
        for (int l = 0; l < D; ++l) sum -= s.to_left[i * D + l] * left[l] + s.to_next[i * D + l] * right[l];
        for (int p = 0; p < _borders; ++p) sum -= border_step(j, p).to_border[i] * border[p];
        y[i] = sum;
      }
      for (int i = 0; i < D; ++i) right[i] = _packed[static_cast<std::size_t>(j * D + i)] = y[i];
    }
    const auto* in = reinterpret_cast<const double*>(_packed.data());
    for (int i = 0; i < D; ++i) {
      double* to = x + static_cast<std::ptrdiff_t>(i) * _stride;
      for (int l = 0; l < lanes; ++l)
        for (int j = 0; j < _length; ++j) to[l * _length + j] = in[(j * D + i) * lanes + l];
      to[_cells] = small[lanes * D + i];
    }
  }

  void load_blocks(const Matrices& m, int j, Lane* here, Lane* ahead) const {
    for (int e = 0; e < D * D; ++e) {
      Lane half;
      const double* block = m.blocks + static_cast<std::ptrdiff_t>(e) * _cells + j;
      for (int l = 0; l < lanes; ++l) half[l] = 0.5 * block[l * _length];
      here[e] = -half;
      ahead[e] = -half;
    }
    for (int i = 0; i < D; ++i) {
      here[i * D + i] -= 1.0;
      ahead[i * D + i] += 1.0;
    }
  }
  void load_nodal(const double* nodal, int p, int j, Lane* out) const {
    for (int i = 0; i < D; ++i) {
      const double* from = nodal + static_cast<std::ptrdiff_t>(p * D + i) * _stride + j;
      for (int l = 0; l < lanes; ++l) out[i][l] = from[l * _length];
    }
  }

  /// Householder QR of the 2D x D column in `work` (2D x 3D, the identity behind it): R above, Q' behind.
  static void reduce(Lane (&work)[2 * D][3 * D]) {
    for (int c = 0; c < D; ++c) {
      Lane square = work[c][c] * work[c][c];
      for (int a = c + 1; a < 2 * D; ++a) square += work[a][c] * work[a][c];
      const Lane norm = square_root(square);
      const Lane alpha = work[c][c] > 0.0 ? -norm : norm;
      Lane v[2 * D];
      for (int a = c; a < 2 * D; ++a) v[a] = work[a][c];
      v[c] -= alpha;
      const Lane scale = 1.0 / (alpha * (alpha - work[c][c]));
      for (int b = c + 1; b < 3 * D; ++b) {
        Lane dot = v[c] * work[c][b];
        for (int a = c + 1; a < 2 * D; ++a) dot += v[a] * work[a][b];
        dot *= scale;
        for (int a = c; a < 2 * D; ++a) work[a][b] -= dot * v[a];
      }
      work[c][c] = alpha;
    }
  }

  void eliminate(const Matrices& m) {
    Lane here[D * D];
    Lane ahead[D * D];
    load_blocks(m, 0, _first, _next);
    for (int p = 0; p < _borders; ++p) load_nodal(m.columns, p, 0, _border[p]);
    for (int j = 1; j < _length; ++j) {
      Step& s = _steps[static_cast<std::size_t>(j)];
      load_blocks(m, j, here, ahead);
      Lane work[2 * D][3 * D];
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) {
          work[a][b] = _next[a * D + b];
          work[D + a][b] = here[a * D + b];
        }
      for (int a = 0; a < 2 * D; ++a)
        for (int b = 0; b < 2 * D; ++b) work[a][D + b] = Lane{} + (a == b ? 1.0 : 0.0);
      reduce(work);
      for (int a = D - 1; a >= 0; --a) {
        const Lane pivot = 1.0 / work[a][a];
        for (int b = 0; b < 2 * D; ++b) {
          Lane sum = work[a][D + b];
          for (int c = a + 1; c < D; ++c) sum -= work[a][c] * s.invert[c * 2 * D + b];
          s.invert[a * 2 * D + b] = sum * pivot;
        }
      }
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < 2 * D; ++b) s.keep[a * 2 * D + b] = work[D + a][D + b];
      const auto product = [](const Lane* wide, int offset, const Lane* block, Lane* out) {
        for (int a = 0; a < D; ++a)
          for (int b = 0; b < D; ++b) {
            Lane sum = wide[a * 2 * D + offset] * block[b];
            for (int c = 1; c < D; ++c) sum += wide[a * 2 * D + offset + c] * block[c * D + b];
            out[a * D + b] = sum;
          }
      };
      product(s.invert, 0, _first, s.to_left);
      product(s.invert, D, ahead, s.to_next);
      Lane kept[D * D];
      product(s.keep, 0, _first, kept);
      std::copy_n(kept, D * D, _first);
      product(s.keep, D, ahead, _next);
      for (int p = 0; p < _borders; ++p) {
        Lane both[2 * D];
        std::copy_n(_border[p], D, both);
        load_nodal(m.columns, p, j, both + D);
        multiply<D, 2 * D, 1>(s.invert, both, border_step(j, p).to_border);
        multiply<D, 2 * D, 1>(s.keep, both, _border[p]);
      }
    }
  }

  void condense(const Matrices& m) {
    const int size = (lanes + 1) * D + _borders;
    Eigen::MatrixXd small = Eigen::MatrixXd::Zero(size, size);
    for (int l = 0; l < lanes; ++l)
      for (int a = 0; a < D; ++a) {
        for (int b = 0; b < D; ++b) {
          small(l * D + a, l * D + b) += _first[a * D + b][l];
          small(l * D + a, (l + 1) * D + b) += _next[a * D + b][l];
        }
        for (int p = 0; p < _borders; ++p) small(l * D + a, (lanes + 1) * D + p) = _border[p][a][l];
      }
    small.block(lanes * D, 0, D, D) = m.left;
    small.block(lanes * D, lanes * D, D, D) = m.right;
    for (int q = 0; q < _borders; ++q) {
      const Eigen::Index row = (lanes + 1) * D + q;
      for (int p = 0; p < _borders; ++p) small(row, (lanes + 1) * D + p) = m.corner[q * _borders + p];
      Lane on_left[D];
      load_nodal(m.rows, q, 0, on_left);
      Lane inherited[D] = {};
      for (int j = 1; j < _length; ++j) {
        const Step& s = _steps[static_cast<std::size_t>(j)];
        Lane* weight = border_step(j, q).weight;
        load_nodal(m.rows, q, j, weight);
        for (int i = 0; i < D; ++i) weight[i] += inherited[i];
        for (int b = 0; b < D; ++b) {
          inherited[b] = Lane{};
          for (int a = 0; a < D; ++a) {
            on_left[b] -= weight[a] * s.to_left[a * D + b];
            inherited[b] -= weight[a] * s.to_next[a * D + b];
          }
        }
        for (int p = 0; p < _borders; ++p)
          for (int a = 0; a < D; ++a) {
            const Lane part = weight[a] * border_step(j, p).to_border[a];
            for (int l = 0; l < lanes; ++l) small(row, (lanes + 1) * D + p) -= part[l];
          }
      }
      for (int l = 0; l < lanes; ++l)
        for (int b = 0; b < D; ++b) {
          small(row, l * D + b) += on_left[b][l];
          small(row, (l + 1) * D + b) += inherited[b][l];
        }
      for (int b = 0; b < D; ++b)
        small(row, lanes * D + b) += m.rows[static_cast<std::ptrdiff_t>(q * D + b) * _stride + _cells];
    }
    if (!small.allFinite()) throw core::NumericalError("the box scheme of the loop met numbers that are not finite");
    _lu.compute(small);
    if (!(_lu.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0))
      throw core::NumericalError("the condensed box scheme of the loop is singular");
    _small.resize(static_cast<std::size_t>(size));
    _permuted.resize(static_cast<std::size_t>(size));
  }

  void solve_small() const {
    const Eigen::Index size = _lu.rows();
    const auto& order = _lu.permutationP().indices();
    for (Eigen::Index n = 0; n < size; ++n)
      _permuted[static_cast<std::size_t>(order(n))] = _small[static_cast<std::size_t>(n)];
    Eigen::Map<Eigen::VectorXd> x(_permuted.data(), size);
    const Eigen::MatrixXd& lu = _lu.matrixLU();
    for (Eigen::Index c = 0; c < size - 1; ++c) x.tail(size - c - 1) -= x(c) * lu.col(c).tail(size - c - 1);
    for (Eigen::Index c = size - 1; c >= 0; --c) {
      x(c) /= lu(c, c);
      x.head(c) -= x(c) * lu.col(c).head(c);
    }
    _small.swap(_permuted);
  }

  int _cells = 0;
  int _stride = 0;
  int _length = 0;
  int _borders = 0;
  std::vector<Step> _steps;
  std::vector<BorderStep> _border_steps;
  Lane _first[D * D];
  Lane _next[D * D];
  Lane _border[2][D];
  Eigen::PartialPivLU<Eigen::MatrixXd> _lu;
  mutable std::vector<Lane> _solved;
  mutable std::vector<Lane> _packed;
  mutable std::vector<double> _small;
  mutable std::vector<double> _permuted;
};

}  // namespace

std::unique_ptr<ChunkedBox> ChunkedBox::of_dimension(int dimension) {
  switch (dimension) {
    case 2: return std::make_unique<Elimination<2>>();
    case 3: return std::make_unique<Elimination<3>>();
    case 4: return std::make_unique<Elimination<4>>();
    case 6: return std::make_unique<Elimination<6>>();
    default: return nullptr;
  }
}

}  // namespace orbweaver::equations
