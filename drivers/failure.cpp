#include "failure.hpp"

#include <cstdio>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "orbweaver/core/error.hpp"
#include "orbweaver/core/interruption.hpp"
#include "orbweaver/core/log/log.hpp"
#include "orbweaver/core/mpi/collective.hpp"
#include "orbweaver/core/styled.hpp"
#include "orbweaver/core/terminal.hpp"
#include "orbweaver/core/text.hpp"

namespace orbweaver::drivers {

namespace {

constexpr int environment_failed = static_cast<int>(core::ExitStatus::environment_failed);

// Marks the exception that `agree` lets through on the reporting rank, so that run_on_ranks does not abort.
class Agreed : public std::exception {
 public:
  explicit Agreed(std::exception_ptr cause) : _cause(std::move(cause)) {}
  [[nodiscard]] const std::exception_ptr& cause() const noexcept { return _cause; }

 private:
  std::exception_ptr _cause;
};

/// `who` stands out on a terminal, so that the error is found among lines of progress.
void print_error(const std::string& who, const std::string& message) {
  const bool colours = core::terminal_of(STDERR_FILENO).colours;
  core::write_line(stderr,
                   fmt::format("{} {}", core::styled(core::Style::bad, who, colours), core::printable_lines(message)));
}

}  // namespace

Failure describe_failure(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const core::Error& e) {
    return {static_cast<int>(e.status()), e.what()};
  } catch (const core::MisuseError& e) {
    return {environment_failed, fmt::format("internal error (please report it): {}", e.what())};
  } catch (const ReportedElsewhere& e) {
    return {e.status(), e.what()};
  } catch (const Agreed& e) {
    return describe_failure(e.cause());
  } catch (const core::Interrupted&) {
    return {static_cast<int>(core::ExitStatus::stopped_early),
            "stopped before the survey had begun: there is nothing to go on from"};
  } catch (const std::filesystem::filesystem_error& e) {
    constexpr std::size_t longest_path = 200;
    if (e.path1().empty()) return {environment_failed, e.what()};
    const std::string path = core::shortened(core::printable(e.path1().string()), longest_path);
    return {environment_failed, fmt::format("{}: {}", path, e.code().message())};
  } catch (const std::exception& e) {
    return {environment_failed, e.what()};
  } catch (...) {
    return {environment_failed, "an exception of unknown type"};
  }
}

int report_failure(const std::exception_ptr& error) {
  const Failure failure = describe_failure(error);
  try {
    std::rethrow_exception(error);
  } catch (const ReportedElsewhere&) {
    return failure.status;
  } catch (...) {
    print_error("orbweaver:", failure.message);
  }
  return failure.status;
}

void print_result(const std::string& text) { print_as_it_is(core::printable_lines(text)); }

void print_as_it_is(const std::string& text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (written) return;
  std::clearerr(stdout);
  throw core::EnvironmentError("cannot write to the standard output: is the disk full, or the output closed?");
}

void agree(const core::Communicator& comm, const std::function<void()>& stage) {
  const std::optional<core::SharedFailure> shared = core::share(comm.get(), core::attempt(stage));
  if (!shared) return;
  if (comm.rank() == shared->rank) throw Agreed(shared->failure.error);
  throw ReportedElsewhere(describe_failure(core::attempt([&] { core::raise(shared->failure); }).error).status);
}

int run_on_ranks(const core::Communicator& comm, const std::function<int()>& body) {
  try {
    return body();
  } catch (const Agreed&) {
    throw;
  } catch (const ReportedElsewhere&) {
    throw;
  } catch (...) {
    if (comm.size() == 1) throw;
    const Failure failure = describe_failure(std::current_exception());
    print_error(fmt::format("orbweaver: rank {}:", comm.rank()), failure.message);
    std::fflush(nullptr);
    MPI_Abort(comm.get(), failure.status);
    return failure.status;
  }
}

}  // namespace orbweaver::drivers
