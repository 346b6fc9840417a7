#include "given_orbits.hpp"

#include "payload.hpp"

namespace orbweaver::survey {

std::string pack(const GivenOrbits& orbits) { return to_payload(orbits); }
GivenOrbits unpack_given_orbits(const std::string& bytes) { return from_payload<GivenOrbits>(bytes); }

}  // namespace orbweaver::survey
