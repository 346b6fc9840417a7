#include "orbweaver/certificate/certificate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "explained.hpp"
#include "newton.hpp"
#include "once_around.hpp"
#include "orbweaver/model/rounded.hpp"
#include "orbweaver/certificate/integrate.hpp"
#include "orbweaver/core/error.hpp"
#include "orbweaver/core/log/log_stage.hpp"
#include "orbweaver/loop/curve/system_at.hpp"
#include "orbweaver/loop/symmetry/symmetry_group.hpp"
#include "orbweaver/model/evaluate.hpp"
#include "orbweaver/numerics/decompositions.hpp"
#include "orbweaver/systems/formulas.hpp"
#include "orbweaver/taylor/flow.hpp"

namespace orbweaver::certificate {

namespace {

/// Of the Taylor series: a digit more than the Runge-Kutta integrator keeps. More digits are more time, and rounding.
constexpr double taylor_digits = 14.0;
/// Of the transition matrices: a Newton step is good to their digits, and so are multipliers.
constexpr double transition_tolerance = 1e-10;
/// An orbit gone around m times is one gone around as often as any prime factor of m says. A survey asks for orders up
/// to 16.
constexpr std::array primes{2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31};
/// Of how far the orbit reaches from z(0): returns that come no nearer at one time need not be looked at all around.
constexpr double near_return = 0.01;

double largest(const std::vector<Eigen::VectorXd>& vectors) {
  double largest = 0.0;
  for (const Eigen::VectorXd& vector : vectors) largest = std::max(largest, vector.norm());
  return largest;
}

}  // namespace

class Certifier::Parts {
 public:
  Parts(const systems::System& system, const loop::Isotropy& isotropy, const Options& options)
      : _system(system), _isotropy(isotropy), _group(system.structure(), isotropy), _options(options) {
    core::require(options.segments >= 1, "a certificate needs at least one segment");
    int shifts = 1;
    for (const loop::SymmetryElement& element : _group.elements()) shifts = std::lcm(shifts, element.shift_denominator);
    _segments = (options.segments + shifts - 1) / shifts * shifts;
    for (int m = 0; m < _segments; ++m) _sources.push_back({m, nullptr});
    std::vector<bool> is_image(static_cast<std::size_t>(_segments), false);
    for (const loop::SymmetryElement& element : _group.elements())
      for (int m = 0; m < _segments; ++m) {
        const std::size_t image = image_of(element, element.reversing ? m + 1 : m);
        is_image[image] = is_image[image] || static_cast<std::size_t>(m) < image;
        if (element.reversing) continue;
        if (Source& source = _sources[image]; m < source.segment) source = {m, &element.map.matrix};
      }
    std::vector<std::size_t> images;
    for (std::size_t m = 0; m < is_image.size(); ++m) (is_image[m] ? images : _by_series).push_back(m);
    _distinct = _by_series.size();
    if (_options.level == Level::full) _by_series.insert(_by_series.end(), images.begin(), images.end());
    if (const auto* formulas = dynamic_cast<const systems::FormulaSystem*>(&system)) {
      taylor::FlowOptions flow;
      flow.digits = taylor_digits;
      _formulas = formulas->formulas();
      _taylor.emplace(*_formulas, flow);
    }
  }

  Certificate at_its_parameters(const loop::Loop& loop, double known_growth) {
    const std::shared_ptr<const systems::System> here = loop::system_at(_system, loop);
    if (here.get() == &_system) return certify(loop, known_growth);
    return Parts(*here, _isotropy, _options).certify(loop, known_growth);
  }

  Certificate certify(const loop::Loop& loop, double known_growth) {
    const core::LogStage stage(core::Stage::certificate);
    loop::validate(loop);
    core::require(loop.dimension == _system.dimension(), "the loop and the system must have the same dimension");
    Certificate found;
    if (_options.level == Level::none) return found;
    _loop = &loop;
    set_states();
    set_fields();
    closures(found);
    conserved(found);
    for (const State& state : _states) found.reach = std::max(found.reach, norm(state));
    const OnceAround once =
        once_around({_system, _states, _loop->period, found.reach, _options.tolerance}, known_growth);
    found.single_shot = once.distance;
    found.displaced_growth = once.displaced_growth;
    found.symmetry_defect = symmetry_defect();
    found.recurrence = recurrence();
    found.tail = loop::tail(loop);
    if (_options.level == Level::full) linearized(found);
    return found;
  }

 private:
  [[nodiscard]] double step() const { return _loop->period / _segments; }

  /// z(t_0), ..., z(t_M); the last is the first after all windings, so that it is exactly as far as the angles turned.
  void set_states() {
    _states.clear();
    for (int m = 0; m < _segments; ++m) _states.push_back(loop::state_at(*_loop, _loop->period * m / _segments));
    State end = _states.front();
    for (std::size_t i = 0; i < end.size(); ++i) end[i] += 2.0 * std::numbers::pi * _loop->winding[i];
    _states.push_back(std::move(end));
  }

  void set_fields() {
    _fields.clear();
    State field(_states.front().size());
    for (const State& state : _states) {
      _system.field(1, state.data(), field.data());
      _fields.push_back(vector_of(field));
    }
  }

  [[nodiscard]] States starts() const { return {_states.begin(), _states.end() - 1}; }

  /// Of states at the segments' starts, those of which the others are images by time shifts of the isotropy.
  [[nodiscard]] States sources_of(const States& states) const {
    States out;
    for (int m = 0; m < _segments; ++m)
      if (_sources[static_cast<std::size_t>(m)].segment == m) out.push_back(states[static_cast<std::size_t>(m)]);
    return out;
  }

  /// What the segments have, from what their sources have, in their order: `image(map, value)`.
  template <class Value, class Image>
  [[nodiscard]] std::vector<Value> for_all(const std::vector<Value>& of_sources, const Image& image) const {
    std::vector<Value> out;
    std::size_t next = 0;
    for (int m = 0; m < _segments; ++m) {
      const Source& source = _sources[static_cast<std::size_t>(m)];
      out.push_back(source.segment == m ? of_sources[next++]
                                        : image(*source.map, out[static_cast<std::size_t>(source.segment)]));
    }
    return out;
  }

  [[nodiscard]] States runge_kutta_ends() const {
    try {
      return integrate_together(_system, starts(), step(), _options.tolerance);
    } catch (const core::NumericalError&) {  // one by one, to name it
    }
    States ends;
    for (int m = 0; m < _segments; ++m) try {
        ends.push_back(integrate(_system, _states[static_cast<std::size_t>(m)], step(), _options.tolerance));
      } catch (const core::NumericalError& error) {
        const double period = _loop->period * _system.scales().time;
        throw core::NumericalError(fmt::format("segment {} of {} of a loop with period {} (from t = {}): {}", m + 1,
                                               _segments, period, period * m / _segments, error.what()));
      }
    return ends;
  }

  /// Of the segments that go by series. None where the series fail, or there are none.
  [[nodiscard]] std::optional<States> taylor_ends() {
    if (!_taylor) return std::nullopt;
    States ends;
    for (const std::size_t m : _by_series) ends.push_back(_states[m]);
    try {
      _taylor->advance(ends, step());
    } catch (const core::NumericalError&) {
      return std::nullopt;
    }
    return ends;
  }

  /// e_m = z(t_m+1) - Phi(z(t_m)).
  [[nodiscard]] std::vector<Eigen::VectorXd> gaps_of(const States& ends) const {
    std::vector<Eigen::VectorXd> gaps;
    for (std::size_t m = 0; m < ends.size(); ++m) gaps.emplace_back(vector_of(_states[m + 1]) - vector_of(ends[m]));
    return gaps;
  }

  void closures(Certificate& found) {
    const States ends = runge_kutta_ends();
    _gaps = gaps_of(ends);
    found.closure = largest(_gaps);
    double along = 0.0;
    double squares = 0.0;
    for (std::size_t m = 0; m < _gaps.size(); ++m) {
      along += _gaps[m].dot(_fields[m + 1]);
      squares += _fields[m + 1].squaredNorm();
    }
    found.beside_flow = 0.0;
    for (std::size_t m = 0; m < _gaps.size(); ++m)
      found.beside_flow =
          std::max(found.beside_flow, (squares > 0.0 ? _gaps[m] - along / squares * _fields[m + 1] : _gaps[m]).norm());
    _taylor_gaps = _gaps;
    const std::optional<States> series = taylor_ends();
    if (!series) return;
    found.taylor_closure = 0.0;
    found.apart = 0.0;
    for (std::size_t n = 0; n < series->size(); ++n) {
      const std::size_t m = _by_series[n];
      const State& end = (*series)[n];
      _taylor_gaps[m] = vector_of(_states[m + 1]) - vector_of(end);
      if (n >= _distinct) continue;
      found.taylor_closure = std::max(found.taylor_closure, _taylor_gaps[m].norm());
      found.apart = std::max(found.apart, distance(ends[m], end));
    }
  }

  void conserved(Certificate& found) const {
    const auto count = static_cast<int>(_system.structure().conserved.size());
    for (int k = 0; k < count; ++k) {
      double& drift = k == 0 ? found.energy_drift : found.other_drift;
      const double start = _system.conserved(k, _states.front());
      drift = std::isnan(drift) ? 0.0 : drift;
      for (const State& state : _states) drift = std::max(drift, std::abs(_system.conserved(k, state) - start));
    }
    if (count == 0) return;
    State gradient(_states.front().size());
    for (const State& state : _states) {
      _system.conserved_gradient(0, state, gradient);
      found.steepness = std::max(found.steepness, norm(gradient));
      found.energy_size = std::max(found.energy_size, std::abs(_system.conserved(0, state)));
    }
    if (_options.level == Level::full || found.energy_drift > energy_roundings * found.energy_size)
      found.energy_rounding = energy_rounding();
  }

  [[nodiscard]] double energy_rounding() const {
    if (!_formulas) return 0.0;
    const std::vector<model::Rounded> parameters(_formulas->values.begin(), _formulas->values.end());
    double largest = 0.0;
    for (const State& state : _states) {
      const std::vector<model::Rounded> z(state.begin(), state.end());
      const auto energy =
          model::evaluate<model::Rounded>(_formulas->graph, std::span(_formulas->conserved).first(1), z, parameters);
      largest = std::max(largest, energy.front().error());
    }
    return largest;
  }

  /// |a - b|, angles modulo whole turns.
  [[nodiscard]] double reduced_distance(const State& a, const State& b) const {
    State difference = a;
    for (std::size_t i = 0; i < a.size(); ++i) {
      difference[i] -= b[i];
      if (_system.structure().is_angle(i)) difference[i] = std::remainder(difference[i], 2.0 * std::numbers::pi);
    }
    return norm(difference);
  }

  /// Where the element takes the instant m: z at the result is g z(t_m).
  [[nodiscard]] std::size_t image_of(const loop::SymmetryElement& element, int m) const {
    const int shift = element.shift_numerator * (_segments / element.shift_denominator);
    const int image = (element.reversing ? shift - m : shift + m) % _segments;
    return static_cast<std::size_t>(image < 0 ? image + _segments : image);
  }

  [[nodiscard]] double symmetry_defect() const {
    double largest = 0.0;
    for (const loop::SymmetryElement& element : _group.elements())
      for (int m = 0; m < _segments; ++m) {
        const Eigen::VectorXd image =
            element.map.matrix * vector_of(_states[static_cast<std::size_t>(m)]) + element.map.offset;
        largest = std::max(
            largest, reduced_distance(_states[image_of(element, m)], State(image.data(), image.data() + image.size())));
      }
    return largest;
  }

  [[nodiscard]] double recurrence() const {
    double reach = 0.0;
    for (const State& state : _states) reach = std::max(reach, reduced_distance(state, _states.front()));
    double least = std::numeric_limits<double>::infinity();
    for (const int prime : primes) {
      const double later = _loop->period / prime;
      double gap = reduced_distance(loop::state_at(*_loop, later), _states.front());
      if (gap < near_return * reach)
        for (int m = 1; m < _segments; ++m)
          gap = std::max(gap, reduced_distance(loop::state_at(*_loop, _loop->period * m / _segments + later),
                                               _states[static_cast<std::size_t>(m)]));
      least = std::min(least, gap);
    }
    return least;
  }

  /// The part of a correction that has the isotropy: gaps have it but for rounding, which may be let grow by much where
  /// another family is near.
  void project(std::vector<Eigen::VectorXd>& states) const {
    std::vector<Eigen::VectorXd> sums(states.size(), Eigen::VectorXd::Zero(_system.dimension()));
    for (const loop::SymmetryElement& element : _group.elements())
      for (int m = 0; m < _segments; ++m)
        sums[image_of(element, m)] += element.map.matrix * states[static_cast<std::size_t>(m)];
    for (std::size_t m = 0; m < states.size(); ++m) states[m] = sums[m] / static_cast<double>(_group.elements().size());
  }

  void linearized(Certificate& found) const {
    std::vector<Eigen::MatrixXd> of_sources;
    const Eigen::Index d = _system.dimension();
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    for (const State& entries : transitions(_system, sources_of(_states), step(), transition_tolerance))
      of_sources.emplace_back(Eigen::Map<const RowMajor>(entries.data(), d, d));
    const std::vector<Eigen::MatrixXd> matrices =
        for_all(of_sources, [](const Eigen::MatrixXd& g, const Eigen::MatrixXd& matrix) -> Eigen::MatrixXd {
          return g * matrix * g.inverse();
        });
    newton(matrices, found);
    multipliers(matrices, found);
  }

  void newton(const std::vector<Eigen::MatrixXd>& matrices, Certificate& found) const {
    const int rank = _system.dimension() - static_cast<int>(_system.structure().conserved.size());
    const NewtonSystem system(matrices, _fields, rank);
    NewtonSystem::Step first = system.solve(_gaps);
    NewtonSystem::Step other = system.solve(_taylor_gaps);
    project(first.states);
    project(other.states);
    double integrators = 0.0;
    for (std::size_t m = 0; m < first.states.size(); ++m)
      integrators = std::max(integrators, (first.states[m] - other.states[m]).norm());
    States moved = starts();
    for (std::size_t m = 0; m < moved.size(); ++m)
      for (std::size_t i = 0; i < moved[m].size(); ++i) moved[m][i] += first.states[m](static_cast<Eigen::Index>(i));
    const double moves = largest(first.states);
    found.distance = std::numeric_limits<double>::infinity();
    found.contraction = found.distance;
    try {
      const States ends =
          integrate_together(_system, sources_of(moved), step() + first.period / _segments, _options.tolerance);
      moved.push_back(moved.front());
      for (std::size_t i = 0; i < moved.back().size(); ++i)
        moved.back()[i] += 2.0 * std::numbers::pi * _loop->winding[i];
      std::vector<Eigen::VectorXd> of_sources;
      for (std::size_t m = 0; of_sources.size() < ends.size(); ++m)
        if (_sources[m].segment == static_cast<int>(m))
          of_sources.emplace_back(vector_of(moved[m + 1]) - vector_of(ends[of_sources.size()]));
      const std::vector<Eigen::VectorXd> gaps = for_all(
          of_sources, [](const Eigen::MatrixXd& g, const Eigen::VectorXd& gap) -> Eigen::VectorXd { return g * gap; });
      NewtonSystem::Step second = system.solve(gaps);
      project(second.states);
      found.contraction = moves > 0.0 ? largest(second.states) / moves : 0.0;
      found.distance = moves + largest(second.states) + integrators;
    } catch (const core::NumericalError&) {  // the step has left the region where the system is defined
    }
  }

  /// From the flow on the energy's tangent space across the orbit, for a single pair.
  void multipliers(const std::vector<Eigen::MatrixXd>& matrices, Certificate& found) const {
    const systems::Structure& structure = _system.structure();
    if (!structure.symplectic) return;
    double log_volume = 0.0;
    for (const Eigen::MatrixXd& matrix : matrices)
      log_volume += std::log(std::abs(Eigen::PartialPivLU<Eigen::MatrixXd>(matrix).determinant()));
    found.pairing = std::abs(std::expm1(log_volume));
    if (structure.pairs() != 1 || structure.conserved.size() != 1) return;
    const Eigen::Index d = _system.dimension();
    std::vector<Eigen::MatrixXd> bases;
    State gradient(static_cast<std::size_t>(d));
    for (int m = 0; m < _segments; ++m) {
      _system.conserved_gradient(0, _states[static_cast<std::size_t>(m)], gradient);
      Eigen::MatrixXd normals(d, 2);
      normals << _fields[static_cast<std::size_t>(m)], vector_of(gradient);
      const Eigen::MatrixXd all =
          Eigen::HouseholderQR<Eigen::MatrixXd>(normals).householderQ() * Eigen::MatrixXd::Identity(d, d);
      bases.emplace_back(all.rightCols(d - 2));
    }
    Eigen::MatrixXd product = Eigen::MatrixXd::Identity(d - 2, d - 2);
    for (std::size_t m = 0; m < matrices.size(); ++m)
      product = (bases[(m + 1) % matrices.size()].transpose() * matrices[m] * bases[m] * product).eval();
    found.index = product.trace();
  }

  /// Of which segment another one is the image, by which matrix; itself without one.
  struct Source {
    int segment;
    const Eigen::MatrixXd* map;
  };

  const systems::System& _system;
  loop::Isotropy _isotropy;
  loop::SymmetryGroup _group;
  Options _options;
  int _segments = 1;
  std::vector<Source> _sources;
  // Of segments that are images of one another one each, so many; behind them, where Newton's method asks, the others.
  std::vector<std::size_t> _by_series;
  std::size_t _distinct = 0;
  std::optional<systems::Formulas> _formulas;
  std::optional<taylor::ManyFlows> _taylor;
  const loop::Loop* _loop = nullptr;
  States _states;                        // M + 1
  std::vector<Eigen::VectorXd> _fields;  // at these
  std::vector<Eigen::VectorXd> _gaps;    // M
  std::vector<Eigen::VectorXd> _taylor_gaps;
};

Certifier::Certifier(const systems::System& system, const loop::Isotropy& isotropy, const Options& options)
    : _parts(std::make_unique<Parts>(system, isotropy, options)) {}

Certifier::~Certifier() = default;
Certifier::Certifier(Certifier&&) noexcept = default;

Certificate Certifier::operator()(const loop::Loop& loop, double known_growth) {
  return _parts->at_its_parameters(loop, known_growth);
}

Certificate certify(const systems::System& system, const loop::Loop& loop, const loop::Isotropy& isotropy,
                    const Options& options) {
  return Certifier(system, isotropy, options)(loop);
}

}  // namespace orbweaver::certificate
