#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "orbweaver/loop/curve/loop.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "support/delegating_system.hpp"

namespace orbweaver::test {

/// What holds for a system whose states are moved by `offset`: all symmetries, now affine.
[[nodiscard]] inline systems::Structure translated(systems::Structure structure, const Eigen::VectorXd& offset) {
  const systems::AffineMap there{Eigen::MatrixXd::Identity(offset.size(), offset.size()), offset};
  for (auto* symmetries : {&structure.equivariances, &structure.reversors})
    for (systems::Symmetry& s : *symmetries) s.map = there * s.map * there.inverse();
  return structure;
}

[[nodiscard]] inline loop::Loop translated(loop::Loop loop, const Eigen::VectorXd& offset) {
  for (int i = 0; i < loop.dimension; ++i) loop.cosine(0, i) += offset(i);
  return loop;
}

/// The same system about another origin: dz/dt = f(z - offset).
class TranslatedSystem final : public DelegatingSystem {
 public:
  TranslatedSystem(std::shared_ptr<const systems::System> system, Eigen::VectorXd offset)
      : DelegatingSystem(std::move(system)),
        _offset(std::move(offset)),
        _structure(translated(whole().structure(), _offset)) {}

  [[nodiscard]] const systems::Structure& structure() const override { return _structure; }
  void field(std::size_t nodes, const double* z, double* f) const override {
    whole().field(nodes, moved_back(nodes, z).data(), f);
  }
  void field_jacobian(std::size_t nodes, const double* z, double* f, double* jacobian) const override {
    whole().field_jacobian(nodes, moved_back(nodes, z).data(), f, jacobian);
  }
  void second_derivatives(std::size_t nodes, const double* z, const double* weights, double* out) const override {
    whole().second_derivatives(nodes, moved_back(nodes, z).data(), weights, out);
  }
  [[nodiscard]] double conserved(int k, std::span<const double> z) const override {
    return whole().conserved(k, moved_back(1, z.data()));
  }
  void conserved_gradient(int k, std::span<const double> z, std::span<double> gradient) const override {
    whole().conserved_gradient(k, moved_back(1, z.data()), gradient);
  }
  [[nodiscard]] double action_density(std::span<const double> z) const override {
    return whole().action_density(moved_back(1, z.data()));
  }

 private:
  [[nodiscard]] std::vector<double> moved_back(std::size_t nodes, const double* z) const {
    std::vector<double> out(z, z + nodes * static_cast<std::size_t>(dimension()));
    for (std::size_t n = 0; n < out.size(); ++n) out[n] -= _offset(static_cast<Eigen::Index>(n / nodes));
    return out;
  }

  Eigen::VectorXd _offset;
  systems::Structure _structure;
};

}  // namespace orbweaver::test
