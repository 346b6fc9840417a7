#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include <mpi.h>

namespace orbweaver::archive {

/// Collective. Runs `work` on every rank and then agrees: if it threw on any rank, every rank throws what the lowest
/// such rank threw (the same type of error, the same text). Between two calls of this, no rank can leave the others
/// waiting. `work` may hold at most one collective call.
void collectively(MPI_Comm comm, const std::function<void()>& work);

[[nodiscard]] int rank_of(MPI_Comm comm);
[[nodiscard]] int size_of(MPI_Comm comm);

/// Collective. Sum over the ranks before this one, and over all.
struct Share {
  std::uint64_t first = 0;
  std::uint64_t total = 0;
};
[[nodiscard]] Share share_of(MPI_Comm comm, std::uint64_t mine);

[[nodiscard]] std::uint64_t greatest(MPI_Comm comm, std::uint64_t mine);

/// Collective. Every rank gets rank 0's strings.
void broadcast(MPI_Comm comm, std::vector<std::string>& texts);

/// Collective. Concatenates the ranks' rows in the order of the ranks; `Row` is trivially copyable.
template <class Row>
std::vector<Row> gather_rows(MPI_Comm comm, const std::vector<Row>& mine);

namespace detail {
void gather_bytes(MPI_Comm comm, const void* mine, std::size_t count, std::size_t row_bytes,
                  const std::function<void*(std::size_t)>& allocate);
}  // namespace detail

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

}  // namespace orbweaver::archive
