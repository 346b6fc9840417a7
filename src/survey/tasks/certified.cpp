#include "certified.hpp"

#include <algorithm>
#include <cmath>

#include "orbweaver/loop/curve/measures.hpp"

namespace orbweaver::survey {

certificate::Level certificate_level(const scene::Scene& scene) {
  switch (scene.compute.certificate) {
    case scene::Certificate::none: return certificate::Level::none;
    case scene::Certificate::automatic:
    case scene::Certificate::closure: return certificate::Level::closure;
    case scene::Certificate::full: break;
  }
  return certificate::Level::full;
}

bool is_certified_by_branches(const scene::Scene& scene) {
  return scene.compute.certificate == scene::Certificate::automatic;
}

certificate::Evidence evidence_of(const loop::Loop& loop, double residual, std::span<const double> stability,
                                  bool is_complex, double stability_error) {
  certificate::Evidence evidence{loop.period, residual, loop::rms_amplitude(loop), archive::not_computed};
  evidence.winds = std::any_of(loop.winding.begin(), loop.winding.end(), [](double n) { return n != 0.0; });
  const std::size_t parts = is_complex ? 2 : 1;
  for (std::size_t n = 0; n + parts <= stability.size(); n += parts)
    evidence.growth =
        std::fmax(evidence.growth, is_complex ? std::hypot(stability[n], stability[n + 1]) : std::abs(stability[n]));
  if (!is_complex && stability.size() == 1) {
    evidence.index = stability.front();
    evidence.index_error = stability_error;
  }
  return evidence;
}

archive::CertificateRecord record_of(const certificate::Certificate& certificate,
                                     const certificate::Evidence& evidence) {
  archive::CertificateRecord record;
  record.verdict = static_cast<int>(certificate::judge(certificate, evidence).verdict);
  record.closure = certificate.closure;
  record.single_shot = certificate.single_shot;
  record.energy_drift = certificate.energy_drift;
  record.taylor_closure = certificate.taylor_closure;
  record.integrators_apart = certificate.apart;
  record.other_drift = certificate.other_drift;
  record.symmetry_defect = certificate.symmetry_defect;
  record.recurrence = certificate.recurrence;
  record.orbit_distance = certificate.distance;
  record.contraction = certificate.contraction;
  record.pairing = certificate.pairing;
  record.index_gap = std::abs(certificate.index - evidence.index);
  return record;
}

}  // namespace orbweaver::survey
