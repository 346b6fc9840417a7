#include "orbweaver/loss/unknowns.hpp"

#include <algorithm>
#include <map>

#include "orbweaver/core/error.hpp"
#include "orbweaver/loop/curve/measures.hpp"
#include "orbweaver/loop/grid/fourier.hpp"

namespace orbweaver::loss {

namespace {

std::span<const double> in_subspace(const Unknowns& unknowns, std::span<const double> u) {
  return u.first(static_cast<std::size_t>(unknowns.subspace.size()));
}

// The modes of z/w for the density w of the loop's time map, as far as the cutoff goes.
void divide_by_density(loop::Loop& loop) {
  const int nodes = loop::nodes_for(loop);
  const loop::FourierGrid& grid = loop::FourierGrid::of_size(nodes);
  const std::vector<double> density = loop::densities(loop.time_map, nodes);
  std::vector<double> nodal(static_cast<std::size_t>(loop.dimension) * density.size());
  grid.synthesize(loop.cutoff, loop.dimension, loop.modes.data(), nodal.data());
  for (std::size_t m = 0; m < nodal.size(); ++m) nodal[m] /= density[m % density.size()];
  grid.analyze(loop.cutoff, loop.dimension, nodal.data(), loop.modes.data());
}

}  // namespace

bool Unknowns::has_parameters() const {
  return std::any_of(scalars.begin(), scalars.end(), [](const Scalar& s) { return s.kind == Scalar::Kind::parameter; });
}

void Unknowns::validate() const {
  core::require(
      std::is_sorted(scalars.begin(), scalars.end(), [](const Scalar& a, const Scalar& b) { return a.kind < b.kind; }),
      "scalars come in the order T, parameters, unfoldings");
  for (std::size_t n = 1; n < scalars.size(); ++n)
    core::require(std::find(scalars.begin(), scalars.begin() + static_cast<std::ptrdiff_t>(n), scalars[n]) ==
                      scalars.begin() + static_cast<std::ptrdiff_t>(n),
                  "a scalar is solved for once");
}

loop::Loop Unknowns::moved(const loop::Loop& base, std::span<const double> u) const {
  core::require(static_cast<int>(u.size()) == size(), "one value an unknown is needed");
  core::require(base.cutoff == subspace.cutoff(), "the loop and the subspace have different cutoffs");
  loop::Loop out = base;
  subspace.add_to(in_subspace(*this, u), out.modes);
  if (has_period()) out.period += u[static_cast<std::size_t>(subspace.size())];
  std::size_t parameter = 0;
  for (std::size_t n = 0; n < scalars.size(); ++n)
    if (scalars[n].kind == Scalar::Kind::parameter && parameter < out.parameters.size())
      out.parameters[parameter++] += u[static_cast<std::size_t>(subspace.size()) + n];
  return out;
}

std::shared_ptr<const systems::System> Unknowns::moved(const systems::System& base, std::span<const double> u) const {
  core::require(static_cast<int>(u.size()) == size(), "one value an unknown is needed");
  if (!has_parameters()) return {std::shared_ptr<const systems::System>(), &base};
  std::map<std::string, double> values;
  for (std::size_t n = 0; n < scalars.size(); ++n)
    if (scalars[n].kind == Scalar::Kind::parameter)
      values[scalars[n].parameter] =
          base.parameters().at(scalars[n].parameter) +
          base.parameter_scale(scalars[n].parameter) * u[static_cast<std::size_t>(subspace.size()) + n];
  return base.with_parameters(values);
}

std::vector<double> Unknowns::parameters_of(const systems::System& system) const {
  std::vector<double> values;
  for (const Scalar& s : scalars)
    if (s.kind == Scalar::Kind::parameter)
      values.push_back(system.parameters().at(s.parameter) / system.parameter_scale(s.parameter));
  return values;
}

std::vector<double> Unknowns::difference(const loop::Loop& from, const loop::Loop& to) const {
  core::require(from.modes.size() == to.modes.size(), "the loops have different sizes");
  core::require(from.time_map == to.time_map, "the loops have different time maps: bring one to the other's first");
  std::vector<double> modes(from.modes.size());
  for (std::size_t n = 0; n < modes.size(); ++n) modes[n] = to.modes[n] - from.modes[n];
  std::vector<double> u(static_cast<std::size_t>(size()), 0.0);
  subspace.project(modes, std::span(u).first(static_cast<std::size_t>(subspace.size())));
  if (has_period()) u[static_cast<std::size_t>(subspace.size())] = to.period - from.period;
  core::require(from.parameters.size() == to.parameters.size(), "the loops are of systems that move other parameters");
  std::size_t parameter = 0;
  for (std::size_t n = 0; n < scalars.size(); ++n)
    if (scalars[n].kind == Scalar::Kind::parameter && parameter < to.parameters.size()) {
      u[static_cast<std::size_t>(subspace.size()) + n] = to.parameters[parameter] - from.parameters[parameter];
      ++parameter;
    }
  return u;
}

std::vector<double> Unknowns::coordinates_of(const loop::Tangent& tangent) const {
  std::vector<double> u(static_cast<std::size_t>(size()), 0.0);
  subspace.project(tangent.modes, std::span(u).first(static_cast<std::size_t>(subspace.size())));
  // T is the first scalar of a tangent even where the unknowns leave it out.
  std::size_t parameter = 1;
  for (std::size_t n = 0; n < scalars.size(); ++n) {
    double& entry = u[static_cast<std::size_t>(subspace.size()) + n];
    if (scalars[n].kind == Scalar::Kind::period) entry = tangent.period();
    if (scalars[n].kind == Scalar::Kind::parameter && parameter < tangent.scalars.size())
      entry = tangent.scalars[parameter++];
  }
  return u;
}

loop::Tangent Unknowns::tangent_of(std::span<const double> u) const {
  core::require(static_cast<int>(u.size()) == size(), "one value an unknown is needed");
  const int modes = (2 * subspace.cutoff() + 1) * subspace.dimension();
  loop::Tangent out{std::vector<double>(static_cast<std::size_t>(modes), 0.0), {}};
  subspace.add_to(in_subspace(*this, u), out.modes);
  if (!has_period() && has_parameters()) out.scalars.push_back(0.0);
  for (std::size_t n = 0; n < scalars.size(); ++n)
    if (scalars[n].kind != Scalar::Kind::unfolding)
      out.scalars.push_back(u[static_cast<std::size_t>(subspace.size()) + n]);
  return out;
}

std::vector<double> Unknowns::time_shift_direction(const loop::Loop& loop) const {
  loop::Loop derivative = loop;
  for (int i = 0; i < loop.dimension; ++i) {
    derivative.cosine(0, i) = loop.winding[static_cast<std::size_t>(i)];
    for (int k = 1; k <= loop.cutoff; ++k) {
      derivative.cosine(k, i) = k * loop.sine(k, i);
      derivative.sine(k, i) = -k * loop.cosine(k, i);
    }
  }
  if (!loop.time_map.is_identity()) divide_by_density(derivative);
  std::vector<double> u(static_cast<std::size_t>(size()), 0.0);
  subspace.project(derivative.modes, std::span(u).first(static_cast<std::size_t>(subspace.size())));
  return u;
}

}  // namespace orbweaver::loss
