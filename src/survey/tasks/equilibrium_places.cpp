#include "equilibrium_places.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace orbweaver::survey {

namespace {

using Complex = std::complex<double>;
using starts::EquilibriumKind;
using starts::LinearModes;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

bool comes_before(const Complex& a, const Complex& b) {
  return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
}

/// All eigenvalues, in the order of the archive.
std::vector<Complex> eigenvalues_of(const LinearModes& modes) {
  std::vector<Complex> values = modes.rest;
  const auto add_pair = [&](const Complex& value, int count) {
    for (int n = 0; n < count; ++n) {
      values.push_back(value);
      values.push_back(std::conj(value));
    }
  };
  for (const starts::Oscillation& oscillation : modes.oscillations)
    add_pair({0.0, 2.0 * std::numbers::pi / oscillation.period}, oscillation.multiplicity());
  for (const starts::UndecidedEigenvalues& undecided : modes.undecided) {
    // A real group holds its conjugates, so that the imaginary part of its mean is rounding.
    const bool is_real =
        std::abs(undecided.mean.imag()) <= std::numeric_limits<double>::epsilon() * std::abs(undecided.mean.real());
    if (is_real || undecided.mean == Complex())
      values.insert(values.end(), static_cast<std::size_t>(undecided.count), undecided.mean.real());
    else
      add_pair(undecided.mean, undecided.count);
  }
  std::sort(values.begin(), values.end(), comes_before);
  return values;
}

/// Periods of the pairs that `eigenvalues_of` has on the imaginary axis, and how many have each; the longest first. An
/// equilibrium that lies on a Hopf point has some among the undecided, since nothing holds their real part at 0.
std::vector<std::pair<double, int>> periods_of(const LinearModes& modes) {
  std::map<double, int, std::greater<>> counts;
  for (const starts::Oscillation& oscillation : modes.oscillations)
    counts[oscillation.period] += oscillation.multiplicity();
  for (const starts::UndecidedEigenvalues& undecided : modes.undecided)
    if (undecided.mean.real() == 0.0 && undecided.mean.imag() != 0.0) counts[undecided.period()] += undecided.count;
  return {counts.begin(), counts.end()};
}

/// The pair nearest to +-2 pi i/T, which passes the axis there, becomes an oscillation.
void count_as_oscillation(LinearModes& modes, double period, Eigen::Index dimension) {
  const Complex wanted(0.0, 2.0 * std::numbers::pi / period);
  const auto nearer = [&](const Complex& a, const Complex& b) { return std::abs(a - wanted) < std::abs(b - wanted); };
  const auto rest = std::min_element(modes.rest.begin(), modes.rest.end(), nearer);
  const auto undecided = std::min_element(modes.undecided.begin(), modes.undecided.end(),
                                          [&](const auto& a, const auto& b) { return nearer(a.mean, b.mean); });
  if (undecided != modes.undecided.end() && (rest == modes.rest.end() || nearer(undecided->mean, *rest))) {
    if (undecided->count > 1) return;  // several pairs meet there
    modes.undecided.erase(undecided);
  } else if (rest != modes.rest.end() && rest->imag() != 0.0) {
    const Complex value = *rest;
    modes.rest.erase(rest);
    const auto other = std::find(modes.rest.begin(), modes.rest.end(), std::conj(value));
    if (other != modes.rest.end()) modes.rest.erase(other);
  } else {
    return;
  }
  modes.oscillations.push_back({.period = period, .kernel = Eigen::MatrixXcd(dimension, 1)});
  std::sort(modes.oscillations.begin(), modes.oscillations.end(),
            [](const auto& a, const auto& b) { return a.period > b.period; });
}

void count_as_zero(LinearModes& modes) {
  const auto least = std::min_element(modes.rest.begin(), modes.rest.end(),
                                      [](const Complex& a, const Complex& b) { return std::abs(a) < std::abs(b); });
  if (least == modes.rest.end() || least->imag() != 0.0) return;
  *least = 0.0;
  std::sort(modes.rest.begin(), modes.rest.end(), comes_before);
}

starts::LinearStability stability_if_driven(LinearModes modes, bool driven) {
  if (driven) {
    const auto phase = std::find(modes.rest.begin(), modes.rest.end(), Complex());
    if (phase != modes.rest.end()) modes.rest.erase(phase);
  }
  return starts::stability_of(modes);
}

double distance(const starts::Equilibrium& a, const starts::Equilibrium& b) {
  double square = (a.parameter - b.parameter) * (a.parameter - b.parameter);
  for (std::size_t i = 0; i < a.state.size(); ++i) square += (a.state[i] - b.state[i]) * (a.state[i] - b.state[i]);
  return std::sqrt(square);
}

}  // namespace

bool is_undecided(const std::vector<EquilibriumPlace>& places) {
  return std::any_of(places.begin(), places.end(),
                     [](const EquilibriumPlace& place) { return place.note.starts_with(undecided_note); });
}

EquilibriumPlace equilibrium_place(const systems::System& system, const std::vector<double>& point, LinearModes modes) {
  const systems::Structure& structure = system.structure();
  EquilibriumPlace place;
  const std::vector<std::string>& free = system.family_scalars().free;
  place.parameter =
      free.empty() ? nothing : system.parameters().at(free.front()) / system.parameter_scale(free.front());
  place.state = point;
  place.energy = structure.conservative() ? system.conserved(0, point) : nothing;
  place.stability = stability_if_driven(modes, structure.driven);
  for (const Complex& value : eigenvalues_of(modes)) {
    place.eigenvalues.push_back(value.real());
    place.eigenvalues.push_back(value.imag());
  }
  const std::size_t most = point.size() / 2;
  place.periods.assign(most, nothing);
  place.multiplicity.assign(most, -1);
  const std::vector<std::pair<double, int>> periods = periods_of(modes);
  for (std::size_t n = 0; n < periods.size(); ++n) std::tie(place.periods[n], place.multiplicity[n]) = periods[n];
  return place;
}

std::vector<EquilibriumPlace> places_on(const systems::System& system, const starts::EquilibriumCurve& curve) {
  const std::string& name = system.family_scalars().free.front();
  std::vector<EquilibriumPlace> places;
  for (const starts::EquilibriumPoint& point : curve.points) {
    const std::shared_ptr<const systems::System> here =
        system.with_parameters({{name, point.at.parameter * system.parameter_scale(name)}});
    LinearModes modes = starts::linear_modes(*here, point.at.state);
    if (point.kind == EquilibriumKind::hopf)
      count_as_oscillation(modes, point.period, static_cast<Eigen::Index>(point.at.state.size()));
    if (point.kind == EquilibriumKind::fold || point.kind == EquilibriumKind::branch_point) count_as_zero(modes);
    EquilibriumPlace& place = places.emplace_back(equilibrium_place(*here, point.at.state, std::move(modes)));
    place.step = static_cast<int>(places.size() - 1) - static_cast<int>(curve.start);
    place.kind = point.kind;
    place.parameter = point.at.parameter;
    if (point.may_branch_before)
      place.note = fmt::format("{}other equilibria may branch off on the step to here", undecided_note);
    if (point.may_pass_before)
      place.note = (place.note.empty() ? std::string(undecided_note) : place.note + "; ") +
                   "eigenvalues may pass the imaginary axis on the step to here";
  }
  for (std::size_t n = curve.start + 1; n < places.size(); ++n)
    places[n].arclength = places[n - 1].arclength + distance(curve.points[n - 1].at, curve.points[n].at);
  for (std::size_t n = curve.start; n-- > 0;)
    places[n].arclength = places[n + 1].arclength - distance(curve.points[n].at, curve.points[n + 1].at);
  const auto end = [&](std::size_t n) {
    return curve.are_cut[n] ? fmt::format("{}what lies beyond {}", undecided_note, curve.ends[n]) : curve.ends[n];
  };
  places.front().note = end(0);
  std::string& last = places.back().note;
  last = last.empty() ? end(1) : fmt::format("{}; {}", last, end(1));
  return places;
}

}  // namespace orbweaver::survey
