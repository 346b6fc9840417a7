#pragma once

#include <optional>
#include <vector>

#include "orbweaver/scene/scene.hpp"
#include "orbweaver/systems/system.hpp"
#include "fields.hpp"

namespace orbweaver::scene {

// One reader a section of a scene; each fills its struct and leaves the defaults of absent keys alone. All throw
// core::InputError as Field does.
void read_sweep(const Field& field, Sweep& sweep);
void read_continuation(const Field& field, const systems::System& system, Continuation& continuation);
/// What moves along families, from the same section, absent or not.
void read_family_scalars(const std::optional<Field>& field, SystemChoice& choice);
void read_survey(const Field& field, Survey& survey);
void read_compute(const Field& field, Compute& compute);
/// Families end at the least and the greatest value that the model allows the parameter that moves.
void keep_to_model(const SystemChoice& choice, const systems::System& system, Limits& limits);
void read_limits(const Field& field, const systems::System& system, Limits& limits);
void read_events(const Field& field, const systems::System& system, Events& events);
void read_section(const Field& field, const systems::System& system, Section& section);
/// `scene`: what was read of it before, whose system's kind of families decides what has loci.
void read_loci(const Field& field, Scene& scene, const systems::System& system);
void read_output(const Field& field, Output& output);

}  // namespace orbweaver::scene
