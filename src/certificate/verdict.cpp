#include "orbweaver/certificate/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace orbweaver::certificate {

namespace {

/// Of |z|: what the integrator's tolerance and rounding leave.
constexpr double integration_error = 1e-13;
/// How much more than its residual lets expect an orbit may be off. The closures of 10,000 orbits of the double
/// pendulum, the swinging spring and the restricted problem were at most 5 times that, their drifts 0.6 times.
constexpr double unexplained = 1e3;
/// Of the amplitude: fewer digits than four confirm no orbit.
constexpr double informative = 1e-4;

}  // namespace

Judgement judge(const Certificate& certificate, const Evidence& evidence) {
  const double error = evidence.period * evidence.residual + integration_error * certificate.reach;
  const double growth =
      std::isnan(evidence.growth) ? std::numeric_limits<double>::infinity() : std::max(1.0, evidence.growth);
  Judgement out{Verdict::holds, certificate.closure, informative * evidence.amplitude, evidence.period, growth};
  const double drift_allowed = unexplained * certificate.steepness * error;
  const double closure_allowed = unexplained * error * growth;
  if (certificate.energy_drift > drift_allowed) {
    out.verdict = Verdict::drift_contradicts;
    out.found = certificate.energy_drift;
    out.allowed = drift_allowed;
  } else if (certificate.closure > closure_allowed) {
    out.verdict = Verdict::closure_contradicts;
    out.allowed = closure_allowed;
  } else if (certificate.closure > out.allowed) {
    out.verdict = Verdict::says_nothing;
  }
  return out;
}

}  // namespace orbweaver::certificate
