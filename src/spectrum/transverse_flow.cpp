#include "transverse_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "matrix_table.hpp"
#include "orbweaver/ad/lanes.hpp"
#include "orbweaver/core/error.hpp"

namespace orbweaver::spectrum {

namespace {

/// D coordinates less the C that are taken out.
constexpr int rest(int dimension, int taken) {
  return dimension == Eigen::Dynamic ? Eigen::Dynamic : dimension - taken;
}

template <int D>
using Vector = Eigen::Matrix<double, D, 1>;

/// Householder's reflection that takes entries begin .. of `vector` to a multiple of the first of them.
template <int D>
Vector<D> reflector(const Vector<D>& vector, Eigen::Index begin) {
  Vector<D> v = vector;
  for (Eigen::Index n = 0; n < begin; ++n) v[n] = 0.0;
  const double norm = v.norm();
  if (!(norm > 0.0)) return v;
  v[begin] += v[begin] < 0.0 ? -norm : norm;
  return v / v.norm();
}

[[noreturn]] void refuse_field(double length) {
  if (!std::isfinite(length))
    throw core::NotFiniteError(
        "Floquet multipliers: the field or a derivative of it is not finite at a state of the loop");
  throw core::NumericalError(
      "Floquet multipliers: expected an orbit that moves, but the field vanishes at a state of "
      "the loop; it has collapsed onto an equilibrium");
}

/// Orthonormal basis of the vectors orthogonal to f and, for C = 2, to the gradient of the energy.
template <int D, int C>
Eigen::Matrix<double, D, rest(D, C)> basis_at(const Chain& chain, Eigen::Index m) {
  const Eigen::Index d = chain.dimension();
  Vector<D> taken = chain.fields.col(m).normalized();
  if (!(taken.squaredNorm() > 0.5)) refuse_field(chain.fields.col(m).norm());
  Vector<D> reflectors[C];
  reflectors[0] = reflector<D>(taken, 0);
  if constexpr (C == 2) {
    taken = chain.gradients.col(m).normalized();
    taken -= reflectors[0] * (2.0 * reflectors[0].dot(taken));
    reflectors[1] = reflector<D>(taken, 1);
  }
  Eigen::Matrix<double, D, rest(D, C)> basis(d, d - C);
  basis.setZero();
  for (Eigen::Index n = 0; n < d - C; ++n) {
    basis(C + n, n) = 1.0;
    for (int c = C; c-- > 0;) basis.col(n) -= reflectors[c] * (2.0 * reflectors[c].dot(basis.col(n)));
  }
  return basis;
}

using ad::Lanes;
using Lanes4 = std::array<Lanes, 4>;
/// Below the squares of all vectors: unused lanes hold zeros.
constexpr double least_square = 1e-300;

Lanes dot(const Lanes4& a, const Lanes4& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

/// vector - reflector (2 reflector . vector / |reflector|^2), `twice` being 2 / |reflector|^2.
void reflect(const Lanes4& reflector, Lanes twice, Lanes4& vector) {
  const Lanes share = twice * dot(reflector, vector);
  for (std::size_t i = 0; i < 4; ++i) vector[i] -= share * reflector[i];
}

/// Adds the length of the vector to its entry `first`, away from zero; returns 2 / |.|^2 of the result.
Lanes make_reflector(Lanes4& vector, std::size_t first) {
  const Lanes length = sqrt(dot(vector, vector));
  vector[first] = vector[first] + Lanes(vector[first].packed < 0.0 ? -length.packed : length.packed);
  return 2.0 / (dot(vector, vector) + least_square);
}

/// The same bases for four dimensions and C = 2, several nodes at a time: column m holds that of t_m.
Eigen::Matrix<double, 8, Eigen::Dynamic> bases_of_four(const Chain& chain) {
  constexpr auto width = static_cast<Eigen::Index>(Lanes::width);
  const Eigen::Index nodes = chain.states.cols();
  Eigen::Matrix<double, 8, Eigen::Dynamic> bases(8, nodes);
  for (Eigen::Index begin = 0; begin < nodes; begin += width) {
    Lanes4 field;
    Lanes4 gradient;
    for (Eigen::Index lane = 0; lane < width; ++lane) {
      const Eigen::Index m = std::min(begin + lane, nodes - 1);
      const double length = chain.fields.col(m).norm();
      if (!(length > 0.0)) refuse_field(length);
      for (std::size_t i = 0; i < 4; ++i) {
        field[i].packed[lane] = chain.fields(static_cast<Eigen::Index>(i), m);
        gradient[i].packed[lane] = chain.gradients(static_cast<Eigen::Index>(i), m);
      }
    }
    const Lanes twice_0 = make_reflector(field, 0);
    reflect(field, twice_0, gradient);
    gradient[0] = 0.0;
    const Lanes twice_1 = make_reflector(gradient, 1);
    for (std::size_t n = 0; n < 2; ++n) {
      Lanes4 basis{0.0, 0.0, 0.0, 0.0};
      basis[2 + n] = 1.0;
      reflect(gradient, twice_1, basis);
      reflect(field, twice_0, basis);
      for (std::size_t i = 0; i < 4; ++i)
        for (Eigen::Index lane = 0; lane < std::min(width, nodes - begin); ++lane)
          bases(static_cast<Eigen::Index>(4 * n + i), begin + lane) = basis[i].packed[lane];
    }
  }
  return bases;
}

template <int D, int C>
TransverseFlow reduced(const Chain& chain, const FundamentalGroup& group, core::Team* team) {
  using Basis = Eigen::Matrix<double, D, rest(D, C)>;
  const Eigen::Index d = chain.dimension();
  const Eigen::Index segments = chain.segments();
  Eigen::Matrix<double, 8, Eigen::Dynamic> bases;
  if constexpr (D == 4 && C == 2) bases = bases_of_four(chain);
  const auto basis_of = [&](Eigen::Index m) -> Basis {
    if constexpr (D == 4 && C == 2)
      return Eigen::Map<const Basis>(bases.col(m).data());
    else
      return basis_at<D, C>(chain, m);
  };
  const Basis first = basis_of(0);
  const Eigen::Matrix<double, D, D> inverse = group.inverse;
  TransverseFlow flow;
  flow.factors.resize((d - C) * (d - C), segments);
  const bool estimated = chain.truncations.cols() > 0;
  if (estimated) flow.errors.resize(flow.factors.rows(), segments);
  const auto reduce = [&](Eigen::Index begin, Eigen::Index end) {
    Basis basis = begin == 0 || begin == end ? first : basis_of(begin);
    Basis next = first;
    Basis image;
    for (Eigen::Index m = begin; m < end; ++m) {
      const bool last = m + 1 == segments;
      if (last)
        next.noalias() = inverse.transpose() * first;
      else
        next = basis_of(m + 1);
      image.noalias() = matrix_in<D>(chain.transitions, m, d) * basis;
      matrix_in<rest(D, C)>(flow.factors, m, d - C).noalias() = next.transpose() * image;
      if (estimated) {
        image.noalias() = matrix_in<D>(chain.truncations, m, d) * basis;
        matrix_in<rest(D, C)>(flow.errors, m, d - C).noalias() = next.transpose() * image;
      }
      basis = next;
    }
  };
  if (team == nullptr) {
    reduce(0, segments);
  } else {
    const auto count = static_cast<int>(segments);
    const auto size = static_cast<int>(flow.factors.rows());
    team->divide("transverse flow: factors", count, size, flow.factors.data(), reduce);
    if (estimated) team->divide("transverse flow: errors", count, size, flow.errors.data(), [](int, int) {});
  }
  const Eigen::MatrixXd frame = first;
  flow.around = frame.transpose() * group.around * frame;
  if constexpr (D == 4 && C == 2) {
    Eigen::Matrix4d all;
    all << chain.fields.col(0), chain.gradients.col(0), first;
    flow.orientation = std::copysign(1.0, all.determinant());
    flow.bases = std::move(bases);
  }
  return flow;
}

}  // namespace

TransverseFlow transverse_flow(const systems::System& system, const Chain& chain, const FundamentalGroup& group,
                               core::Team* team) {
  if (!system.structure().conservative()) return reduced<Eigen::Dynamic, 1>(chain, group, team);
  if (chain.dimension() == 4) return reduced<4, 2>(chain, group, team);
  return reduced<Eigen::Dynamic, 2>(chain, group, team);
}

Eigen::MatrixXd transverse_basis(const systems::System& system, const Chain& chain, Eigen::Index m) {
  if (!system.structure().conservative()) return basis_at<Eigen::Dynamic, 1>(chain, m);
  return basis_at<Eigen::Dynamic, 2>(chain, m);
}

}  // namespace orbweaver::spectrum
