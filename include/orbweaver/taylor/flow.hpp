#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "orbweaver/ad/lanes.hpp"
#include "orbweaver/numerics/extended.hpp"
#include "orbweaver/systems/formulas.hpp"

namespace orbweaver::taylor {

template <class Real>
class Series;

struct FlowOptions {
  /// The last term that a step keeps is below 10^-digits of the scales.
  double digits = 16.0;
  /// Beyond the order that is quickest.
  int extra_order = 0;
  /// One a coordinate: what its error is measured by. Empty: all 1.
  std::vector<double> scales = {};
  /// Steps after which an integration is given up: a field without a solution (a collision) has ever shorter ones.
  long most_steps = 1000000;
};

/// The flow of a system by its Taylor series in time, of an order that grows with the digits (Jorba and Zou 2005,
/// doi:10.1080/10586458.2005.10128904): from the operations of the field, order by order. It has nothing in common with
/// the certificate's Runge-Kutta integrator, nor with the solvers. Instantiated for double and numerics::Extended; the
/// latter works with the digits in force when it is made, and is used with these.
template <class Real>
class Flow {
 public:
  /// `parameters`: in the order of the formulas.
  Flow(const systems::Formulas& formulas, const std::vector<Real>& parameters, const FlowOptions& options);
  ~Flow();
  Flow(Flow&&) noexcept;

  /// The state (d numbers) after `time`, backwards where that is negative. Throws core::MisuseError for a state of
  /// another size, core::NumericalError where the field or the state ceases to be finite, or after too many steps.
  void advance(std::vector<Real>& state, const Real& time);

  /// The same with dY/dt = df/dz Y carried along: `transitions`, d x d, row after row, becomes Phi(time) times what it
  /// was.
  void advance(std::vector<Real>& state, std::vector<Real>& transitions, const Real& time);

  [[nodiscard]] int order() const;
  /// Of all calls so far.
  [[nodiscard]] long steps() const { return _steps; }

 private:
  void run(Series<Real>& series, std::vector<Real>& state, std::vector<Real>& transitions, const Real& time);
  [[nodiscard]] double log_norm(Series<Real>& series, int k, std::size_t from, std::size_t to) const;
  [[nodiscard]] double step_size(Series<Real>& series, std::size_t size) const;

  systems::Formulas _formulas;
  std::vector<Real> _parameters;
  FlowOptions _options;
  std::vector<double> _log_scales;
  std::unique_ptr<Series<Real>> _state;
  std::unique_ptr<Series<Real>> _variational;
  long _steps = 0;
};

/// The same in double for many states over one time, as many at once as a vector register holds, each with steps of its
/// own: a result does not depend on the other states. Some four times as fast as one after the other.
class ManyFlows {
 public:
  /// With the formulas' own parameter values.
  explicit ManyFlows(const systems::Formulas& formulas, const FlowOptions& options = {});
  ~ManyFlows();
  ManyFlows(ManyFlows&&) noexcept;

  /// Takes each state (d numbers) to where it is after `time`. Throws what Flow::advance does; the states are then
  /// lost.
  void advance(std::vector<std::vector<double>>& states, double time);

 private:
  [[nodiscard]] double step_size(std::size_t lane) const;

  FlowOptions _options;
  std::size_t _dimension;
  std::vector<double> _scales;
  std::unique_ptr<Series<ad::Lanes>> _series;
};

extern template class Flow<double>;
extern template class Flow<numerics::Extended>;

}  // namespace orbweaver::taylor
