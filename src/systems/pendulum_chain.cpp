#include "pendulum_chain.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "model/sized_system.hpp"

namespace orbweaver::systems {

/// n equal bobs m, each hanging by a massless rod of length l from the one before, the first from the pivot. State
/// th1 ... thn (rad from the downward vertical), w1 ... wn (rad/s). With bob k at the sum of the rods to k the
/// Lagrangian is
///   L = sum_k m |v_k|^2 / 2 + m g l sum_k (n + 1 - k) cos th_k.
///
/// Its equations are solved through the tensions of the rods, T_k = m l t_k. Bob k feels T_k and T_(k+1) along the rods
/// beside it; that rod k keeps its length says
///   t_1 - c_1 t_2 = w_1^2 + (g/l) cos th_1,
///   2 t_k - c_(k-1) t_(k-1) - c_k t_(k+1) = w_k^2,   k > 1,   c_k = cos(th_k - th_(k+1)), s_k the sine,
/// (gravity pulls at all bobs alike and is felt at the pivot only), and across rod k
///   dw_k/dt = t_(k-1) s_(k-1) - t_(k+1) s_k,   for k = 1 with -(g/l) sin th_1 for the first term.
/// Eliminated from the free end the pivots are 1 + q_k, and q_1 for the first:
///   q_n = 1,   q_k = (q_(k+1) + s_k^2) / (1 + q_(k+1)),
/// sums of positive numbers: nothing cancels, and there is no mass matrix.
class PendulumChain {
 public:
  static constexpr const char* count = "links";
  static constexpr int standard = 3;
  static constexpr int most = 100;

  static int count_of(const Bound& bound) {
    const double links = bound[count];
    if (links != std::floor(links))
      throw core::InputError(
          fmt::format("parameter 'links' of system 'pendulum_chain' must be a whole number; {} came", links));
    return static_cast<int>(links);
  }
  static ModelInfo info(int links);
  static Structure structure(int links);

  template <class P>
  class With {
   public:
    With(const BoundTo<P>& bound, int links)
        : _links(static_cast<std::size_t>(links)),
          _frequency(bound["g"] / bound["l"]),
          _inertia(bound["m"] * bound["l"] * bound["l"]) {}

    template <class S>
    void field(const S* z, S* f) const {
      using std::cos;
      using std::sin;
      const std::size_t n = _links;
      const S* w = z + n;
      std::vector<S> along(n);
      std::vector<S> across(n);
      std::vector<S> pivot(n);
      std::vector<S> tension(n);
      S rest = S(1.0);
      for (std::size_t k = n; k-- > 0;) {
        tension[k] = w[k] * w[k];
        if (k + 1 < n) {
          const S angle = z[k] - z[k + 1];
          along[k] = cos(angle);
          across[k] = sin(angle);
          const S share = S(1.0) / pivot[k + 1];
          tension[k] += along[k] * tension[k + 1] * share;
          rest = (rest + across[k] * across[k]) * share;
        }
        pivot[k] = rest + 1.0;
      }
      tension[0] = (tension[0] + cos(z[0]) * _frequency) / rest;
      for (std::size_t k = 1; k < n; ++k) tension[k] = (tension[k] + along[k - 1] * tension[k - 1]) / pivot[k];
      for (std::size_t k = 0; k < n; ++k) {
        f[k] = w[k];
        f[n + k] = k == 0 ? -(sin(z[0]) * _frequency) : tension[k - 1] * across[k - 1];
        if (k + 1 < n) f[n + k] -= tension[k + 1] * across[k];
      }
    }

    template <class S>
    S conserved(int, const S* z) const {
      using std::cos;
      S height = S(0.0);
      for (std::size_t k = 0; k < _links; ++k) height += cos(z[k]) * static_cast<double>(_links - k);
      return action_density(z) * 0.5 - height * (_inertia * _frequency);
    }

    template <class S>
    S action_density(const S* z) const {
      using std::cos;
      using std::sin;
      S x = S(0.0);
      S y = S(0.0);
      S sum = S(0.0);
      for (std::size_t k = 0; k < _links; ++k) {
        x += cos(z[k]) * z[_links + k];
        y += sin(z[k]) * z[_links + k];
        sum += x * x + y * y;
      }
      return sum * _inertia;
    }

   private:
    std::size_t _links;
    P _frequency;  // squared: g/l
    P _inertia;    // m l^2
  };
};

ModelInfo PendulumChain::info(int links) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ModelInfo info;
  info.name = "pendulum_chain";
  info.title = "Chain of pendulums";
  info.meaning = "equal point masses on massless rods, each hanging from the one before, under gravity";
  for (const char* coordinate : {"th", "w"})
    for (int k = 1; k <= links; ++k) info.state_names.push_back(fmt::format("{}{}", coordinate, k));
  for (int k = 1; k <= links; ++k) info.winding_names.push_back(fmt::format("n{}", k));
  info.winding_names.resize(info.state_names.size());
  info.parameters = {
      {count, standard, 1.0, most, false, "1", "number of rods, a whole number: coordinates are th1, ..., w1, ..."},
      {"m", 1.0, 0.0, inf, true, "kg", "mass of each bob"},
      {"l", 1.0, 0.0, inf, true, "m", "length of each rod"},
      {"g", 1.0, 0.0, inf, true, "m/s^2", "gravity"},
  };
  return info;
}

Structure PendulumChain::structure(int links) {
  Structure structure;
  structure.dimension = 2 * links;
  Eigen::VectorXd back = Eigen::VectorXd::Ones(structure.dimension);
  back.tail(links).setConstant(-1.0);
  const Eigen::MatrixXd reverse = back.asDiagonal();
  const Eigen::MatrixXd mirror = -Eigen::MatrixXd::Identity(structure.dimension, structure.dimension);
  for (int k = 0; k < links; ++k) structure.angles.push_back(k);
  structure.conserved = {"energy"};
  structure.equivariances = {{"S", mirror}};
  structure.reversors = {{"R", reverse}, {"RS", -reverse}};
  structure.symplectic = true;
  return structure;
}

const ModelInfo& Registered<PendulumChain>::info() {
  static const ModelInfo info = PendulumChain::info(PendulumChain::standard);
  return info;
}

const std::vector<std::string>& Registered<PendulumChain>::effects() {
  static const std::vector<std::string> none;
  return none;
}

std::shared_ptr<const System> Registered<PendulumChain>::make(const Bound& bound) {
  return std::make_shared<const SizedSystem<PendulumChain>>(bound);
}

std::string Registered<PendulumChain>::type() { return "orbweaver::systems::PendulumChain"; }

}  // namespace orbweaver::systems
