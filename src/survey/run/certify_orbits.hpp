#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "orbweaver/archive/schema/records.hpp"
#include "orbweaver/core/mpi/communicator.hpp"

namespace orbweaver::survey {

/// The certificates of all orbits of an atlas, at the level that its scene asks for, as tasks of the queue; on rank 0,
/// in the order of its rows. Collective; the result does not depend on the number of ranks. None, on all ranks alike,
/// where the run was asked to stop meanwhile. Throws NumericalError, on all ranks alike, if an orbit cannot be
/// integrated.
[[nodiscard]] std::optional<std::vector<archive::CertificateRecord>> certificates_of(
    const core::Communicator& comm, const std::filesystem::path& atlas);

}  // namespace orbweaver::survey
