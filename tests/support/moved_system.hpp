#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/Dense>

#include "graph_system.hpp"
#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/model/recorded.hpp"

namespace orbweaver::test {

/// The system told in other coordinates y = map(z), map invertible, and other units of time and energy (how many of
/// them make an old one), with its symmetries. Angles only change places.
[[nodiscard]] inline std::shared_ptr<const systems::System> moved_system(
    const std::shared_ptr<const systems::System>& system, const systems::AffineMap& map, double time = 1.0,
    double energy = 1.0) {
  using model::Recorded;
  const std::shared_ptr<const systems::GraphSystem> whole = systems::graph_system(system);
  const systems::Equations& plain = whole->equations();
  const Eigen::Index d = map.matrix.rows();
  const auto times = [&](const Eigen::MatrixXd& matrix, const std::vector<Recorded>& values) {
    std::vector<Recorded> out;
    for (Eigen::Index i = 0; i < d; ++i) {
      Recorded sum(0.0);
      for (Eigen::Index l = 0; l < d; ++l)
        if (matrix(i, l) != 0.0) sum += values[static_cast<std::size_t>(l)] * matrix(i, l);
      out.push_back(sum);
    }
    return out;
  };
  model::Recording recording;
  std::vector<Recorded> from_offset, parameters;
  for (Eigen::Index i = 0; i < d; ++i) from_offset.push_back(recording.input(static_cast<int>(i)) - map.offset(i));
  for (std::size_t n = 0; n < plain.parameters.size(); ++n)
    parameters.push_back(recording.parameter(static_cast<int>(n)));
  const std::vector<Recorded> z = times(map.matrix.inverse(), from_offset);
  const auto at = [&](const std::vector<int>& nodes) {
    return model::evaluate<Recorded>(plain.graph, nodes, z, parameters);
  };
  systems::Equations equations{{}, plain.parameters, {}, {}, {}, -1};
  for (const Recorded& rate : times(map.matrix / time, at(plain.field))) equations.field.push_back(rate.node());
  for (const Recorded& value : at(plain.conserved)) equations.conserved.push_back((value * energy).node());
  for (const Recorded& value : at(plain.guards)) equations.guards.push_back(value.node());
  if (plain.action >= 0) equations.action = (at({plain.action}).front() * energy).node();
  equations.graph = recording.graph();
  return std::make_shared<const systems::GraphSystem>(
      whole, std::move(equations), std::vector<double>{}, whole->family_scalars(),
      [map](const std::shared_ptr<const systems::GraphSystem>& of) {
        systems::Frame frame = of->frame();
        for (auto* symmetries : {&frame.structure.equivariances, &frame.structure.reversors})
          for (systems::Symmetry& s : *symmetries) s.map = map * s.map * map.inverse();
        const auto place_of = [&](Eigen::Index coordinate) {
          Eigen::Index place = 0;
          map.matrix.col(coordinate).cwiseAbs().maxCoeff(&place);
          return place;
        };
        for (int& angle : frame.structure.angles) angle = static_cast<int>(place_of(angle));
        std::sort(frame.structure.angles.begin(), frame.structure.angles.end());
        if (frame.structure.angles.empty()) return frame;
        for (Eigen::Index i = 0; i < map.matrix.cols(); ++i) {
          const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(place_of(i));
          frame.info.state_names[to] = of->info().state_names[from];
          frame.info.winding_names[to] = of->info().winding_names[from];
        }
        return frame;
      });
}

/// The same about another origin: dz/dt = f(z - offset).
[[nodiscard]] inline std::shared_ptr<const systems::System> translated_system(
    const std::shared_ptr<const systems::System>& system, const Eigen::VectorXd& offset) {
  return moved_system(system, systems::AffineMap{Eigen::MatrixXd::Identity(offset.size(), offset.size()), offset});
}

}  // namespace orbweaver::test
