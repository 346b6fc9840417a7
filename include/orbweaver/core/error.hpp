#pragma once

#include <source_location>
#include <stdexcept>
#include <string>

namespace orbweaver::core {

/// The exit statuses that every program documents (README, "Exit status").
enum class ExitStatus : int {
  done = 0,
  goal_missed = 1,
  wrong_input = 2,
  environment_failed = 3,
  stopped_early = 4,
};

/// Base of all exceptions that Orbweaver throws. The message says what was expected, what came, where, and what to do;
/// the status is what a program ends with when nobody handles the error.
class Error : public std::runtime_error {
 public:
  Error(ExitStatus status, const std::string& message) : std::runtime_error(message), _status(status) {}
  [[nodiscard]] ExitStatus status() const noexcept { return _status; }

 private:
  ExitStatus _status;
};

/// The user gave something wrong: a scene, a command line, an archive.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(ExitStatus::wrong_input, message) {}
};

/// A file of a version that only a newer Orbweaver reads.
class NewerVersionError : public InputError {
 public:
  using InputError::InputError;
};

/// The machine failed: a disk, a library, MPI.
class EnvironmentError : public Error {
 public:
  explicit EnvironmentError(const std::string& message) : Error(ExitStatus::environment_failed, message) {}
};

/// A computation could not be carried out: a NaN in a vector field, a singular matrix where none may be.
class NumericalError : public Error {
 public:
  explicit NumericalError(const std::string& message) : Error(ExitStatus::goal_missed, message) {}
};

/// A vector field or a matrix gave NaN or infinity.
class NotFiniteError : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

/// A function was called against its contract; the message names the call site.
class MisuseError : public std::logic_error {
 public:
  explicit MisuseError(const std::string& message, std::source_location where = std::source_location::current());
};

/// Throws MisuseError with `message` unless `condition` holds.
inline void require(bool condition, const char* message, std::source_location where = std::source_location::current()) {
  if (!condition) throw MisuseError(message, where);
}

}  // namespace orbweaver::core
