#pragma once

#include <functional>
#include <string>

#include "orbweaver/core/mpi/communicator.hpp"

namespace orbweaver::survey {

/// Rank 0's answer, on all ranks. Collective.
[[nodiscard]] bool agreed(const core::Communicator& comm, bool answer);
[[nodiscard]] unsigned long agreed(const core::Communicator& comm, unsigned long number);
[[nodiscard]] std::string agreed(const core::Communicator& comm, std::string text);

/// Does something on rank 0. What it throws, all ranks throw: InputError as such, anything else as EnvironmentError.
void on_root(const core::Communicator& comm, const std::function<void()>& work);

}  // namespace orbweaver::survey
