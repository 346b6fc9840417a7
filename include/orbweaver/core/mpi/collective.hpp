#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <mpi.h>

namespace orbweaver::core {

/// What an exception is to other ranks.
enum class FailureKind : int {
  none,
  input,
  newer_version,
  environment,
  numerical,
  not_finite,
  misuse,
  other,  ///< of no type of ours: an EnvironmentError elsewhere
};

/// How something went: with `kind` and `text` it can be told to other ranks; `error` stays on its own.
struct Failure {
  FailureKind kind = FailureKind::none;
  std::string text;
  std::exception_ptr error;

  explicit operator bool() const { return kind != FailureKind::none; }
};

/// Runs `work` and keeps what it throws.
[[nodiscard]] Failure attempt(const std::function<void()>& work);
/// Throws the failure's own exception, or on other ranks one of its kind with its text.
[[noreturn]] void raise(const Failure& failure);

/// The failure of the lowest rank that has one, on all ranks (`error` on that rank only); none if nobody failed.
/// Collective.
struct SharedFailure {
  int rank = 0;
  Failure failure;
};
[[nodiscard]] std::optional<SharedFailure> share(MPI_Comm comm, const Failure& mine);

/// Collective. Runs `work` on every rank and then agrees: if it threw on any rank, every rank throws what the lowest
/// such rank threw (the same type of error, the same text). Between two calls of this, no rank can leave the others
/// waiting. `work` may hold at most one collective call.
void collectively(MPI_Comm comm, const std::function<void()>& work);
/// The same for work of rank 0 alone.
void on_root(MPI_Comm comm, const std::function<void()>& work);

[[nodiscard]] int rank_of(MPI_Comm comm);
[[nodiscard]] int size_of(MPI_Comm comm);

/// Rank 0's answer, on all ranks. Collective.
template <class Value>
[[nodiscard]] Value agreed(MPI_Comm comm, Value value);
[[nodiscard]] std::string agreed(MPI_Comm comm, std::string text);
[[nodiscard]] std::vector<std::string> agreed(MPI_Comm comm, std::vector<std::string> texts);

/// Collective. Sum over the ranks before this one, and over all.
struct Share {
  std::uint64_t first = 0;
  std::uint64_t total = 0;
};
[[nodiscard]] Share share_of(MPI_Comm comm, std::uint64_t mine);

[[nodiscard]] std::uint64_t greatest(MPI_Comm comm, std::uint64_t mine);

/// Collective. Concatenates the ranks' rows in the order of the ranks; `Row` is trivially copyable. What a rank throws
/// that has no memory for them, all throw.
template <class Row>
[[nodiscard]] std::vector<Row> gather_rows(MPI_Comm comm, const std::vector<Row>& mine);

namespace detail {
void broadcast_bytes(MPI_Comm comm, void* bytes, std::size_t count, int root);
void gather_bytes(MPI_Comm comm, const void* mine, std::size_t count, std::size_t row_bytes,
                  const std::function<void*(std::size_t)>& allocate);
}  // namespace detail

template <class Value>
Value agreed(MPI_Comm comm, Value value) {
  static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
  detail::broadcast_bytes(comm, &value, sizeof value, 0);
  return value;
}

template <class Row>
std::vector<Row> gather_rows(MPI_Comm comm, const std::vector<Row>& mine) {
  static_assert(std::is_trivially_copyable_v<Row>);
  std::vector<Row> all;
  detail::gather_bytes(comm, mine.data(), mine.size(), sizeof(Row), [&](std::size_t rows) {
    all.resize(rows);
    return static_cast<void*>(all.data());
  });
  return all;
}

}  // namespace orbweaver::core
