#include "transverse_flow.hpp"

#include "matrix_table.hpp"
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

/// Orthonormal basis of the vectors orthogonal to f and, for C = 2, to the gradient of the energy.
template <int D, int C>
Eigen::Matrix<double, D, rest(D, C)> basis_at(const systems::System& system, const Chain& chain, Eigen::Index m) {
  const Eigen::Index d = chain.dimension();
  Vector<D> taken = chain.fields.col(m).normalized();
  if (!(taken.squaredNorm() > 0.5))
    throw core::NumericalError(
        "Floquet multipliers: expected an orbit that moves, but the field vanishes at a state of "
        "the loop; it has collapsed onto an equilibrium");
  Vector<D> reflectors[C];
  reflectors[0] = reflector<D>(taken, 0);
  if constexpr (C == 2) {
    const auto size = static_cast<std::size_t>(d);
    system.energy_gradient({chain.states.col(m).data(), size}, {taken.data(), size});
    taken.normalize();
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

template <int D, int C>
TransverseFlow reduced(const systems::System& system, const Chain& chain, const FundamentalGroup& group) {
  using Basis = Eigen::Matrix<double, D, rest(D, C)>;
  const Eigen::Index d = chain.dimension();
  const Eigen::Index segments = chain.segments();
  const Basis first = basis_at<D, C>(system, chain, 0);
  const Eigen::Matrix<double, D, D> inverse = group.inverse;
  TransverseFlow flow;
  flow.factors.resize((d - C) * (d - C), segments);
  Basis basis = first;
  Basis image;
  for (Eigen::Index m = 0; m < segments; ++m) {
    image.noalias() = matrix_in<D>(chain.transitions, m, d) * basis;
    if (m + 1 < segments) {
      basis = basis_at<D, C>(system, chain, m + 1);
    } else {
      image = (inverse * image).eval();
      basis = first;
    }
    matrix_in<rest(D, C)>(flow.factors, m, d - C).noalias() = basis.transpose() * image;
  }
  const Eigen::MatrixXd frame = first;
  flow.around = frame.transpose() * group.around * frame;
  return flow;
}

}  // namespace

TransverseFlow transverse_flow(const systems::System& system, const Chain& chain, const FundamentalGroup& group) {
  if (!system.description().conservative) return reduced<Eigen::Dynamic, 1>(system, chain, group);
  if (chain.dimension() == 4) return reduced<4, 2>(system, chain, group);
  return reduced<Eigen::Dynamic, 2>(system, chain, group);
}

}  // namespace orbweaver::spectrum
