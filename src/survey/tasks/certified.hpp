#pragma once

#include <span>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/certificate/verdict.hpp"
#include "orbweaver/scene/scene.hpp"

namespace orbweaver::survey {

/// What a scene asks to be computed of each orbit.
[[nodiscard]] certificate::Level certificate_level(const scene::Scene& scene);
/// Whether the branches do it, or tasks of their own when all branches have ended.
[[nodiscard]] bool is_certified_by_branches(const scene::Scene& scene);

/// What a row of /orbits says of an orbit. `stability`: its values in the row; `is_complex`: as re, im.
[[nodiscard]] certificate::Evidence evidence_of(const loop::Loop& loop, double residual,
                                                std::span<const double> stability, bool is_complex,
                                                double stability_error);

/// The columns of a loop's certificate, in the survey's scales.
[[nodiscard]] archive::CertificateRecord record_of(const certificate::Certificate& certificate,
                                                   const certificate::Evidence& evidence);

}  // namespace orbweaver::survey
