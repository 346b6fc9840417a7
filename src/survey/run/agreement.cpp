#include "agreement.hpp"

#include <exception>
#include <utility>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/petsc/check.hpp"

namespace orbweaver::survey {

unsigned long agreed(const core::Communicator& comm, unsigned long number) {
  core::check_mpi(MPI_Bcast(&number, 1, MPI_UNSIGNED_LONG, 0, comm.get()), "MPI_Bcast");
  return number;
}

bool agreed(const core::Communicator& comm, bool answer) { return agreed(comm, answer ? 1UL : 0UL) != 0; }

std::string agreed(const core::Communicator& comm, std::string text) {
  text.resize(agreed(comm, static_cast<unsigned long>(text.size())));
  core::check_mpi(MPI_Bcast(text.data(), static_cast<int>(text.size()), MPI_CHAR, 0, comm.get()), "MPI_Bcast");
  return text;
}

void on_root(const core::Communicator& comm, const std::function<void()>& work) {
  enum : unsigned long { well, wrong_input, environment_failed };
  unsigned long result = well;
  std::string text;
  if (comm.is_root()) try {
      work();
    } catch (const core::InputError& error) {
      result = wrong_input;
      text = error.what();
    } catch (const std::exception& error) {
      result = environment_failed;
      text = error.what();
    }
  result = agreed(comm, result);
  if (result == well) return;
  text = agreed(comm, std::move(text));
  if (result == wrong_input) throw core::InputError(text);
  throw core::EnvironmentError(text);
}

}  // namespace orbweaver::survey
