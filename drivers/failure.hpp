#pragma once

#include <exception>
#include <functional>
#include <string>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/mpi/communicator.hpp"

namespace orbweaver::drivers {

/// A failure in words, with the exit status it asks for.
struct Failure {
  int status = 0;
  std::string message;
};

/// Thrown on ranks whose failure another rank reports; main ends with `status` and prints nothing.
class ReportedElsewhere : public std::exception {
 public:
  explicit ReportedElsewhere(int status) : _status(status) {}
  [[nodiscard]] int status() const noexcept { return _status; }
  [[nodiscard]] const char* what() const noexcept override { return "the failure is reported by another rank"; }

 private:
  int _status;
};

/// Status and message of an exception: core::Error keeps its own, MisuseError and every other exception give 3.
[[nodiscard]] Failure describe_failure(const std::exception_ptr& error);

/// Prints `orbweaver: <message>` to stderr (nothing for ReportedElsewhere) and returns the exit status.
int report_failure(const std::exception_ptr& error);

/// Writes a command's result, escaped (core::printable_lines), to the standard output; throws EnvironmentError if it
/// cannot be written.
void print_result(const std::string& text);

/// The same without escaping: what is printed escapes its parts itself.
void print_as_it_is(const std::string& text);

/// Collective over `comm`. Runs `stage` on every rank. If it throws on any, all throw before anyone enters the next
/// collective: the lowest failing rank what main reports as the original error, the others ReportedElsewhere with the
/// same status. `stage` itself must not be collective: it is for reading and validating input.
void agree(const core::Communicator& comm, const std::function<void()>& stage);

/// Collective. Runs the body of a command under MPI. With several ranks, an exception that was not agreed upon leaves
/// the others waiting in a collective, so it is printed with its rank and the job is aborted with its status; what
/// `agree` throws passes through, on all ranks alike.
int run_on_ranks(const core::Communicator& comm, const std::function<int()>& body);

/// What `body` returns. It throws InputError and EnvironmentError on all ranks alike; one of them reports.
template <class Body>
auto alike_on_all_ranks(const core::Communicator& comm, Body&& body) {
  try {
    return body();
  } catch (const core::InputError&) {
    agree(comm, [] { throw; });
  } catch (const core::EnvironmentError&) {
    agree(comm, [] { throw; });
  }
  throw core::MisuseError("an error that all ranks share was reported by none");
}

}  // namespace orbweaver::drivers
